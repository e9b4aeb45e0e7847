// SPDX-License-Identifier: Apache-2.0
#pragma once
// FrameReport: result of tracking and fusing one frame. tracking_confidence.

#include <optional>
#include <string>

#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/tracking/rgbd_alignment.hpp"

namespace saccade {

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
  /// How far the frame is from being lost; unset where no pose was looked for. See tracking_confidence.
  std::optional<double> confidence;
  bool used_color{false};       ///< whether colours helped to find the pose
  double color_agreement{0.0};  ///< RgbdResult::color_agreement, where they did
  bool relocalised{false};      ///< the pose was found from a keyframe's, after the track was lost
  FusionStats fusion;
  double raycast_ms{0.0};
  double track_ms{0.0};
  double integrate_ms{0.0};
};

/// Returns the least of these, each from 0, at its limit for lost frames, to 1, where tracking is at its best:
/// agreement (up to 0.98), share of the pixels with partners (up to 0.8), and the logarithm of the constraint (up to
/// 100 times the limit). 0 for a frame that is lost.
[[nodiscard]] double tracking_confidence(const IcpResult& found, const IcpConfig& config);

}  // namespace saccade
