// SPDX-License-Identifier: Apache-2.0
// DepthFilter's method surface: points that Algorithm 5 and eq. 3.19 would remove stay where they lie on a surface.
#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/sensor/internal/shadow_likelihood.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"

namespace saccade {
namespace {

constexpr std::size_t kRowsAtOnce{16};
constexpr int kHalf{4};  // half of eight neighbours
constexpr int kMost{6};

bool is_return(float z) { return z > 0.0F && z <= std::numeric_limits<float>::max(); }

/// Returns the depth at a pixel; 0 outside the image too.
float return_at(const DepthImage& depth, int u, int v) {
  const bool inside = u >= 0 && v >= 0 && u < depth.width() && v < depth.height();
  return inside && is_return(depth(u, v)) ? depth(u, v) : 0.0F;
}

bool is_doubted(ShadowState state) { return state == ShadowState::suspect || state == ShadowState::in_shadow; }

/// Counts the pixels around (u, v) that satisfy `is`.
template <typename Is>
int count_around(int u, int v, int width, int height, const Is& is) {
  int count = 0;
  for (int j = std::max(0, v - 1); j <= std::min(height - 1, v + 1); ++j) {
    for (int i = std::max(0, u - 1); i <= std::min(width - 1, u + 1); ++i) {
      count += (i != u || j != v) && is(i, j) ? 1 : 0;
    }
  }
  return count;
}

/// Tells whether a pixel is a gap of one column between an object and its shadow.
bool is_column_cleared(const Image<ShadowState>& states, int u, int v) {
  return v > 0 && v + 1 < states.height() && states(u, v - 1) == ShadowState::cleared &&
         states(u, v + 1) == ShadowState::cleared;
}

/// Tests whether a point and the two next to it on one side form one flat surface. Depths are 0 where missing.
struct SupportTest {
  float jump_per_m;
  double tolerance_m;
  double tolerance_per_m;

  [[nodiscard]] bool jumps(float z, float z_next) const {
    return z_next > 0.0F && is_depth_jump(z, z_next, jump_per_m);
  }
  [[nodiscard]] bool is_straight(float z, float z_next, float z_second) const {
    if (!(z_next > 0.0F && z_second > 0.0F)) return false;
    const double at = z;
    const double off = 1.0 / at - 2.0 / static_cast<double>(z_next) + 1.0 / static_cast<double>(z_second);
    return std::abs(off) * at * at <= tolerance_m + tolerance_per_m * at;  // 1/z is linear on a plane
  }
  /// Tells whether the point hangs between surfaces along an axis: b is before it, f behind it.
  [[nodiscard]] bool is_loose(float b2, float b1, float z, float f1, float f2) const {
    const bool jumps_before = jumps(z, b1);
    const bool jumps_behind = jumps(z, f1);
    if (!jumps_before && !jumps_behind) return false;
    if (jumps_before && jumps_behind)
      return !(is_straight(z, b1, b2) && is_straight(z, f1, f2));  // seen at a low angle
    return jumps_before ? jumps(f1, f2) || !is_straight(z, f1, f2) : jumps(b1, b2) || !is_straight(z, b1, b2);
  }
};

/// Returns 1 for the pixels of a row that jump to one of their four neighbours, and for some beside no return.
std::vector<std::uint8_t> may_be_loose(const DepthImage& depth, int v, float across, float down) {
  const auto width = static_cast<std::size_t>(depth.width());
  const float* row = depth.row(v);
  const float* above = depth.row(std::max(0, v - 1));
  const float* below = depth.row(std::min(depth.height() - 1, v + 1));
  std::vector<std::uint8_t> may(width, 0);
  for (std::size_t u = 0; u < width; ++u) {
    may[u] = static_cast<std::uint8_t>(static_cast<int>(is_depth_jump(row[u], above[u], down)) |
                                       static_cast<int>(is_depth_jump(row[u], below[u], down)));
  }
  for (std::size_t u = 1; u < width; ++u) {
    const auto jump = static_cast<std::uint8_t>(is_depth_jump(row[u - 1], row[u], across));
    may[u - 1] |= jump;
    may[u] |= jump;
  }
  return may;
}

}  // namespace

Image<ShadowState> DepthFilter::classify_shadows(const DepthImage& depth, const Executor& executor) const {
  const int width = depth.width();
  const bool left = config_.emitter_side == EmitterSide::left;
  std::vector<double> x = x_;
  if (!left) std::transform(x_.rbegin(), x_.rend(), x.begin(), [](double at) { return -at; });
  const ShadowLikelihood doubt{{config_.baseline_m, config_.baseline_uncertainty, step_x_, jump_per_m(step_x_),
                                config_.tolerance_m, config_.tolerance_per_m},
                               std::move(x)};
  Image<ShadowState> states{width, depth.height()};
  executor.parallel_for(y_.size(), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    ShadowLikelihood of_rows = doubt;
    std::vector<float> mirrored(left ? 0 : x_.size());
    for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const float* z = depth.row(v);
      if (!left) {
        std::reverse_copy(z, z + width, mirrored.begin());
        z = mirrored.data();
      }
      ShadowState* row = states.row(v);
      std::transform(z, z + width, row,
                     [](float at) { return is_return(at) ? ShadowState::clear : ShadowState::no_return; });
      of_rows.classify(z, row);
      if (!left) std::reverse(row, row + width);
    }
  });
  return states;
}

/// Returns the angle of eq. 3.19 as a step in depth to a neighbour, per metre of depth; equivalent near the axis.
float DepthFilter::jump_per_m(double step) const { return static_cast<float>(step / std::tan(config_.veil_angle_rad)); }

void DepthFilter::mark_unlit_points(const DepthImage& depth, const Image<ShadowState>& states, int v,
                                    FilteredPixel* pixels) const {
  const int width = depth.width();
  const int height = depth.height();
  const int away = config_.emitter_side == EmitterSide::left ? 1 : -1;  // direction away from the emitter
  const SupportTest test{jump_per_m(step_x_), config_.tolerance_m, config_.tolerance_per_m};
  const auto is_lit_beside = [&](int u) {
    const float z = depth(u, v);
    return test.is_straight(z, return_at(depth, u + away, v), return_at(depth, u + 2 * away, v)) &&
           count_around(u, v, width, height, [&](int i, int j) {
             return is_return(depth(i, j)) && !is_doubted(states(i, j)) && !test.jumps(z, depth(i, j));
           }) >= kMost;
  };
  const auto is_alone = [&](int u) {
    return !is_column_cleared(states, u, v) &&
           count_around(u, v, width, height, [&](int i, int j) { return is_doubted(states(i, j)); }) >= kHalf;
  };
  for (int u = 0; u < width; ++u) {
    const ShadowState state = states(u, v);
    const bool unlit = is_doubted(state) || (state == ShadowState::cleared && is_alone(u)) ||
                       (state == ShadowState::beyond && !is_lit_beside(u));
    if (unlit) pixels[u] = FilteredPixel::shadow_point;
  }
}

void DepthFilter::mark_unsupported_points(const DepthImage& depth, const Image<ShadowState>& states, int v,
                                          FilteredPixel* pixels) const {
  const int width = depth.width();
  const SupportTest across{jump_per_m(step_x_), config_.tolerance_m, config_.tolerance_per_m};
  const SupportTest down{jump_per_m(step_y_), config_.tolerance_m, config_.tolerance_per_m};
  const std::vector<std::uint8_t> may = may_be_loose(depth, v, across.jump_per_m, down.jump_per_m);
  for (int u = 0; u < width; ++u) {
    if (may[static_cast<std::size_t>(u)] == 0 || pixels[u] != FilteredPixel::kept) continue;
    const auto at = [&](int i, int j) { return return_at(depth, i, j); };
    // A cleared point lies on a surface of its row, and may be next to an object and to its shadow.
    const bool is_cleared = !states.empty() && states(u, v) == ShadowState::cleared;
    const float z = depth(u, v);
    const bool loose = (!is_cleared && across.is_loose(at(u - 2, v), at(u - 1, v), z, at(u + 1, v), at(u + 2, v))) ||
                       down.is_loose(at(u, v - 2), at(u, v - 1), z, at(u, v + 1), at(u, v + 2));
    if (loose) pixels[u] = FilteredPixel::veil_point;
  }
}

}  // namespace saccade
