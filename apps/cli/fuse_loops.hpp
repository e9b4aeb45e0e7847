// SPDX-License-Identifier: Apache-2.0
#pragma once
// Loops of `saccade fuse` and `saccade surfels`: closed after the run, or beside it; frames fused again along the
// corrected poses.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "fuse_frames.hpp"
#include "loop_mode.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/loops/loop_closer.hpp"
#include "saccade/sensor/gap_filling.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade::cli {

/// Fails where loops cannot be closed: without a solver, and among poses that are given, which stay as they are.
[[nodiscard]] Status check_closing(LoopMode mode, TrackingMode tracking);

struct LoopReport {
  LoopMode mode{LoopMode::off};
  LoopCounts counts{};
  std::size_t exchanges{0};               ///< maps exchanged during the run
  std::optional<double> delay_ms_max{};   ///< longest time that one frame waited for the closing of loops; online only
  std::vector<Pose> T_world_corrected{};  ///< pose of each frame; none where nothing is to be corrected
  bool applied{false};                    ///< the record's poses, and what was fused, are the corrected ones
  double moved_max_m{0.0};                ///< farthest that the pose of a frame was moved
};

/// Frames that are read again, as they were fused.
[[nodiscard]] ReadFrame frames_again(const RgbdFolderSource& source, const RgbdFolderConfig& config,
                                     const GapFilling& gaps);

/// As fuse_frames, with loops closed beside it. `again` is a second source of the same frames. The record has the poses
/// at which the frames are in the map. An interruption gives up what is not closed yet.
[[nodiscard]] Result<LoopReport> fuse_frames_with_loops(RgbdFolderSource& source, const RgbdFolderSource& again,
                                                        const RgbdFolderConfig& config, Reconstruction& reconstruction,
                                                        TrackingMode mode, const std::optional<GapFilling>& gaps,
                                                        const Executor& executor, ProgressBar& progress,
                                                        FuseRecord& record);

/// Closes the loops of a finished run. The record stays as it is until the corrected poses are applied.
[[nodiscard]] Result<LoopReport> close_loops(const RgbdFolderSource& source, const RgbdFolderConfig& config,
                                             const TsdfConfig& map, const Executor& executor, ProgressBar& progress,
                                             const FuseRecord& record);

/// Gives the record the corrected poses, once all of its frames are fused along them.
void apply_poses(LoopReport& loops, FuseRecord& record);

/// Fuses the record's frames again along the corrected poses, in place of the map so far, and applies them. Interrupted
/// or failed, it leaves map and poses as they were.
[[nodiscard]] Status fuse_record_again(const RgbdFolderSource& source, const RgbdFolderConfig& config,
                                       LoopReport& loops, FuseRecord& record, Reconstruction& reconstruction,
                                       const Executor& executor, ProgressBar& progress);

[[nodiscard]] nlohmann::json loops_json(const LoopReport& report);
[[nodiscard]] std::string loops_text(const LoopReport& report);

}  // namespace saccade::cli
