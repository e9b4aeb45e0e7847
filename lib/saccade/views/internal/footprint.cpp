// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/footprint.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "saccade/views/internal/face_boxes.hpp"

namespace saccade {
namespace {

// Slack far above the error of float32, here and in the ray's walk, and far below a voxel and a pixel.
constexpr double kSlack_vox{0.012};
constexpr double kSlack_px{0.02};
constexpr double kSlackRate{2e-5};  // per pixel of focal length

/// Half-spaces through the camera's centre that hold all rays of a grid: normal · p ≥ −slack.
using ViewPyramid = std::array<std::array<double, 3>, 4>;

ViewPyramid pyramid_of(const std::array<std::array<double, 3>, 3>& axes, const PixelGrid& grid) {
  const double last_a = grid.first_a + grid.columns / grid.pixels_per_a;
  const double last_b = grid.first_b + grid.rows / grid.pixels_per_b;
  const double before_a = grid.first_a - 1.0 / grid.pixels_per_a;
  const double before_b = grid.first_b - 1.0 / grid.pixels_per_b;
  ViewPyramid sides{};
  for (std::size_t i = 0; i < 3; ++i) {
    sides[0][i] = axes[0][i] - before_a * axes[2][i];
    sides[1][i] = last_a * axes[2][i] - axes[0][i];
    sides[2][i] = axes[1][i] - before_b * axes[2][i];
    sides[3][i] = last_b * axes[2][i] - axes[1][i];
  }
  return sides;
}

/// Filter of boxes in which a square may be visible.
class GroupFilter {
 public:
  GroupFilter(const FaceProjection& camera, const ViewPyramid& sides) : camera_{camera}, sides_{sides} {}

  [[nodiscard]] bool may_show(const FaceGroup& group) const {
    const std::array<std::int32_t, 3> lo{group.lo.x, group.lo.y, group.lo.z};
    const std::array<std::int32_t, 3> hi{group.hi.x, group.hi.y, group.hi.z};
    const std::array<std::int32_t, 3> at{camera_.origin.x, camera_.origin.y, camera_.origin.z};
    const auto across = static_cast<std::size_t>(group.axis);
    if (group.forward ? hi[across] <= at[across] : lo[across] > at[across]) return false;
    std::array<double, 3> middle{};
    std::array<double, 3> half{};
    for (std::size_t i = 0; i < 3; ++i) {
      middle[i] = 0.5 * (static_cast<double>(lo[i]) + hi[i]) - at[i] - static_cast<double>(camera_.fraction[i]);
      half[i] = 0.5 * (static_cast<double>(hi[i]) - lo[i]) + 1.0;
    }
    return std::all_of(sides_.begin(), sides_.end(), [&](const std::array<double, 3>& normal) {
      double most{0.0};
      for (std::size_t i = 0; i < 3; ++i) most += normal[i] * middle[i] + std::abs(normal[i]) * half[i];
      return most >= 0.0;
    });
  }

 private:
  const FaceProjection& camera_;
  const ViewPyramid& sides_;
};

}  // namespace

void Footprint::draw(const EntryFaces& faces, const SensorRays& rays, const PixelGrid& grid, double voxel_size_m,
                     float min_t, float max_t) {
  stride_ = static_cast<std::size_t>(grid.columns) / 8 + 1 + sizeof(std::uint64_t);
  bytes_.assign(stride_ * static_cast<std::size_t>(grid.rows), 0);
  if (grid.columns <= 0 || grid.rows <= 0) return;
  std::array<std::array<double, 3>, 3> axes{};
  for (std::size_t i = 0; i < 3; ++i) {
    axes[0][i] = static_cast<double>(rays.x[i]) * voxel_size_m;
    axes[1][i] = static_cast<double>(rays.y[i]) * voxel_size_m;
    axes[2][i] = static_cast<double>(rays.z[i]) * voxel_size_m;
  }
  FaceProjection camera{};
  camera.origin = rays.origin.voxel;
  for (std::size_t i = 0; i < 3; ++i) {
    camera.fraction[i] = rays.origin.fraction[i];
    camera.to_image[0][i] = static_cast<float>(axes[0][i] * grid.pixels_per_a);
    camera.to_image[1][i] = static_cast<float>(axes[1][i] * grid.pixels_per_b);
    camera.to_image[2][i] = static_cast<float>(axes[2][i]);
  }
  const double last_a = grid.first_a + grid.columns / grid.pixels_per_a;
  const double last_b = grid.first_b + grid.rows / grid.pixels_per_b;
  const double steepest =
      std::max({std::abs(grid.first_a), std::abs(last_a), std::abs(grid.first_b), std::abs(last_b)});
  const double focal_px = std::max(grid.pixels_per_a, grid.pixels_per_b);
  camera.first_column = static_cast<float>(grid.first_a * grid.pixels_per_a);
  camera.first_row = static_cast<float>(grid.first_b * grid.pixels_per_b);
  camera.columns = grid.columns;
  camera.rows = grid.rows;
  camera.nearest_vox = static_cast<float>(static_cast<double>(min_t) / voxel_size_m * (1.0 - 1e-4) - 4.0 * kSlack_vox);
  camera.farthest_vox = static_cast<float>(static_cast<double>(max_t) / voxel_size_m * (1.0 + 1e-4) + 4.0 * kSlack_vox);
  camera.margin_px = static_cast<float>(kSlack_px + kSlackRate * focal_px * (1.0 + steepest) * (1.0 + steepest));
  camera.margin_px_by_vox = static_cast<float>(2.0 * kSlack_vox * focal_px * (1.0 + steepest));
  const ViewPyramid sides = pyramid_of(axes, grid);
  const GroupFilter filter{camera, sides};
  const BitRaster raster{bytes_.data(), stride_};
  for (const FaceGroup& group : faces.groups()) {
    if (filter.may_show(group)) draw_face_boxes(camera, faces, group, raster);
  }
}

std::uint64_t Footprint::count(const PixelRectangle& pixels) const {
  std::uint64_t set{0};
  const auto first = static_cast<std::size_t>(pixels.column_begin);
  const auto last = static_cast<std::size_t>(pixels.column_end);
  for (int row = pixels.row_begin; row < pixels.row_end; ++row) {
    const std::uint8_t* const bytes = bytes_.data() + static_cast<std::size_t>(row) * stride_;
    for (std::size_t at = first; at < last;) {
      std::uint64_t word{0};
      std::memcpy(&word, bytes + at / 8, sizeof word);
      const std::size_t bits = std::min<std::size_t>(56, last - at);
      set += static_cast<std::uint64_t>(std::popcount(word >> (at % 8) & ((std::uint64_t{1} << bits) - 1)));
      at += bits;
    }
  }
  return set;
}

}  // namespace saccade
