// SPDX-License-Identifier: Apache-2.0
#pragma once
// How good a run is: the residual of its frames against the final map, and its trajectory against the true one.

#include <filesystem>
#include <optional>
#include <vector>

#include "fuse_frames.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/tracking/trajectory_error.hpp"

namespace saccade::cli {

/// Reads one frame of the folder again, as the configuration says, whichever frames that selects.
[[nodiscard]] Result<Frame> read_frame_again(const RgbdFolderSource& source, const RgbdFolderConfig& config,
                                             std::size_t index);

struct MapFit {
  DepthResidual residual;
  std::size_t frames{0};
  std::vector<double> raycast_ms;
};

/// The final map against every 10th fused frame, or the next one that has depths, at the poses they were fused with
/// (docs/reference/metrics.md). nullopt when the program is interrupted meanwhile.
[[nodiscard]] Result<std::optional<MapFit>> measure_map(const TsdfSnapshot& map, const PinholeCamera& camera,
                                                        const RgbdFolderSource& source, const RgbdFolderConfig& config,
                                                        const FuseRecord& record, const Executor& executor,
                                                        ProgressBar& progress);

/// Over the fused frames whose true pose is known; nullopt where there is none.
[[nodiscard]] std::optional<TrajectoryError> measure_trajectory(const FuseRecord& record);

}  // namespace saccade::cli
