// SPDX-License-Identifier: Apache-2.0
#pragma once
// linearize_rows: the inner loop of ICP, in vectors of pixels. For icp.cpp and its tests.

#include <array>
#include <cstddef>

namespace saccade {

/// Partial sums per value: the pixel in column u of a level adds to sum u mod 16, whatever the width of a vector.
constexpr int kPairLanes{16};

/// Normals and depths of every stride-th pixel of every stride-th row, `width` to a row.
struct LevelPoints {
  const float* z{nullptr};
  const float* nx{nullptr};
  const float* ny{nullptr};
  const float* nz{nullptr};
  int width{0};
  int height{0};
  int stride{1};
};

/// One linearisation: all measured points of a level, the model's points, and the assumed camera pose.
struct PairingTask {
  LevelPoints measured;
  LevelPoints model;                             ///< stride 1
  std::array<float, 9> R{};                      ///< rotation of T_model_camera, row by row
  std::array<float, 3> t{};                      ///< translation of T_model_camera, metres
  float fx{1.0F}, fy{1.0F}, cx{0.0F}, cy{0.0F};  ///< pixels
  float inverse_fx{1.0F}, inverse_fy{1.0F};
  float max_squared_distance_m2{0.0F};
  float min_normal_cosine{0.0F};
};

/// w J_i J_j for i = 0 … 5, j = i … 6, in that order, lane by lane.
using PairProducts = std::array<std::array<float, kPairLanes>, 27>;

/// Sums over pairs, lane by lane. With J = (p × n, n, n·(p − q)) per pair and w its weight:
struct PairSums {
  static constexpr int kProducts{27};
  alignas(64) PairProducts products{};
  alignas(64) std::array<float, kPairLanes> squared_residuals{};  ///< J_6², m²
  std::size_t pairs{0};
};

/// Pairs the measured points of the level's rows [begin, end) with the model by projection, and adds them to the sums.
/// The weight is that of depth noise (growing with z²) times Huber's, in units of 1/mm² (so sums stay near 1 per pair).
/// Every simd_target() gives the same bits.
void linearize_rows(const PairingTask& task, int begin, int end, PairSums& sums);

/// Standard deviation of a structured-light depth z: kNearest near, growing with z² beyond kFrom.
struct DepthSigma {
  static constexpr float kNearest_m{0.0012F};
  static constexpr float kGrowth_per_m{0.0019F};
  static constexpr float kFrom_m{0.4F};
};
constexpr float kHuberSigmas{1.5F};       ///< standard deviations beyond which residuals count linearly
constexpr float kMinModelDepth_m{1e-3F};  ///< points nearer to the model's camera are not projected

}  // namespace saccade
