// SPDX-License-Identifier: Apache-2.0
#include "fuse_loops.hpp"

#include <algorithm>

#include "fuse_measures.hpp"
#include "interrupt.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/loops/background_loops.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

std::vector<TrackedFrame> tracked_frames(const FuseRecord& record) {
  std::vector<TrackedFrame> frames;
  for (const FusedFrame& frame : record.fused) frames.push_back({frame.index, frame.T_world_camera});
  return frames;
}

double farthest_move_m(const std::vector<Pose>& T_world_camera, const FuseRecord& record) {
  double farthest_m{0.0};
  for (std::size_t i = 0; i < record.fused.size(); ++i) {
    const Eigen::Vector3d moved = T_world_camera.at(i).translation() - record.fused[i].T_world_camera.translation();
    farthest_m = std::max(farthest_m, moved.norm());
  }
  return farthest_m;
}

void take_poses(const std::vector<Pose>& T_world_camera, FuseRecord& record) {
  for (std::size_t i = 0; i < record.fused.size(); ++i) record.fused[i].T_world_camera = T_world_camera.at(i);
}

/// The filling that process_frames would choose by the first frame that it can read and that has depths.
GapFilling chosen_gaps(const RgbdFolderSource& source) {
  for (std::size_t i = 0; i < source.size().value_or(0); ++i) {
    const auto frame = source.at(i);
    if (frame && has_depth(frame->depth)) return choose_gap_filling(frame->depth);
  }
  return {};
}

}  // namespace

Status check_closing(LoopMode mode, TrackingMode tracking) {
  if (mode == LoopMode::off) return {};
  if (pose_graph_solver().empty()) {
    return Error{Errc::unavailable, "this build closes no loops: it lacks libceres-dev", "--loops"};
  }
  if (needs_pose(tracking)) {
    return Error{Errc::invalid_argument, "loops are closed among tracked poses: add --tracking icp or rgbd", "--loops"};
  }
  return {};
}

ReadFrame frames_again(const RgbdFolderSource& source, const RgbdFolderConfig& config, const GapFilling& gaps) {
  return [&source, config, gaps](std::size_t index) -> Result<Frame> {
    SACCADE_TRY(Frame frame, read_frame_again(source, config, index));
    frame.depth = fill_gaps(frame.depth, gaps);
    return frame;
  };
}

Result<LoopReport> fuse_frames_with_loops(RgbdFolderSource& source, const RgbdFolderSource& again,
                                          const RgbdFolderConfig& config, Reconstruction& reconstruction,
                                          TrackingMode mode, const std::optional<GapFilling>& gaps,
                                          const Executor& executor, ProgressBar& progress, FuseRecord& record) {
  const GapFilling filling = gaps ? *gaps : chosen_gaps(again);
  const TsdfConfig map = reconstruction.map().config();
  const ReadFrame read = frames_again(again, config, filling);
  SACCADE_TRY(LoopCloser closer, LoopCloser::create(source.camera(), map, read));
  BackgroundLoops loops{std::move(closer), map, source.camera(), read};
  LoopReport report{.mode = LoopMode::online};
  double delay_ms_max{0.0};
  record = process_frames(source, "fusing", filling, progress, [&](Frame& frame) -> Result<FrameReport> {
    Stopwatch stopwatch;
    loops.correct(reconstruction);
    double delay_ms = stopwatch.elapsed_ms();
    auto done = reconstruction.process(frame, source.camera(), mode, frame.T_world_camera, executor);
    if (done && done->status == FrameReport::Status::fused) {
      stopwatch = Stopwatch{};
      Frame taken;
      taken.index = frame.index;
      taken.depth = std::move(frame.depth);
      taken.color = std::move(frame.color);
      loops.fused(done->T_world_camera, std::move(taken));
      delay_ms += stopwatch.elapsed_ms();
    }
    delay_ms_max = std::max(delay_ms_max, delay_ms);
    return done;
  });
  progress.update("closing loops", 0, 0);
  Status finished;
  if (interrupted()) {
    loops.give_up();
  } else {
    finished = loops.finish();
  }
  report.counts = loops.counts();
  report.exchanges = loops.exchanges();
  report.delay_ms_max = delay_ms_max;
  if (finished && report.counts.closed + report.exchanges > 0 && !interrupted()) {
    report.T_world_corrected = loops.poses();
    report.moved_max_m = farthest_move_m(report.T_world_corrected, record);
  }
  take_poses(loops.poses_in_map(), record);
  if (!finished && !record.failure) record.failure = finished.error();
  return report;
}

Result<LoopReport> close_loops(const RgbdFolderSource& source, const RgbdFolderConfig& config, const TsdfConfig& map,
                               const Executor& executor, ProgressBar& progress, const FuseRecord& record) {
  SACCADE_TRY(LoopCloser closer, LoopCloser::create(source.camera(), map, frames_again(source, config, record.gaps)));
  LoopReport report{.mode = LoopMode::end};
  for (const TrackedFrame& frame : tracked_frames(record)) {
    if (interrupted()) break;
    progress.update("looking for loops", closer.frames(), record.fused.size());
    SACCADE_CHECK(closer.add(frame, executor));
  }
  if (interrupted()) return report;
  SACCADE_CHECK(closer.finish(executor));
  report.counts = closer.counts();
  if (report.counts.closed > 0) {
    report.T_world_corrected = closer.poses();
    report.moved_max_m = farthest_move_m(report.T_world_corrected, record);
  }
  return report;
}

void apply_poses(LoopReport& loops, FuseRecord& record) {
  take_poses(loops.T_world_corrected, record);
  loops.applied = true;
}

Status fuse_record_again(const RgbdFolderSource& source, const RgbdFolderConfig& config, LoopReport& loops,
                         FuseRecord& record, Reconstruction& reconstruction, const Executor& executor,
                         ProgressBar& progress) {
  SACCADE_TRY(TsdfMap map, TsdfMap::create(reconstruction.map().config()));
  const ReadFrame read = frames_again(source, config, record.gaps);
  std::vector<TrackedFrame> frames = tracked_frames(record);
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].T_world_camera = loops.T_world_corrected.at(i);
  for (std::size_t i = 0; i < frames.size() && !interrupted(); ++i) {
    progress.update("fusing along corrected poses", i, frames.size());
    SACCADE_CHECK(fuse_along(map, source.camera(), std::span{frames}.subspan(i, 1), read, executor));
  }
  if (interrupted()) return {};
  const TsdfMap before = reconstruction.exchange_map(std::move(map), frames.back().T_world_camera);
  apply_poses(loops, record);
  return {};
}

nlohmann::json loops_json(const LoopReport& report) {
  const LoopCounts& counts = report.counts;
  return {{"mode", kLoopModeNames.of(report.mode)},
          {"solver", pose_graph_solver()},
          {"keyframes", counts.keyframes},
          {"candidates", counts.candidates},
          {"rejected",
           {{"surface", counts.rejected_by_surface},
            {"odometry", counts.rejected_by_odometry},
            {"alone", counts.rejected_alone},
            {"graph", counts.dropped}}},
          {"closed", counts.closed},
          {"applied", report.applied},
          {"exchanges", report.exchanges},
          {"delay_ms_max", report.delay_ms_max ? nlohmann::json(*report.delay_ms_max) : nlohmann::json{}},
          {"moved_max_m", report.moved_max_m}};
}

std::string loops_text(const LoopReport& report) {
  const LoopCounts& counts = report.counts;
  std::string text = std::to_string(counts.closed) + " closures of " + std::to_string(counts.candidates) +
                     " candidates among " + std::to_string(counts.keyframes) + " keyframes";
  if (report.applied) text += "; poses moved by up to " + millimetres(report.moved_max_m);
  if (!report.applied && counts.closed > 0) text += "; interrupted before the poses were corrected";
  if (report.delay_ms_max) {
    text += "; " + std::to_string(report.exchanges) + " maps exchanged on the way, a frame delayed by " +
            fixed(*report.delay_ms_max, 1) + " ms at most";
  }
  return text;
}

}  // namespace saccade::cli
