// SPDX-License-Identifier: Apache-2.0
#pragma once
// calibrate_hand_eye: pose of a depth camera on an arm's flange, and offset of its clock from the joints', from depth
// images and flange poses alone. view_agreement: agreement of views at given poses. docs/guides/calibration.md.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// View taken while the arm stood still.
struct StillView {
  DepthImage depth;
  Pose T_base_flange{Pose::Identity()};
};

/// View taken while the arm moved.
struct MovingView {
  DepthImage depth;
  std::optional<double> time_s;  ///< on the camera's clock
};

struct FlangeSample {
  double time_s{0.0};  ///< on the joints' clock
  Pose T_base_flange{Pose::Identity()};
};

/// Input of the calibration. Nothing visible may move, except the arm itself where it is masked.
struct HandEyeInput {
  PinholeCamera camera;
  std::vector<StillView> still;
  std::vector<MovingView> moving;             ///< one motion, in the order of taking
  std::vector<FlangeSample> flange;           ///< samples of that motion by increasing time, interpolated between
  std::optional<Pose> T_flange_camera_guess;  ///< within about 5 cm and 10°; without it, views must follow each other
                                              ///< closely
};

struct HandEyeConfig {
  double tracking_voxel_m{0.01};           ///< voxel size of the map that frames are tracked against
  std::size_t max_pairs{240};              ///< limit of the ordered pairs of views that are compared
  std::size_t max_moving_views{24};        ///< limit of the views in the refinement, evenly chosen; all are tracked
  double min_overlap{0.25};                ///< share of a view's points that the other view must have measured too
  double min_turn_rad{3.0_deg};            ///< required root mean square turn about a second axis
  double min_structure{0.01};              ///< share of the normals' squared lengths outside the main direction
  double max_clock_offset_s{0.5};          ///< limit in either direction
  double max_rotation_sigma_rad{1.0_deg};  ///< less certain mounts are not returned
  double max_translation_sigma_m{0.005};   ///< less certain mounts are not returned

  [[nodiscard]] Status validate() const;
};

/// Agreement of the points of one view with the depth image of another, over ordered pairs of views.
struct ViewAgreement {
  std::size_t pairs{0};        ///< ordered pairs of views with enough overlap
  std::size_t points{0};       ///< compared points: both views measured a depth there
  double agreeing{0.0};        ///< share of these within kSameSurface_m of the other view's depth
  double median_depth_m{0.0};  ///< median |Δz| of the agreeing points
  double median_plane_m{0.0};  ///< median distance of these from the other view's tangent planes

  static constexpr double kSameSurface_m{0.05};
};

/// Compares every 4th pixel of every 4th row of each view with every other view that shares min_overlap with it.
/// Errors: size_mismatch between images, poses and camera; invalid_argument for a bad camera.
/// O(views² · pixels). The thread count changes no bit of the result.
[[nodiscard]] Result<ViewAgreement> view_agreement(std::span<const DepthImage> depth, const PinholeCamera& camera,
                                                   std::span<const Pose> T_world_camera, const Executor& executor,
                                                   double min_overlap = HandEyeConfig{}.min_overlap);

struct HandEyeResult {
  std::optional<Pose> T_flange_camera;  ///< none where the input does not determine it; see `missing`
  std::vector<std::string> missing;     ///< sentences on what the input lacks and how to mend it

  double rotation_sigma_rad{0.0};   ///< standard deviation about the least certain axis
  double translation_sigma_m{0.0};  ///< standard deviation along `least_sure_flange`
  Eigen::Vector3d least_sure_flange{Eigen::Vector3d::Zero()};

  double flange_rotation_sigma_rad{0.0};   ///< accuracy of the flange poses, per axis, with this mount
  double flange_translation_sigma_m{0.0};  ///< at the camera

  std::optional<double> clock_offset_s;  ///< joints' time = camera's time + this
  double clock_sigma_s{0.0};
  std::string why_no_clock;  ///< set where there is no offset

  std::optional<Pose> T_flange_camera_tracked;    ///< stage 1's mount, by AX = XB
  std::optional<ViewAgreement> agreement_before;  ///< with the guess, or with stage 1's mount where there is none
  std::optional<ViewAgreement> agreement_after;
  std::size_t still_tracked{0};
  std::size_t moving_tracked{0};
  int iterations{0};
};

/// Stage 1 tracks the camera and solves AX = XB for the mount X (Park and Martin 1994; robustly weighted). It finds the
/// clock offset at which the turning speeds of camera and flange match. Stage 2 refines mount and offset by
/// Gauss–Newton over the point-to-plane distances between overlapping views, placed at T_base_flange · X · E. E is each
/// view's own small error, limited by the accuracy that the flange poses turn out to have. Standard deviations are
/// those of the delete-one-view jackknife; they do not include wrong intrinsics or systematically wrong depths.
/// Depth images are taken as they are: masked where the arm is visible, gaps filled where the camera leaves a net of
/// them. Input that determines no mount (no turning, turning about one axis, a single plane, views that do not overlap)
/// is a result that says so. Errors: invalid_argument for fewer than 3 views, bad poses, times that do not increase, or
/// a bad configuration; size_mismatch for images of another size than the camera's; cancelled.
/// O(pixels · (views + pairs · iterations)). The thread count changes no bit of the result.
[[nodiscard]] Result<HandEyeResult> calibrate_hand_eye(const HandEyeInput& input, const Executor& executor,
                                                       const HandEyeConfig& config = {},
                                                       const Progress* progress = nullptr);

}  // namespace saccade
