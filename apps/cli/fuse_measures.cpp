// SPDX-License-Identifier: Apache-2.0
#include "fuse_measures.hpp"

#include "interrupt.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/map/raycast.hpp"

namespace saccade::cli {

Result<Frame> read_frame_again(const RgbdFolderSource& source, const RgbdFolderConfig& config, std::size_t index) {
  return source.at((index - config.first) / config.every_nth);
}

Result<std::optional<MapFit>> measure_map(const TsdfSnapshot& map, const PinholeCamera& camera,
                                          const RgbdFolderSource& source, const RgbdFolderConfig& config,
                                          const FuseRecord& record, const Executor& executor, ProgressBar& progress) {
  constexpr std::size_t kEvery{10};
  MapFit fit;
  std::size_t next{0};
  for (std::size_t i = 0; i < record.fused.size(); ++i) {
    if (i < next) continue;
    if (interrupted()) return std::optional<MapFit>{};
    progress.update("comparing the map with its frames", i / kEvery, (record.fused.size() + kEvery - 1) / kEvery);
    SACCADE_TRY(const Frame frame, read_frame_again(source, config, record.fused[i].index));
    if (!has_depth(frame.depth)) continue;  // the next frame stands for it
    next = i - i % kEvery + kEvery;
    const Stopwatch stopwatch;
    SACCADE_TRY(const SurfaceView view, raycast(map, camera, record.fused[i].T_world_camera, executor));
    fit.raycast_ms.push_back(stopwatch.elapsed_ms());
    SACCADE_CHECK(fit.residual.add(frame.depth, view.depth));
    ++fit.frames;
  }
  return std::optional{std::move(fit)};
}

std::optional<TrajectoryError> measure_trajectory(const FuseRecord& record) {
  std::vector<Pose> used;
  std::vector<Pose> truth;
  for (const FusedFrame& frame : record.fused) {
    if (!frame.T_world_true) continue;
    used.push_back(frame.T_world_camera);
    truth.push_back(*frame.T_world_true);
  }
  const auto error = trajectory_error(used, truth);
  if (!error) return std::nullopt;
  return *error;
}

}  // namespace saccade::cli
