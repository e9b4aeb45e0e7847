// SPDX-License-Identifier: Apache-2.0
#pragma once
// TrajectoryError: a tracked trajectory compared with the true one. DepthResidual: distances between the map's surface
// and measured depths.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// Distances between camera positions, metres.
struct TrajectoryError {
  std::size_t poses{0};
  double first_pose_rmse_m{0.0};  ///< both trajectories joined at their first pose: contains all drift
  double aligned_rmse_m{0.0};     ///< after the rigid motion (no scale) that makes it smallest
  double max_m{0.0};              ///< largest distance after the same rigid motion
  double last_pose_m{0.0};        ///< distance of the last positions, with both joined at their first pose
};

/// Compares pose i of one trajectory with pose i of the other; the absolute trajectory error of Sturm et al. (IROS
/// 2012), aligned as in Umeyama (PAMI 1991) without scale. Either trajectory may have its own world frame.
/// @return invalid_argument for no poses, size_mismatch for different numbers of poses. O(n), one thread.
[[nodiscard]] Result<TrajectoryError> trajectory_error(std::span<const Pose> T_world_estimated,
                                                       std::span<const Pose> T_world_true);

/// Collects |ray cast − measured| along z. A pixel is valid when its measured depth is a return (> 0, finite); it
/// counts when the ray cast met a surface there. One thread.
class DepthResidual {
 public:
  /// Adds an image pair. Answers size_mismatch when the sizes differ; then nothing is added. O(pixels).
  [[nodiscard]] Status add(const DepthImage& measured, const DepthImage& map_cast);

  [[nodiscard]] std::uint64_t valid() const { return valid_; }
  [[nodiscard]] std::uint64_t taking_part() const { return taking_part_; }
  /// Returns the share of the valid pixels that count; 0 without valid pixels.
  [[nodiscard]] double share() const;
  /// Returns the median residual, to half of kStep_m; residuals beyond kLargest_m count as kLargest_m. 0 without
  /// residuals.
  [[nodiscard]] double median_m() const;

  static constexpr double kStep_m{1e-5};
  static constexpr double kLargest_m{1.0};

 private:
  std::vector<std::uint64_t> histogram_;  ///< by steps of kStep_m
  std::uint64_t valid_{0};
  std::uint64_t taking_part_{0};
};

}  // namespace saccade
