// SPDX-License-Identifier: Apache-2.0
#pragma once
// refine_mount: mount and clock offset by Gauss–Newton over the distances between overlapping views; overlaps and
// agreement of views; spread of a scene's normals.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "saccade/sensor/point_image.hpp"
#include "saccade/tracking/hand_eye.hpp"
#include "saccade/tracking/internal/clock_match.hpp"

namespace saccade {

/// View to compare with others, with its flange pose or its time.
struct MountView {
  PointImage points;
  Pose T_base_flange{Pose::Identity()};
  std::optional<double> time_s{};  ///< on the camera's clock, for a moving view; the record then gives the pose
};

using ViewPair = std::pair<std::size_t, std::size_t>;  ///< measured, model
using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// Returns ordered pairs of views that share at least min_overlap of the first one's points; max_pairs evenly chosen
/// ones where there are more.
[[nodiscard]] std::vector<ViewPair> overlapping_pairs(std::span<const PointImage* const> views,
                                                      const PinholeCamera& camera, std::span<const Pose> T_world_camera,
                                                      double min_overlap, std::size_t max_pairs,
                                                      const Executor& executor);

[[nodiscard]] ViewAgreement agreement_of(std::span<const PointImage* const> views, const PinholeCamera& camera,
                                         std::span<const Pose> T_world_camera, std::span<const ViewPair> pairs,
                                         const Executor& executor);

/// Returns the mean of n nᵀ over the views' normals, each a mean over a square of pixels so that noise averages out.
/// Its eigenvalues add up to 1; one of them is 1 where everything is a single plane.
[[nodiscard]] Eigen::Matrix3d normals_of(std::span<const PointImage* const> views,
                                         std::span<const Pose> T_world_camera);

struct MountEstimate {
  Pose T_flange_camera{Pose::Identity()};
  double clock_offset_s{0.0};
  /// Rotation vector and translation in the camera's frame (X · exp(x)), then the clock offset; rad, m, s.
  Matrix7d covariance{Matrix7d::Zero()};
  double flange_rotation_sigma_rad{0.0};  ///< accuracy of the flange poses, per axis
  double flange_translation_sigma_m{0.0};
  std::size_t pairs{0};
  int iterations{0};
};

/// Refines the mount. Expects at least three views; moving ones need the record. The offset is refined where views
/// move.
[[nodiscard]] MountEstimate refine_mount(std::span<const MountView> views, const PinholeCamera& camera,
                                         const FlangeRecord& record, const MountEstimate& start,
                                         const HandEyeConfig& config, const Executor& executor);

/// Returns the poses of the views' cameras for a mount and a clock offset.
[[nodiscard]] std::vector<Pose> camera_poses(std::span<const MountView> views, const FlangeRecord& record,
                                             const Pose& T_flange_camera, double clock_offset_s);

}  // namespace saccade
