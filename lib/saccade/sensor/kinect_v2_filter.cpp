// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/kinect_v2_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "saccade/sensor/internal/shadow_likelihood.hpp"

namespace saccade {
namespace {

constexpr double kMaxBaseline_m{1.0};
constexpr std::size_t kRowGrain{16};

std::vector<double> rays(int count, double center, double focal_length) {
  std::vector<double> at(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = (static_cast<double>(i) - center) / focal_length;
  return at;
}

FilteredPixel as_it_came(float z) {
  return z > 0.0F && z <= std::numeric_limits<float>::max() ? FilteredPixel::kept : FilteredPixel::no_return;
}

struct RowCounts {
  std::size_t points{0};
  std::size_t shadow_points{0};
  std::size_t veil_points{0};
};

/// Clears removed pixels and counts them.
RowCounts remove_marked(const FilteredPixel* pixels, int width, float* z) {
  RowCounts counts;
  for (int u = 0; u < width; ++u) {
    counts.points += pixels[u] != FilteredPixel::no_return ? 1U : 0U;
    counts.shadow_points += pixels[u] == FilteredPixel::shadow_point ? 1U : 0U;
    counts.veil_points += pixels[u] == FilteredPixel::veil_point ? 1U : 0U;
    if (pixels[u] > FilteredPixel::kept) z[u] = 0.0F;
  }
  return counts;
}

/// Eq. 3.19 for p_i = z·r and its neighbour p_k = z_k·(r + s), s being one pixel along x or y. With d = p_k − p_i the
/// angle between d and r is below Θ when |d × r| < tan Θ · |d · r|; here d × r = z_k · (s × r) and
/// d · r = (z_k − z)·|r|² + z_k · (s · r).
struct VeilTest {
  double norm2;  ///< |r|²
  double tan_angle;

  [[nodiscard]] bool operator()(double z, double z_k, double cross, double dot) const {
    return z_k > 0.0 && z_k * cross < tan_angle * std::abs((z_k - z) * norm2 + z_k * dot);
  }
};

}  // namespace

Status DepthFilterConfig::validate() const {
  if (!(baseline_m >= 0.0 && baseline_m <= kMaxBaseline_m)) {
    return Error{Errc::invalid_argument, "the emitter's distance from the camera must be within 0 and 1 m", {}};
  }
  if (!(baseline_uncertainty >= 0.0 && baseline_uncertainty <= 1.0)) {
    return Error{Errc::invalid_argument, "the uncertainty of the emitter's distance is a share, within 0 and 1", {}};
  }
  if (!(tolerance_m >= 0.0 && std::isfinite(tolerance_m) && tolerance_per_m >= 0.0 && std::isfinite(tolerance_per_m))) {
    return Error{Errc::invalid_argument, "the tolerance of surfaces must be finite and not negative", {}};
  }
  if (!(veil_angle_rad > 0.0 && veil_angle_rad < 90_deg)) {
    return Error{Errc::invalid_argument, "the angle of veil points must be above 0 and below 90 degrees", {}};
  }
  return {};
}

Result<DepthFilter> DepthFilter::create(const PinholeCamera& camera, const DepthFilterConfig& config) {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK(config.validate());
  return DepthFilter{camera, config};
}

DepthFilter::DepthFilter(const PinholeCamera& camera, const DepthFilterConfig& config)
    : config_{config},
      x_{rays(camera.width, camera.cx, camera.fx)},
      y_{rays(camera.height, camera.cy, camera.fy)},
      step_x_{1.0 / camera.fx},
      step_y_{1.0 / camera.fy} {}

/// Algorithm 5. β' = x'/z = x/z + Δ/z; for an emitter on the right, in the mirrored row.
void DepthFilter::mark_shadow_points(const float* z, FilteredPixel* pixels) const {
  const std::size_t width = x_.size();
  const bool left = config_.emitter_side == EmitterSide::left;
  double max_beta{-std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < width; ++i) {
    const std::size_t u = left ? i : width - 1 - i;
    if (pixels[u] == FilteredPixel::no_return) continue;
    const double beta = (left ? x_[u] : -x_[u]) + config_.baseline_m / static_cast<double>(z[u]);
    if (beta <= max_beta) {
      pixels[u] = FilteredPixel::shadow_point;
    } else {
      max_beta = beta;
    }
  }
}

void DepthFilter::mark_veil_points(const DepthImage& depth, int v, FilteredPixel* pixels) const {
  const float* row = depth.row(v);
  const float* above = v > 0 ? depth.row(v - 1) : nullptr;
  const float* below = v + 1 < depth.height() ? depth.row(v + 1) : nullptr;
  const int width = depth.width();
  const double y = y_[static_cast<std::size_t>(v)];
  const double cross_x = step_x_ * std::sqrt(1.0 + y * y);
  const double tan_angle = std::tan(config_.veil_angle_rad);
  for (int u = 0; u < width; ++u) {
    if (pixels[u] != FilteredPixel::kept) continue;
    const double x = x_[static_cast<std::size_t>(u)];
    const double z = row[u];
    const double cross_y = step_y_ * std::sqrt(1.0 + x * x);
    const VeilTest veils{1.0 + x * x + y * y, tan_angle};
    const bool veil = (u > 0 && veils(z, row[u - 1], cross_x, -step_x_ * x)) ||
                      (u + 1 < width && veils(z, row[u + 1], cross_x, step_x_ * x)) ||
                      (above != nullptr && veils(z, above[u], cross_y, -step_y_ * y)) ||
                      (below != nullptr && veils(z, below[u], cross_y, step_y_ * y));
    if (veil) pixels[u] = FilteredPixel::veil_point;
  }
}

Result<FilteredDepth> DepthFilter::filter(const DepthImage& depth, const Executor& executor) const {
  const int width = static_cast<int>(x_.size());
  const int height = static_cast<int>(y_.size());
  if (depth.width() != width || depth.height() != height) {
    return Error{Errc::size_mismatch,
                 "the depth image has " + std::to_string(depth.width()) + "x" + std::to_string(depth.height()) +
                     " pixels, the camera " + std::to_string(width) + "x" + std::to_string(height),
                 {}};
  }
  FilteredDepth result{depth, {width, height}};
  const bool by_surface = config_.method == DepthFilterMethod::surface;
  const bool classifies_shadows = by_surface && config_.remove_shadow_points;
  const Image<ShadowState> states = classifies_shadows ? classify_shadows(depth, executor) : Image<ShadowState>{};
  std::vector<RowCounts> counts(y_.size());
  executor.parallel_for(counts.size(), kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int v = static_cast<int>(i);
      FilteredPixel* pixels = result.pixels.row(v);
      std::transform(depth.row(v), depth.row(v) + width, pixels, as_it_came);
      if (classifies_shadows) mark_unlit_points(depth, states, v, pixels);
      if (config_.remove_shadow_points && !by_surface) mark_shadow_points(depth.row(v), pixels);
      if (config_.remove_veil_points && by_surface) mark_unsupported_points(depth, states, v, pixels);
      if (config_.remove_veil_points && !by_surface) mark_veil_points(depth, v, pixels);
      counts[i] = remove_marked(pixels, width, result.depth.row(v));
    }
  });
  for (const RowCounts& row : counts) {
    result.points += row.points;
    result.shadow_points += row.shadow_points;
    result.veil_points += row.veil_points;
  }
  return result;
}

}  // namespace saccade
