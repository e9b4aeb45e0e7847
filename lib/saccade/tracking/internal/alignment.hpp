// SPDX-License-Identifier: Apache-2.0
#pragma once
// Alignment: normal equations of the point-to-plane distances between measured points and a model, paired by
// projection. Level: every n-th of the measured points. For ICP and for hand-eye calibration.

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/sensor/point_image.hpp"
#include "saccade/tracking/internal/icp_kernels.hpp"

namespace saccade {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Sums of the normal equations Σ w JᵀJ x = −Σ w Jᵀ r, x = (rotation vector, translation) from the left, with w in
/// 1/mm².
struct NormalEquations {
  Matrix6d JtJ{Matrix6d::Zero()};  ///< only its lower half
  Vector6d Jtr{Vector6d::Zero()};
  double squared_residuals{0.0};  ///< m², without weights
  std::size_t pairs{0};
  std::size_t measured{0};

  NormalEquations& operator+=(const NormalEquations& other);
};

/// Returns the sum of the lanes of one chunk, in order.
[[nodiscard]] double sum_of_lanes(const std::array<float, kPairLanes>& lanes);
/// Returns JtJ and Jtr of one chunk, from the products of PairSums.
[[nodiscard]] NormalEquations equations_of(const PairProducts& products);

/// Rows of a level that are summed together; the sums of such chunks are added in order.
constexpr std::size_t kRowsPerChunk{8};

/// Every stride-th point of every stride-th row, side by side. With stride 1 it borrows the image, which must outlive
/// it.
class Level {
 public:
  Level(const PointImage& image, int stride);
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

  [[nodiscard]] const LevelPoints& points() const { return points_; }
  [[nodiscard]] std::size_t measured() const;

 private:
  LevelPoints points_;
  Image<float> z_, nx_, ny_, nz_;
};

struct PairLimits {
  double max_distance_m{0.10};
  double max_normal_angle_rad{0.6};
};

/// Alignment with a model of the camera's size, which must outlive it.
class Alignment {
 public:
  Alignment(const PointImage& model, const PinholeCamera& camera, const PairLimits& limits);
  /// Sums the normal equations in fixed lanes and chunks, so that threads change no bit. O(points of the level).
  [[nodiscard]] NormalEquations linearize(const Pose& T_model_camera, const Level& level,
                                          const Executor& executor) const;
  /// Returns the task of a linearisation at this pose, without measured points.
  [[nodiscard]] PairingTask task(const Pose& T_model_camera) const;

 private:
  PairingTask task_;
};

/// Returns the pose of a rotation vector and translation applied from the left.
[[nodiscard]] Pose exponential(const Vector6d& x);

}  // namespace saccade
