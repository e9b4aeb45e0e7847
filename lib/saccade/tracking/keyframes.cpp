// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace saccade {
namespace {

constexpr int kDepthStride{2};
constexpr float kMillimetres{1000.0F};
constexpr float kBehind_m{0.02F};  ///< a surface behind the keyframe's by more is hidden from it
constexpr float kBehindGrowth{0.02F};
constexpr std::size_t kWarpedRows{16};

/// Mean 0, length 1; empty where all values are equal, or fewer than a quarter are known.
std::vector<float> normalised(std::vector<float> values) {
  double sum{0.0};
  std::size_t known{0};
  for (const float value : values) {
    if (!(value > 0.0F)) continue;
    sum += static_cast<double>(value);
    ++known;
  }
  if (4 * known < values.size()) return {};
  const auto mean = static_cast<float>(sum / static_cast<double>(known));
  double squares{0.0};
  for (float& value : values) {
    value = value > 0.0F ? value - mean : 0.0F;
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  if (!(squares > 0.0)) return {};
  const auto scale = static_cast<float>(1.0 / std::sqrt(squares));
  for (float& value : values) value *= scale;
  return values;
}

/// Means of the known values in cells of equal size.
std::vector<float> shrunk(const Image<float>& image) {
  std::vector<float> cells;
  if (image.empty()) return cells;
  for (int row = 0; row < Thumbnail::kHeight; ++row) {
    for (int column = 0; column < Thumbnail::kWidth; ++column) {
      const int v1 = (row + 1) * image.height() / Thumbnail::kHeight;
      const int u1 = (column + 1) * image.width() / Thumbnail::kWidth;
      float sum{0.0F};
      int known{0};
      for (int v = row * image.height() / Thumbnail::kHeight; v < v1; ++v) {
        for (int u = column * image.width() / Thumbnail::kWidth; u < u1; ++u) {
          if (!(image(u, v) > 0.0F)) continue;
          sum += image(u, v);
          ++known;
        }
      }
      cells.push_back(known > 0 ? sum / static_cast<float>(known) : 0.0F);
    }
  }
  return cells;
}

std::optional<double> correlation(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.empty() || b.empty()) return std::nullopt;
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

Status KeyframesConfig::validate() const {
  if (spacing_m > 0.0 && spacing_rad > 0.0 && most >= 2) return {};
  return Error{Errc::invalid_argument, "the spacing of keyframes must be positive, and two must be allowed", {}};
}

Thumbnail thumbnail(const Image<float>& grey, const Image<float>& z) {
  return {normalised(shrunk(grey)), normalised(shrunk(z))};
}

double alikeness(const Thumbnail& a, const Thumbnail& b) {
  const std::optional<double> grey = correlation(a.grey, b.grey);
  const std::optional<double> depth = correlation(a.depth, b.depth);
  if (grey && depth) return 0.5 * (*grey + *depth);
  return grey ? *grey : depth.value_or(-1.0);
}

double Keyframes::distance(const Pose& a, const Pose& b) const {
  const Pose between = a.inverse() * b;
  return between.translation().norm() / config_.spacing_m + rotation_angle_rad(between) / config_.spacing_rad;
}

bool Keyframes::wants(const Pose& T_world_camera, bool has_color) const {
  return std::none_of(keyframes_.begin(), keyframes_.end(), [&](const Keyframe& kept) {
    return (!kept.grey.empty() || !has_color) && distance(kept.T_world_camera, T_world_camera) < 1.0;
  });
}

void Keyframes::add(const Image<float>& grey, const Image<float>& z, const PinholeCamera& camera,
                    const Pose& T_world_camera) {
  if (keyframes_.size() >= config_.most) {
    std::size_t left{0};
    for (std::size_t i = 0; i < keyframes_.size(); i += 2) keyframes_[left++] = std::move(keyframes_[i]);
    keyframes_.resize(left);
  }
  Keyframe added{T_world_camera, camera, {}, {}, thumbnail(grey, z)};
  if (!grey.empty()) added.grey = Image<std::uint8_t>{grey.width(), grey.height()};
  std::transform(grey.data(), grey.data() + grey.size(), added.grey.data(),
                 [](float value) { return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F)); });
  added.depth_mm = Image<std::uint16_t>{(z.width() + kDepthStride - 1) / kDepthStride,
                                        (z.height() + kDepthStride - 1) / kDepthStride};
  for (int v = 0; v < added.depth_mm.height(); ++v) {
    for (int u = 0; u < added.depth_mm.width(); ++u) {
      const float mm = std::clamp(kMillimetres * z(u * kDepthStride, v * kDepthStride), 0.0F, 65535.0F);
      added.depth_mm(u, v) = static_cast<std::uint16_t>(mm);
    }
  }
  keyframes_.push_back(std::move(added));
}

const Keyframe* Keyframes::nearest_with_color(const Pose& T_world_camera) const {
  const Keyframe* nearest{nullptr};
  double least{HUGE_VAL};
  for (const Keyframe& kept : keyframes_) {
    const double away = distance(kept.T_world_camera, T_world_camera);
    if (kept.grey.empty() || !(away < least)) continue;
    least = away;
    nearest = &kept;
  }
  return nearest;
}

std::vector<Pose> Keyframes::most_alike(const Thumbnail& frame, std::size_t count) const {
  std::vector<std::size_t> order(keyframes_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> alike;
  for (const Keyframe& kept : keyframes_) alike.push_back(alikeness(kept.small, frame));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return alike[a] > alike[b]; });
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < std::min(count, order.size()); ++i) poses.push_back(keyframes_[order[i]].T_world_camera);
  return poses;
}

Image<float> grey_of_surface(const Keyframe& keyframe, const PointImage& surface, const PinholeCamera& camera,
                             const Pose& T_world_camera, const Executor& executor) {
  Image<float> grey{surface.z.width(), surface.z.height()};
  const Eigen::Isometry3f T = (keyframe.T_world_camera.inverse() * T_world_camera).cast<float>();
  const PinholeCamera& seen = keyframe.camera;
  const auto fx = static_cast<float>(seen.fx), fy = static_cast<float>(seen.fy);
  const auto cx = static_cast<float>(seen.cx), cy = static_cast<float>(seen.cy);
  const auto inverse_fx = static_cast<float>(1.0 / camera.fx), inverse_fy = static_cast<float>(1.0 / camera.fy);
  const int last_u = keyframe.grey.width() - 1;
  const int last_v = keyframe.grey.height() - 1;
  executor.parallel_for(static_cast<std::size_t>(grey.height()), kWarpedRows, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const float ray_y = (static_cast<float>(v) - static_cast<float>(camera.cy)) * inverse_fy;
      for (int u = 0; u < grey.width(); ++u) {
        const float z = surface.z(u, v);
        if (!(z > 0.0F)) continue;
        const float ray_x = (static_cast<float>(u) - static_cast<float>(camera.cx)) * inverse_fx;
        const Eigen::Vector3f p = T * Eigen::Vector3f{ray_x * z, ray_y * z, z};
        if (!(p.z() > 0.0F)) continue;
        const float inverse_z = 1.0F / p.z();
        const float x = fx * p.x() * inverse_z + cx;
        const float y = fy * p.y() * inverse_z + cy;
        if (!(x >= 0.0F && y >= 0.0F && x < static_cast<float>(last_u) && y < static_cast<float>(last_v))) continue;
        const int column = static_cast<int>(x);
        const int row = static_cast<int>(y);
        const std::uint16_t mm = keyframe.depth_mm(column / kDepthStride, row / kDepthStride);
        if (mm == 0 || p.z() > static_cast<float>(mm) * (1.0F / kMillimetres) + kBehind_m + kBehindGrowth * p.z())
          continue;
        const std::uint8_t* upper = keyframe.grey.row(row) + column;
        const std::uint8_t* lower = keyframe.grey.row(row + 1) + column;
        if (upper[0] == 0 || upper[1] == 0 || lower[0] == 0 || lower[1] == 0) continue;
        const float aside = x - static_cast<float>(column);
        const float below = y - static_cast<float>(row);
        const float above_grey = static_cast<float>(upper[0]) + aside * static_cast<float>(upper[1] - upper[0]);
        const float below_grey = static_cast<float>(lower[0]) + aside * static_cast<float>(lower[1] - lower[0]);
        grey(u, v) = above_grey + below * (below_grey - above_grey);
      }
    }
  });
  return grey;
}

}  // namespace saccade
