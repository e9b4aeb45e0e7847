// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reconstruction: tracks and fuses depth frames into a persistent map; can be suspended and resumed.

#include <optional>
#include <string>

#include "saccade/core/names.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/tracking/frame_report.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/tracking/rgbd_tracker.hpp"
#include "saccade/tracking/tracking_device.hpp"

namespace saccade {

/// Source of a frame's pose. Thesis §2.3.1, Listing 2.1.
enum class TrackingMode {
  icp,     ///< ICP started at the last pose (HINT_TYPE_NONE)
  hint,    ///< ICP started at the given pose (HINT_TYPE_HINT)
  forced,  ///< the given pose is used unchanged (HINT_TYPE_FORCED)
  rgbd,    ///< RgbdTracker: ICP with colours, started where the last motion leads
};
inline constexpr auto kTrackingModeNames = make_names<TrackingMode>({{TrackingMode::icp, "icp"},
                                                                     {TrackingMode::rgbd, "rgbd"},
                                                                     {TrackingMode::hint, "hint"},
                                                                     {TrackingMode::forced, "forced"}});
[[nodiscard]] constexpr std::string_view to_string(TrackingMode mode) { return kTrackingModeNames.of(mode); }
/// Tells whether a mode needs a pose for every frame.
[[nodiscard]] constexpr bool needs_pose(TrackingMode mode) {
  return mode == TrackingMode::hint || mode == TrackingMode::forced;
}

struct ReconstructionConfig {
  TsdfConfig map;
  IcpConfig icp;
  RgbdTrackerConfig rgbd{};  ///< for mode rgbd
};

/// Finds the pose of a frame by ICP against the map as seen from `T_world_start`. Fuses nothing. A lost track is a
/// result. Errors: size_mismatch, and those of raycast.
/// @param device  casts the map and aligns the frame, with the same result; nullptr: the CPU does
[[nodiscard]] Result<FrameReport> track_frame(const TsdfSnapshot& map, const Frame& frame, const PinholeCamera& camera,
                                              const Pose& T_world_start, const Executor& executor,
                                              const IcpConfig& icp = {}, TrackingDevice* device = nullptr);

/// KinectFusion's loop (thesis §2.2.1): ray cast, convert, track, integrate. One frame at a time, one thread calling;
/// snapshots of map() may be taken from other threads.
class Reconstruction {
 public:
  [[nodiscard]] static Result<Reconstruction> create(const ReconstructionConfig& config);
  /// Continues with an existing map, for example a loaded one, and its configuration.
  [[nodiscard]] static Result<Reconstruction> resume(TsdfSnapshot content, const IcpConfig& icp,
                                                     const RgbdTrackerConfig& rgbd = {});

  /// Tracks and fuses one frame.
  /// @param hint T_world_camera; needed for modes hint and forced. In modes icp and rgbd, the pose of the first frame
  /// (identity
  ///        without one); afterwards unused.
  /// @return the result; a lost track is not an error. Errors: size_mismatch, invalid_argument (no hint where one is
  /// needed, a bad camera or pose).
  [[nodiscard]] Result<FrameReport> process(const Frame& frame, const PinholeCamera& camera, TrackingMode mode,
                                            const std::optional<Pose>& hint, const Executor& executor);

  /// Lets a device cast the map, and align frames in all modes but rgbd, with the same results; nullptr: the CPU does.
  /// The device must outlive its use here. It may keep the map's bricks as of the last frame, and the CPU may have to
  /// do the work while sectors are paged out.
  void track_on(TrackingDevice* device) { device_ = device; }

  /// Ignores frames until resume(). The map persists.
  void suspend() { suspended_ = true; }
  /// Resumes near this pose: ICP starts there for the next frame, however far the camera moved meanwhile.
  void resume(const Pose& T_world_camera_hint);
  [[nodiscard]] bool suspended() const { return suspended_; }

  /// Goes on with another map, in which the last frame has another pose: corrected ones. @return the map until now.
  [[nodiscard]] TsdfMap exchange_map(TsdfMap map, const Pose& T_world_camera_last);

  [[nodiscard]] TsdfMap& map() { return map_; }
  [[nodiscard]] const TsdfMap& map() const { return map_; }
  /// Returns the pose of the last fused frame.
  [[nodiscard]] const std::optional<Pose>& last_pose() const { return T_world_last_; }

 private:
  /// Returns the ray cast of the map, with what is paged out brought in.
  [[nodiscard]] SurfaceAt seen_surface(const PinholeCamera& camera, const Executor& executor);
  Reconstruction(TsdfMap map, const IcpConfig& icp, const RgbdTrackerConfig& rgbd)
      : map_{std::move(map)}, icp_{icp}, tracker_{rgbd} {}

  TsdfMap map_;
  IcpConfig icp_;
  RgbdTracker tracker_;
  TrackingDevice* device_{nullptr};
  bool suspended_{false};
  std::optional<Pose> T_world_last_;
  std::optional<Pose> T_world_resume_;
};

}  // namespace saccade
