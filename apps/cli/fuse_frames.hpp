// SPDX-License-Identifier: Apache-2.0
#pragma once
// fuse_frames: all frames of a source through a Reconstruction, and what became of each; FuseRecord.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "progress_bar.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/map/reconstruction.hpp"
#include "saccade/sensor/gap_filling.hpp"

namespace saccade::cli {

struct FusedFrame {
  std::size_t index{0};  ///< in the source
  std::string name;
  std::optional<double> time_s;
  Pose T_world_camera{Pose::Identity()};  ///< the pose that was used
  std::optional<Pose> T_world_true;       ///< the pose that the source knows
};

/// A frame that is not in the map.
struct LeftOutFrame {
  std::string name;
  std::string reason;
};

struct FuseRecord {
  std::vector<FusedFrame> fused;
  std::vector<LeftOutFrame> skipped;  ///< missing, corrupt, or without a good pose
  std::vector<LeftOutFrame> lost;     ///< not found by tracking
  std::vector<double> raycast_ms;     ///< of the fused frames that were tracked
  std::vector<double> track_ms;
  std::vector<double> integrate_ms;  ///< of all fused frames
  GapFilling gaps;                   ///< what was filled
};

/// Gaps are filled in what is tracked and fused; without `gaps`, the first frame decides. Until the source ends or the
/// program is interrupted.
[[nodiscard]] FuseRecord fuse_frames(CameraSource& source, Reconstruction& reconstruction, TrackingMode mode,
                                     const std::optional<GapFilling>& gaps, const Executor& executor,
                                     ProgressBar& progress);

}  // namespace saccade::cli
