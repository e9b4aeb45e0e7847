// SPDX-License-Identifier: Apache-2.0
#pragma once
// RgbdTracker: follows an RGB-D camera before a surface, and finds it again after a loss.

#include <functional>
#include <optional>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/point_image.hpp"
#include "saccade/tracking/frame_report.hpp"
#include "saccade/tracking/keyframes.hpp"
#include "saccade/tracking/rgbd_alignment.hpp"

namespace saccade {

/// Returns the surface that frames are aligned to, as the camera sees it from a pose.
using SurfaceAt = std::function<Result<PointImage>(const Pose& T_world_camera)>;
/// Returns the ray cast of a map, which must outlive it. Errors: those of raycast.
[[nodiscard]] SurfaceAt surface_of_map(const TsdfSnapshot& map, const PinholeCamera& camera, const Executor& executor);

struct RgbdTrackerConfig {
  RgbdConfig alignment{};
  KeyframesConfig keyframes{};
  std::size_t relocalisation_tries{4};  ///< keyframes that a lost frame is aligned from
  /// A frame that fits worse than usual by more than some deviations, within these bounds, is looked for once more.
  double doubtful_deviations{3.0};
  double least_doubt{0.005};
  double most_doubt{0.04};
  double relocalisation_agreement{0.90};  ///< least agreement of a frame that is found from a keyframe

  [[nodiscard]] Status validate() const;
};

/// Tracks frames one after the other by align_rgbd. The grey values of the surface are those of the nearest keyframe
/// that was fused, so any source of surfaces will do, with colours or without. One thread calling; the result does not
/// depend on the number of threads.
class RgbdTracker {
 public:
  explicit RgbdTracker(const RgbdTrackerConfig& config = {}) : config_{config}, keyframes_{config.keyframes} {}

  /// Finds the pose of a frame. Starts where the motion of the last two frames leads; if that fails, or fits worse
  /// than frames before, there without RgbdConfig::far, whose pairs far apart may be false ones, and at the last pose;
  /// then at the poses of the keyframes that look most like the frame. A lost track is a result.
  /// @return errors of `surface_at`, size_mismatch for images whose size is not the camera's.
  [[nodiscard]] Result<FrameReport> track(const SurfaceAt& surface_at, const Frame& frame, const PinholeCamera& camera,
                                          const Executor& executor);
  /// Finds the pose of a frame near `T_world_start` alone.
  [[nodiscard]] Result<FrameReport> track_from(const SurfaceAt& surface_at, const Frame& frame,
                                               const PinholeCamera& camera, const Pose& T_world_start,
                                               const Executor& executor);
  /// Takes note of a frame that was fused at a pose.
  void fused(const Frame& frame, const PinholeCamera& camera, const Pose& T_world_camera, const Executor& executor);
  /// The camera was moved meanwhile, and its next frame is near this pose.
  void moved_to(const Pose& T_world_camera);

  [[nodiscard]] const RgbdTrackerConfig& config() const { return config_; }
  [[nodiscard]] const Keyframes& keyframes() const { return keyframes_; }

 private:
  /// Poses to start from, in order, before keyframes are asked.
  [[nodiscard]] std::vector<Pose> starts() const;
  /// Returns the surface as seen from a pose, with the grey values of the nearest keyframe.
  [[nodiscard]] Result<GreyPoints> model_at(const SurfaceAt& surface_at, const GreyPoints& measured,
                                            const PinholeCamera& camera, const Pose& T_world_camera,
                                            const Executor& executor) const;
  /// Aligns a frame to such a surface.
  [[nodiscard]] static FrameReport align_to(const GreyPoints& model, const GreyPoints& measured,
                                            const PinholeCamera& camera, const Pose& T_world_start,
                                            const RgbdConfig& how, const Executor& executor);
  /// Tells whether a frame fits as well as usual.
  [[nodiscard]] bool is_usual(double fit) const;

  RgbdTrackerConfig config_;
  Keyframes keyframes_;
  std::optional<Pose> T_world_last_;
  std::optional<Pose> T_before_last_;  ///< motion between the last two frames
  std::optional<double> usual_fit_;
  double usual_deviation_{0.0};  ///< mean difference between a fit and the usual one
  std::size_t lost_{0};          ///< frames since the last that was found
};

}  // namespace saccade
