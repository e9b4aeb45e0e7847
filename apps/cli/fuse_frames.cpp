// SPDX-License-Identifier: Apache-2.0
#include "fuse_frames.hpp"

#include <algorithm>

#include "interrupt.hpp"
#include "saccade/core/statistics.hpp"

namespace saccade::cli {
namespace {

/// Sources name the frame first: "frame NAME, file".
LeftOutFrame left_out(const Error& error) {
  constexpr std::string_view kPrefix{"frame "};
  std::string_view context{error.context};
  if (!context.starts_with(kPrefix)) return {error.context, error.message};
  context.remove_prefix(kPrefix.size());
  const std::size_t comma = context.find(", ");
  std::string reason = error.message;
  if (comma != std::string_view::npos) reason = std::string{context.substr(comma + 2)} + ": " + reason;
  return {std::string{context.substr(0, comma)}, reason};
}

void record_report(const Frame& frame, const std::optional<Pose>& T_world_true, const FrameReport& report,
                   FuseRecord& record, ProgressBar& progress) {
  if (report.status == FrameReport::Status::lost) {
    progress.note(frame.name + ": lost: " + report.why);
    record.lost.push_back({frame.name, report.why});
    return;
  }
  if (report.relocalised) progress.note(frame.name + ": found again, from an earlier view");
  record.fused.push_back({frame.index, frame.name, frame.time_s, report.T_world_camera, T_world_true, report.confidence,
                          report.relocalised});
  record.integrate_ms.push_back(report.integrate_ms);
  if (report.track_ms > 0.0) {
    record.raycast_ms.push_back(report.raycast_ms);
    record.track_ms.push_back(report.track_ms);
  }
}

}  // namespace

bool has_depth(const DepthImage& depth) {
  return std::any_of(depth.data(), depth.data() + depth.size(), [](float z) { return z > 0.0F; });
}

FuseRecord process_frames(CameraSource& source, std::string_view stage, const std::optional<GapFilling>& gaps,
                          ProgressBar& progress, const FrameProcess& process) {
  FuseRecord record;
  const auto skip = [&](const Error& error) {
    record.skipped.push_back(left_out(error));
    progress.note(record.skipped.back().name + ": skipped: " + record.skipped.back().reason);
  };
  std::optional<GapFilling> chosen = gaps;
  for (std::size_t done = 0; !interrupted(); ++done) {
    progress.update(stage, done, source.size().value_or(0));
    auto next = source.next();
    if (!next) {
      skip(next.error());
      continue;
    }
    if (!*next) break;
    Frame& frame = **next;
    if (!chosen && has_depth(frame.depth)) {
      chosen = choose_gap_filling(frame.depth);
      if (chosen->max_gap_px > 0)
        progress.note("the depth images have holes throughout: gaps of up to 2 pixels are filled");
    }
    record.gaps = chosen.value_or(GapFilling{});
    frame.depth = fill_gaps(frame.depth, record.gaps);
    if (!frame.color) ++record.without_color;
    const std::optional<Pose> T_world_true = frame.T_world_camera;
    const auto report = process(frame);
    if (!report && (report.error().code == Errc::io_failure || report.error().code == Errc::corrupt_data)) {
      record.failure = report.error();
      break;
    }
    if (report) {
      record_report(frame, T_world_true, *report, record, progress);
    } else {
      skip(Error{report.error().code, report.error().message, "frame " + frame.name});
    }
  }
  return record;
}

FuseRecord fuse_frames(CameraSource& source, Reconstruction& reconstruction, TrackingMode mode,
                       const std::optional<GapFilling>& gaps, const std::optional<Pose>& T_world_last,
                       const Executor& executor, ProgressBar& progress) {
  bool resumed = reconstruction.map().content().grid.empty();
  return process_frames(source, "fusing", gaps, progress, [&](Frame& frame) {
    const std::optional<Pose>& start = frame.T_world_camera ? frame.T_world_camera : T_world_last;
    if (!resumed && start) reconstruction.resume(*start);  // a saved map is gone on with
    resumed = true;
    return reconstruction.process(frame, source.camera(), mode, frame.T_world_camera, executor);
  });
}

Result<Outcome> nothing_fused(const FuseRecord& record, const std::filesystem::path& frames) {
  if (interrupted()) return Error{Errc::cancelled, "interrupted", {}};
  if (!record.fused.empty()) {
    return Outcome{.empty =
                       "no depth is within the camera's range: see --min-range, --max-range and --depth-scale; "
                       "nothing was written"};
  }
  if (record.lost.empty()) {
    const LeftOutFrame& first = record.skipped.front();
    return Error{Errc::corrupt_data,
                 "not one of the " + std::to_string(record.skipped.size()) + " frames can be used; the first, " +
                     first.name + ": " + first.reason,
                 frames.string()};
  }
  return Outcome{.empty = "not one frame could be tracked; the first, " + record.lost.front().name + ": " +
                          record.lost.front().reason + "; nothing was written"};
}

void warn_of_left_out(const FuseRecord& record, Outcome& outcome) {
  const std::size_t left_out = record.lost.size() + record.skipped.size();
  if (left_out <= record.fused.size()) return;
  const LeftOutFrame& first = record.lost.empty() ? record.skipped.front() : record.lost.front();
  outcome.warnings.push_back(
      "warning: of " + std::to_string(record.fused.size() + left_out) + " frames only " +
      std::to_string(record.fused.size()) + " could be used, " + std::to_string(record.lost.size()) + " are lost and " +
      std::to_string(record.skipped.size()) + " skipped; the first, " + first.name + ": " + first.reason);
}

nlohmann::json confidence_json(const FuseRecord& record) {
  nlohmann::json frames = nlohmann::json::array();
  std::vector<double> all;
  for (const FusedFrame& frame : record.fused) {
    if (!frame.confidence) continue;
    all.push_back(*frame.confidence);
    frames.push_back({{"frame", frame.name}, {"confidence", *frame.confidence}, {"relocalised", frame.relocalised}});
  }
  if (all.empty()) return nullptr;
  return {{"median", median(all)}, {"least", *std::min_element(all.begin(), all.end())}, {"frames", frames}};
}

void note_missing_colors(const FuseRecord& record, Outcome& outcome) {
  if (record.without_color == 0) return;
  const std::size_t all = record.fused.size() + record.lost.size();
  outcome.warnings.push_back("note: " + std::to_string(record.without_color) + " of " + std::to_string(all) +
                             " frames have no colours and were tracked by their depths alone");
}

nlohmann::json left_out_json(const std::vector<LeftOutFrame>& frames) {
  nlohmann::json list = nlohmann::json::array();
  for (const LeftOutFrame& frame : frames) list.push_back({{"frame", frame.name}, {"reason", frame.reason}});
  return list;
}

}  // namespace saccade::cli
