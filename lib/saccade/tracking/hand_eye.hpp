// SPDX-License-Identifier: Apache-2.0
#pragma once
// calibrate_hand_eye: where a depth camera sits on an arm's flange, and how its clock differs from the joints', from
// depth images and flange poses alone; view_agreement: how well views agree at given poses. docs/calibration.md.

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

/// Taken where the arm stood still.
struct StillView {
  DepthImage depth;
  Pose T_base_flange{Pose::Identity()};
};

/// Taken while the arm moved.
struct MovingView {
  DepthImage depth;
  std::optional<double> time_s;  ///< on the camera's clock
};

struct FlangeSample {
  double time_s{0.0};  ///< on the joints' clock
  Pose T_base_flange{Pose::Identity()};
};

/// Nothing that is seen may move, the arm itself excepted where it is masked out.
struct HandEyeInput {
  PinholeCamera camera;
  std::vector<StillView> still;
  std::vector<MovingView> moving;             ///< one motion, in the order of taking
  std::vector<FlangeSample> flange;           ///< during that motion, times rising; between samples it is interpolated
  std::optional<Pose> T_flange_camera_guess;  ///< within about 5 cm and 10°; without one, views must follow closely
};

struct HandEyeConfig {
  double tracking_voxel_m{0.01};           ///< voxels of the map that frames are tracked against
  std::size_t max_pairs{240};              ///< ordered pairs of views that are compared, at most
  std::size_t max_moving_views{24};        ///< that take part in the refinement, evenly chosen; all are tracked
  double min_overlap{0.25};                ///< share of a view's points that the other view has measured, too
  double min_turn_rad{3.0_deg};            ///< root mean square turn about a second axis that the views must have
  double min_structure{0.01};              ///< share of the normals' squared lengths outside the main direction
  double max_clock_offset_s{0.5};          ///< either way
  double max_rotation_sigma_rad{1.0_deg};  ///< a mount that is less sure is not returned
  double max_translation_sigma_m{0.005};   ///< a mount that is less sure is not returned

  [[nodiscard]] Status validate() const;
};

/// Points of one view against the depth image of another, over ordered pairs of views.
struct ViewAgreement {
  std::size_t pairs{0};        ///< ordered pairs of views that share enough
  std::size_t points{0};       ///< that were compared: both views measured a depth there
  double agreeing{0.0};        ///< share of those that lie within kSameSurface_m of the other view's depth
  double median_depth_m{0.0};  ///< median |Δz| of the agreeing points
  double median_plane_m{0.0};  ///< median of their distances from the other view's tangent planes

  static constexpr double kSameSurface_m{0.05};
};

/// Compares every 4th pixel of every 4th row of each view with every other view that shares min_overlap with it.
/// Errors: size_mismatch between images, poses and camera; invalid_argument for a bad camera.
/// O(views² · pixels). The thread count changes no bit of the result.
[[nodiscard]] Result<ViewAgreement> view_agreement(std::span<const DepthImage> depth, const PinholeCamera& camera,
                                                   std::span<const Pose> T_world_camera, const Executor& executor,
                                                   double min_overlap = HandEyeConfig{}.min_overlap);

struct HandEyeResult {
  std::optional<Pose> T_flange_camera;  ///< none where it is not determined; `missing` then says what is
  std::vector<std::string> missing;     ///< sentences on what the input lacks and what to do about it

  double rotation_sigma_rad{0.0};   ///< standard deviation about the least sure axis
  double translation_sigma_m{0.0};  ///< standard deviation along `least_sure_flange`
  Eigen::Vector3d least_sure_flange{Eigen::Vector3d::Zero()};

  double flange_rotation_sigma_rad{0.0};   ///< how exact the flange poses are, by axis, with the mount that was found
  double flange_translation_sigma_m{0.0};  ///< at the camera

  std::optional<double> clock_offset_s;  ///< joints' time = camera's time + this
  double clock_sigma_s{0.0};
  std::string why_no_clock;  ///< where there is no offset

  std::optional<Pose> T_flange_camera_tracked;    ///< stage 1's mount, by AX = XB
  std::optional<ViewAgreement> agreement_before;  ///< with the guess, or with stage 1's mount where there is none
  std::optional<ViewAgreement> agreement_after;
  std::size_t still_tracked{0};
  std::size_t moving_tracked{0};
  int iterations{0};
};

/// Stage 1 tracks the camera and solves AX = XB for the mount X (Park and Martin 1994; robustly weighted), and finds
/// the clock offset where the turning speeds of camera and flange match. Stage 2 refines mount and offset by
/// Gauss–Newton over the point-to-plane distances between overlapping views, placed at T_base_flange · X · E, where E
/// is each view's own small error, held by how exact flange poses turn out to be. Standard deviations are those of the
/// delete-one-view jackknife; they know nothing of wrong intrinsics or of depths that are wrong everywhere.
/// Depth images are taken as they are: masked where the arm is seen, gaps filled where the camera leaves a net of them.
/// Input that determines no mount (no turning, turning about one axis, a single plane, views that do not overlap) is a
/// result that says so. Errors: invalid_argument for fewer than 3 views, bad poses, times that do not rise, or a
/// bad configuration; size_mismatch for images of another size than the camera's; cancelled.
/// O(pixels · (views + pairs · iterations)). The thread count changes no bit of the result.
[[nodiscard]] Result<HandEyeResult> calibrate_hand_eye(const HandEyeInput& input, const Executor& executor,
                                                       const HandEyeConfig& config = {},
                                                       const Progress* progress = nullptr);

}  // namespace saccade
