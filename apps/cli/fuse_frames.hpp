// SPDX-License-Identifier: Apache-2.0
#pragma once
// process_frames: all frames of a source, with a result each; fuse_frames: through a Reconstruction; FuseRecord.

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "progress_bar.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/sensor/gap_filling.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade::cli {

struct FusedFrame {
  std::size_t index{0};  ///< in the source
  std::string name;
  std::optional<double> time_s;
  Pose T_world_camera{Pose::Identity()};  ///< the pose that was used
  std::optional<Pose> T_world_true;       ///< the pose that the source knows
  std::optional<double> confidence{};     ///< FrameReport::confidence, of a frame that was tracked
  bool relocalised{false};                ///< found again after a loss
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
  std::vector<double> raycast_ms;     ///< one for each fused frame that was tracked
  std::vector<double> track_ms;
  std::vector<double> integrate_ms;  ///< one for each fused frame
  std::size_t without_color{0};      ///< frames without a colour image
  GapFilling gaps;                   ///< what was filled
  std::optional<Error> failure;      ///< why no frame after these could be processed
};

/// What is done with a frame; it may set the frame's pose.
using FrameProcess = std::function<Result<FrameReport>(Frame&)>;

[[nodiscard]] bool has_depth(const DepthImage& depth);

/// Gaps are filled in what is processed; without `gaps`, the first frame with depths decides. Until the source ends,
/// the program is interrupted, or `process` answers io_failure or corrupt_data, which is not the frame's fault: a paged
/// map's store.
[[nodiscard]] FuseRecord process_frames(CameraSource& source, std::string_view stage,
                                        const std::optional<GapFilling>& gaps, ProgressBar& progress,
                                        const FrameProcess& process);

/// Gaps are filled in what is tracked and fused, as by process_frames. A map that is gone on with is tracked from the
/// first frame's pose or, where it has none, from T_world_last, the last pose of the map's own frames.
[[nodiscard]] FuseRecord fuse_frames(CameraSource& source, Reconstruction& reconstruction, TrackingMode mode,
                                     const std::optional<GapFilling>& gaps, const std::optional<Pose>& T_world_last,
                                     const Executor& executor, ProgressBar& progress);

/// Outcome of a run without a single fused frame, or with none that shows anything.
[[nodiscard]] Result<Outcome> nothing_fused(const FuseRecord& record, const std::filesystem::path& frames);

/// Adds a warning, which --quiet does not silence, that most frames are not in the result, and why.
void warn_of_left_out(const FuseRecord& record, Outcome& outcome);

/// Confidence of the frames that were tracked: {median, least, frames: [{frame, confidence, relocalised}, …]}; null
/// where none was.
[[nodiscard]] nlohmann::json confidence_json(const FuseRecord& record);
/// Adds a note where colours were asked for and frames had none.
void note_missing_colors(const FuseRecord& record, Outcome& outcome);

/// [{frame, reason}, …]
[[nodiscard]] nlohmann::json left_out_json(const std::vector<LeftOutFrame>& frames);

}  // namespace saccade::cli
