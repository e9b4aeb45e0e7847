// SPDX-License-Identifier: Apache-2.0
#pragma once
// linearize_color_rows: the inner loop of aligning colours, in vectors of pixels. For rgbd_alignment.cpp and its tests.

#include <array>
#include <cstddef>

#include "saccade/tracking/internal/icp_kernels.hpp"

namespace saccade {

/// Grey values that the model's camera saw, with their slopes, at every stride-th pixel of every stride-th row.
struct ReferenceLevel {
  const float* z{nullptr};        ///< depth of the model there, metres; 0 where grey or slopes are unknown
  const float* grey{nullptr};     ///< 0 to 255
  const float* slope_u{nullptr};  ///< grey per pixel of this level
  const float* slope_v{nullptr};
  int width{0};
  int height{0};
};

/// One linearisation of the differences between grey values. R to inverse_fy as in PairingTask.
struct ColorTask {
  LevelPoints measured;                 ///< its depths alone count
  const float* measured_grey{nullptr};  ///< grey of these pixels; 0 where unknown
  ReferenceLevel reference;             ///< has the stride of `measured`
  std::array<float, 9> R{};
  std::array<float, 3> t{};
  float fx{1.0F}, fy{1.0F}, cx{0.0F}, cy{0.0F};
  float inverse_fx{1.0F}, inverse_fy{1.0F};
  float gain{1.0F};   ///< the measured grey times this is compared with the reference
  float sigma{1.0F};  ///< standard deviation of the difference, grey
};

/// Sums over pairs, lane by lane, as PairSums. With g the slope of the reference along x, y and z of the point p, and
/// J = (p × g, g, difference):
struct ColorSums {
  alignas(64) PairProducts products{};
  alignas(64) std::array<float, kPairLanes> reference{};  ///< sum of the reference's grey
  alignas(64) std::array<float, kPairLanes> measured{};   ///< sum of the measured grey, without gain
  std::size_t pairs{0};
  std::size_t agreeing{0};  ///< pairs that differ by less than kAgreeingSigmas
};

constexpr float kColorHuberSigmas{1.5F};
constexpr float kAgreeingSigmas{2.0F};
constexpr float kSameSurface_m{0.02F};      ///< a pair's depths differ by no more than this,
constexpr float kSameSurfaceGrowth{0.02F};  ///< and this share of the depth

/// Pairs the measured pixels of the level's rows [begin, end) with the reference by projection to the nearest pixel,
/// where its grey and slopes continue it linearly, and adds them to the sums. Weights are 1e-6 / sigma² times Huber's,
/// so that they add to those of linearize_rows. Every simd_target() gives the same bits.
void linearize_color_rows(const ColorTask& task, int begin, int end, ColorSums& sums);

}  // namespace saccade
