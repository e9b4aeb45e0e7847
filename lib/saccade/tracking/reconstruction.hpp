// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reconstruction: tracks and fuses depth frames into a persistent map; can be suspended and resumed.

#include <optional>
#include <string>

#include "saccade/core/names.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/tracking/icp.hpp"

namespace saccade {

/// Source of a frame's pose. Thesis §2.3.1, Listing 2.1.
enum class TrackingMode {
  icp,     ///< ICP started at the last pose (HINT_TYPE_NONE)
  hint,    ///< ICP started at the given pose (HINT_TYPE_HINT)
  forced,  ///< the given pose is used unchanged (HINT_TYPE_FORCED)
};
inline constexpr auto kTrackingModeNames = make_names<TrackingMode>(
    {{TrackingMode::icp, "icp"}, {TrackingMode::hint, "hint"}, {TrackingMode::forced, "forced"}});
[[nodiscard]] constexpr std::string_view to_string(TrackingMode mode) { return kTrackingModeNames.of(mode); }

struct ReconstructionConfig {
  TsdfConfig map;
  IcpConfig icp;
};

/// Result of processing one frame.
struct FrameReport {
  enum class Status {
    fused,
    lost,       ///< no pose was found: the map is untouched and the last good pose is kept
    suspended,  ///< fusion is suspended: the frame is ignored
  };
  Status status{Status::fused};
  std::string why;  ///< reason when lost
  Pose T_world_camera{Pose::Identity()};
  IcpResult icp;  ///< set when ICP ran
  FusionStats fusion;
  double raycast_ms{0.0};
  double track_ms{0.0};
  double integrate_ms{0.0};
};

/// Finds the pose of a frame by ICP against the map as seen from `T_world_start`. Fuses nothing. A lost track is a
/// result. Errors: size_mismatch, and those of raycast.
[[nodiscard]] Result<FrameReport> track_frame(const TsdfSnapshot& map, const Frame& frame, const PinholeCamera& camera,
                                              const Pose& T_world_start, const Executor& executor,
                                              const IcpConfig& icp = {});

/// KinectFusion's loop (thesis §2.2.1): ray cast, convert, track, integrate. One frame at a time, one thread calling;
/// snapshots of map() may be taken from other threads.
class Reconstruction {
 public:
  [[nodiscard]] static Result<Reconstruction> create(const ReconstructionConfig& config);
  /// Continues with an existing map, for example a loaded one, and its configuration.
  [[nodiscard]] static Result<Reconstruction> resume(TsdfSnapshot content, const IcpConfig& icp);

  /// Tracks and fuses one frame.
  /// @param hint T_world_camera; needed for modes hint and forced. In mode icp, the pose of the first frame (identity
  ///        without one); afterwards unused.
  /// @return the result; a lost track is not an error. Errors: size_mismatch, invalid_argument (no hint where one is
  /// needed, a bad camera or pose).
  [[nodiscard]] Result<FrameReport> process(const Frame& frame, const PinholeCamera& camera, TrackingMode mode,
                                            const std::optional<Pose>& hint, const Executor& executor);

  /// Ignores frames until resume(). The map persists.
  void suspend() { suspended_ = true; }
  /// Resumes near this pose: ICP starts there for the next frame, however far the camera moved meanwhile.
  void resume(const Pose& T_world_camera_hint);
  [[nodiscard]] bool suspended() const { return suspended_; }

  [[nodiscard]] TsdfMap& map() { return map_; }
  [[nodiscard]] const TsdfMap& map() const { return map_; }
  /// Returns the pose of the last fused frame.
  [[nodiscard]] const std::optional<Pose>& last_pose() const { return T_world_last_; }

 private:
  Reconstruction(TsdfMap map, const IcpConfig& icp) : map_{std::move(map)}, icp_{icp} {}

  TsdfMap map_;
  IcpConfig icp_;
  bool suspended_{false};
  std::optional<Pose> T_world_last_;
  std::optional<Pose> T_world_resume_;
};

}  // namespace saccade
