// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reconstruction: depth frames in, tracked and fused, a map that persists; suspended and resumed on demand.

#include <optional>
#include <string>

#include "saccade/core/names.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/tracking/icp.hpp"

namespace saccade {

/// Where a frame's pose comes from. Thesis §2.3.1, Listing 2.1.
enum class TrackingMode {
  icp,     ///< ICP started at the last pose (HINT_TYPE_NONE)
  hint,    ///< ICP started at the given pose (HINT_TYPE_HINT)
  forced,  ///< the given pose is taken as it is (HINT_TYPE_FORCED)
};
inline constexpr auto kTrackingModeNames = make_names<TrackingMode>(
    {{TrackingMode::icp, "icp"}, {TrackingMode::hint, "hint"}, {TrackingMode::forced, "forced"}});
[[nodiscard]] constexpr std::string_view to_string(TrackingMode mode) { return kTrackingModeNames.of(mode); }

struct ReconstructionConfig {
  TsdfConfig map;
  IcpConfig icp;
};

/// What became of one frame.
struct FrameReport {
  enum class Status {
    fused,
    lost,       ///< the pose could not be found: the map is untouched and the last good pose is kept
    suspended,  ///< fusion is suspended: nothing was done
  };
  Status status{Status::fused};
  std::string why;  ///< when lost
  Pose T_world_camera{Pose::Identity()};
  IcpResult icp;  ///< when ICP ran
  FusionStats fusion;
  double raycast_ms{0.0};
  double track_ms{0.0};
  double integrate_ms{0.0};
};

/// Finds the pose of a frame by ICP against what a map shows from `T_world_start`; nothing is fused. A lost track is a
/// result. Errors: size_mismatch, and those of raycast.
[[nodiscard]] Result<FrameReport> track_frame(const TsdfSnapshot& map, const Frame& frame, const PinholeCamera& camera,
                                              const Pose& T_world_start, const Executor& executor,
                                              const IcpConfig& icp = {});

/// KinectFusion's loop (thesis §2.2.1): ray cast, convert, track, integrate. One frame at a time, one thread calling;
/// snapshots of map() may be taken from other threads.
class Reconstruction {
 public:
  [[nodiscard]] static Result<Reconstruction> create(const ReconstructionConfig& config);
  /// Goes on with an existing map, for example a loaded one; its configuration stays.
  [[nodiscard]] static Result<Reconstruction> resume(TsdfSnapshot content, const IcpConfig& icp);

  /// Tracks and fuses one frame.
  /// @param hint T_world_camera; needed for modes hint and forced. In mode icp, the pose of the first frame (identity
  ///        without one); afterwards unused.
  /// @return what happened: a lost track is a result. Errors: size_mismatch, invalid_argument (no hint where one is
  ///         needed, a bad camera or pose).
  [[nodiscard]] Result<FrameReport> process(const Frame& frame, const PinholeCamera& camera, TrackingMode mode,
                                            const std::optional<Pose>& hint, const Executor& executor);

  /// Frames are ignored until resume(). The map persists.
  void suspend() { suspended_ = true; }
  /// The next frame is taken near this pose: ICP starts there, however far the camera moved meanwhile.
  void resume(const Pose& T_world_camera_hint);
  [[nodiscard]] bool suspended() const { return suspended_; }

  [[nodiscard]] TsdfMap& map() { return map_; }
  [[nodiscard]] const TsdfMap& map() const { return map_; }
  /// Pose of the last fused frame.
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
