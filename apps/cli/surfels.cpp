// SPDX-License-Identifier: Apache-2.0
// saccade surfels: RGB-D frames → surfel cloud, with or without the mode filter.
#include <algorithm>
#include <sstream>

#include "context.hpp"
#include "fuse_frames.hpp"
#include "fuse_loops.hpp"
#include "fuse_options.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/clouds/surfel_cloud.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/surfel_picture.hpp"
#include "saccade/tracking/surfel_surface.hpp"
#include "summary.hpp"
#include "surfels_options.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// Milliseconds of each frame.
struct SurfelTimes {
  std::vector<double> associate, exposure, guided_filter, integrate, total;
};

/// Surfels of frames along known poses, with what was counted and timed.
struct FusedSurfels {
  SurfelFusion fusion;
  ModeFilter filter;
  ExposureCompensation exposure;
  std::vector<ExposureReport> exposures{};  ///< one for each frame with colour
  SurfelTimes times{};
  std::size_t without_color{0};
  std::size_t evicted_modes{0};
};

/// Everything between the command line and the summary.
struct SurfelsRun {
  const SurfelsOptions& options;
  const Executor& executor;
  ProgressBar& progress;
  OpenFrames frames;
  FusedSurfels made;
  FuseRecord record{};
  std::optional<LoopReport> loops{};
  std::size_t written{0};
  std::size_t uncolored{0};  ///< seen often enough, but by no frame with colour while others were

  [[nodiscard]] double min_weight() const { return options.min_weight(record.fused.size()); }
};

Result<FusedSurfels> no_surfels(const SurfelsOptions& options) {
  SACCADE_TRY(SurfelFusion fusion, SurfelFusion::create(options.fusion));
  SACCADE_TRY(ModeFilter filter, ModeFilter::create(options.filter));
  SACCADE_TRY(ExposureCompensation exposure, ExposureCompensation::create());
  return FusedSurfels{std::move(fusion), std::move(filter), std::move(exposure)};
}

/// Fuses a frame whose pose is known.
Status add_frame(const SurfelsRun& run, Frame& frame, FusedSurfels& made) {
  const PinholeCamera& camera = run.frames.source->camera();
  SACCADE_TRY(const SurfelFusionReport fused, run.options.exposure_compensation
                                                  ? made.fusion.add_frame(frame, camera, made.exposure, run.executor)
                                                  : made.fusion.add_frame(frame, camera, run.executor));
  if (fused.exposure) made.exposures.push_back(*fused.exposure);
  ModeFilterReport filtered;
  if (run.options.filtered()) {
    SACCADE_TRY(filtered, made.filter.add_frame(frame, made.fusion.association(), run.executor));
  }
  if (!fused.has_color) ++made.without_color;
  made.evicted_modes += filtered.evicted_modes;
  const double associate_ms = fused.points_ms + fused.index_ms + fused.associate_ms;
  const double integrate_ms = fused.integrate_ms + filtered.integrate_ms + filtered.move_ms;
  made.times.associate.push_back(associate_ms);
  made.times.exposure.push_back(fused.exposure_ms);
  made.times.guided_filter.push_back(filtered.guided_filter_ms);
  made.times.integrate.push_back(integrate_ms);
  made.times.total.push_back(associate_ms + fused.exposure_ms + filtered.guided_filter_ms + integrate_ms);
  return {};
}

/// Tracks a frame against the surfels; the first defines the world.
Result<FrameReport> track_surfels(SurfelsRun& run, RgbdTracker& tracker, const Frame& frame) {
  FrameReport report;
  if (run.made.fusion.map().size() == 0) {
    report.T_world_camera = frame.T_world_camera.value_or(Pose::Identity());
    return report;
  }
  const PinholeCamera& camera = run.frames.source->camera();
  return tracker.track(surface_of_surfels(run.made.fusion.map(), camera, run.executor), frame, camera, run.executor);
}

/// With poses that are given nothing is tracked; else the surfels or a TSDF map of the same frames say where the camera
/// is.
Status fuse_surfels(SurfelsRun& run) {
  SACCADE_TRY(Reconstruction reconstruction, Reconstruction::create({recorded_map(), IcpConfig{}}));
  RgbdTracker tracker;
  const bool by_surfels =
      run.frames.tracking == TrackingMode::rgbd && run.options.track_against == TrackedSurface::surfels;
  const auto process = [&](Frame& frame) -> Result<FrameReport> {
    FrameReport report;
    if (by_surfels) {
      SACCADE_TRY(report, track_surfels(run, tracker, frame));
      if (report.status != FrameReport::Status::fused) return report;
      frame.T_world_camera = report.T_world_camera;
      tracker.fused(frame, run.frames.source->camera(), report.T_world_camera, run.executor);
    } else if (run.frames.tracking != TrackingMode::forced) {
      SACCADE_TRY(report, reconstruction.process(frame, run.frames.source->camera(), run.frames.tracking,
                                                 frame.T_world_camera, run.executor));
      if (report.status != FrameReport::Status::fused) return report;
      frame.T_world_camera = report.T_world_camera;
    }
    SACCADE_CHECK(add_frame(run, frame, run.made));
    report.T_world_camera = *frame.T_world_camera;
    return report;
  };
  std::optional<GapFilling> gaps;
  if (run.options.fill_gaps_px) gaps = GapFilling{*run.options.fill_gaps_px};
  run.record = process_frames(*run.frames.source, "fusing surfels", gaps, run.progress, process);
  return {};
}

/// Closes the loops of the tracked poses. Where that moves any, fuses all surfels again along the new ones. Interrupted
/// or failed, it leaves surfels and poses as they were.
Status close_surfel_loops(SurfelsRun& run) {
  const RgbdFolderSource& source = *run.frames.source;
  SACCADE_TRY(run.loops,
              close_loops(source, run.frames.folder, recorded_map(), run.executor, run.progress, run.record));
  if (run.loops->T_world_corrected.empty()) return {};
  SACCADE_TRY(FusedSurfels again, no_surfels(run.options));
  const ReadFrame read = frames_again(source, run.frames.folder, run.record.gaps);
  for (std::size_t i = 0; i < run.record.fused.size(); ++i) {
    if (interrupted()) return {};
    run.progress.update("fusing surfels along corrected poses", i, run.record.fused.size());
    SACCADE_TRY(Frame frame, read(run.record.fused[i].index));
    frame.T_world_camera = run.loops->T_world_corrected.at(i);
    SACCADE_CHECK(add_frame(run, frame, again));
  }
  run.made = std::move(again);
  apply_poses(*run.loops, run.record);
  return {};
}

/// Before the work, of the folder; after it, of the frames that were used.
Status check_color(const SurfelsRun& run) {
  const bool has_color = run.frames.source->info().has_color &&
                         (run.record.fused.empty() || run.made.without_color < run.record.fused.size());
  if (!run.options.filtered() || has_color) return {};
  return Error{Errc::not_found, "no frame has a colour image, which the mode filter needs; use --mode-filter off",
               run.options.frames.string()};
}

/// Averages and winners, whichever there are, as the frame in the middle saw them.
Status write_picture(const SurfelsRun& run, std::span<const SurfelMode> winners) {
  const Viewpoint view{run.frames.source->camera(), run.record.fused[run.record.fused.size() / 2].T_world_camera};
  Sheet sheet;
  const auto add = [&](const char* title, std::span<const SurfelMode> modes) {
    const SurfelPoints points = surfel_points(run.made.fusion.map(), modes, run.min_weight());
    sheet.panels.push_back({draw_surfels(points, view, run.executor), title, {}, {}, {}});
  };
  if (run.options.mode_filter != ModeFilterUse::on) add("averages", {});
  if (run.options.filtered()) add("mode filter", winners);
  return write_png(run.options.picture, compose(sheet));
}

/// Nothing where no surfel was seen often enough.
Status write_clouds(SurfelsRun& run) {
  run.progress.update("writing", 0, 0);
  const SurfelMap& map = run.made.fusion.map();
  const double least = run.min_weight();
  const auto seen = std::count_if(map.discs.begin(), map.discs.end(),
                                  [&](const SurfelDisc& disc) { return double(disc.weight) >= least; });
  run.written = shown_surfels(map, least).size();
  run.uncolored = static_cast<std::size_t>(seen) - run.written;
  if (run.written == 0) return {};
  std::vector<SurfelMode> winners;
  if (run.options.filtered()) {
    winners = run.made.filter.winners(run.executor);
    if (!run.options.places_of_modes()) put_at_averages(winners, map);
    SACCADE_CHECK(write_surfel_cloud(run.options.out, map, winners, least));
  }
  const std::filesystem::path average = run.options.average_out();
  if (!average.empty()) SACCADE_CHECK(write_surfel_cloud(average, map, {}, least));
  return run.options.picture.empty() ? Status{} : write_picture(run, winners);
}

Outcome nothing_written(const SurfelsRun& run) {
  float most{0.0F};
  for (const SurfelDisc& disc : run.made.fusion.map().discs) most = std::max(most, disc.weight);
  return Outcome{.empty = "no surfel has a confidence of " + fixed(run.min_weight(), 1) + ", the greatest is " +
                          fixed(double(most), 1) + ": see --min-confidence; nothing was written"};
}

/// Says where the surfels along the tracked poses are.
Error loops_failed(const SurfelsRun& run, Error failure) {
  if (run.written == 0) return failure;
  failure.message += "; the surfels of the " + std::to_string(run.record.fused.size()) +
                     " frames along their tracked poses are " + run.options.out.string();
  return failure;
}

/// Gains relative to the first frame; null without compensation.
json exposure_json(const SurfelsRun& run) {
  if (!run.options.exposure_compensation) return nullptr;
  const auto [least, most] =
      std::minmax_element(run.made.exposures.begin(), run.made.exposures.end(),
                          [](const ExposureReport& a, const ExposureReport& b) { return a.gain < b.gain; });
  const auto untold = std::count_if(run.made.exposures.begin(), run.made.exposures.end(),
                                    [](const ExposureReport& report) { return !report.estimated; });
  return {{"min", run.made.exposures.empty() ? 1.0 : least->gain},
          {"max", run.made.exposures.empty() ? 1.0 : most->gain},
          {"frames", run.made.exposures.size()},
          {"not_estimated", untold}};
}

/// Surface that the frames were aligned to; null where none was.
json tracked_surface_json(const SurfelsRun& run) {
  if (run.frames.tracking == TrackingMode::forced) return nullptr;
  const bool rgbd = run.frames.tracking == TrackingMode::rgbd;
  return kTrackedSurfaceNames.of(rgbd ? run.options.track_against : TrackedSurface::map);
}

json result_json(const SurfelsRun& run) {
  const auto median_json = [](const std::vector<double>& ms) -> json { return {{"median", median(ms)}}; };
  const std::filesystem::path average = run.options.average_out();
  const SurfelPlaces places = run.options.places_of_modes() ? SurfelPlaces::modes : SurfelPlaces::average;
  return {{"folder", run.options.frames.string()},
          {"out", run.options.out.string()},
          {"average_out", average.empty() ? json(nullptr) : json(average.string())},
          {"mode_filter", kModeFilterUseNames.of(run.options.mode_filter)},
          {"tracking", to_string(run.frames.tracking)},
          {"track_against", tracked_surface_json(run)},
          {"confidence", confidence_json(run.record)},
          {"loops", run.loops ? loops_json(*run.loops) : json{}},
          {"interrupted", interrupted()},
          {"frames", run.record.fused.size()},
          {"frames_without_color", run.made.without_color},
          {"lost_frames", left_out_json(run.record.lost)},
          {"skipped", left_out_json(run.record.skipped)},
          {"surfels", run.made.fusion.map().size()},
          {"written", run.written},
          {"uncolored", run.uncolored},
          {"min_confidence", run.min_weight()},
          {"picture", run.options.picture.empty() ? json(nullptr) : json(run.options.picture.string())},
          {"evicted_modes", run.made.evicted_modes},
          {"bytes_per_surfel",
           {{"map", double(run.made.fusion.map().memory_bytes()) / double(run.made.fusion.map().size())},
            {"modes", double(run.made.filter.memory_bytes()) / double(run.made.fusion.map().size())}}},
          {"image_sigma", run.options.fusion.image_sigma},
          {"choice", run.options.filtered() ? json(kModeChoiceNames.of(run.options.choice)) : json(nullptr)},
          {"places", kSurfelPlacesNames.of(places)},
          {"as_printed", run.options.as_printed},
          {"exposure", exposure_json(run)},
          {"ms_per_frame",
           {{"associate", median_json(run.made.times.associate)},
            {"exposure", median_json(run.made.times.exposure)},
            {"guided_filter", median_json(run.made.times.guided_filter)},
            {"integrate", median_json(run.made.times.integrate)},
            {"total", median_json(run.made.times.total)}}},
          {"peak_rss_bytes", peak_rss_bytes()}};
}

std::string surfels_text(const SurfelsRun& run) {
  std::ostringstream text;
  const FuseRecord& record = run.record;
  const Summary summary{text};
  summary.line("frames", std::to_string(record.fused.size()) + " fused, " + std::to_string(record.lost.size()) +
                             " lost, " + std::to_string(record.skipped.size()) + " skipped");
  summary.line("tracking", to_string(run.frames.tracking));
  if (run.loops) summary.line("loops", loops_text(*run.loops));
  summary.line("surfels", std::to_string(run.made.fusion.map().size()) + ", of which " + std::to_string(run.written) +
                              " have a confidence of at least " + fixed(run.min_weight(), 1) + " and are written");
  if (run.uncolored > 0) {
    summary.line("left out", std::to_string(run.uncolored) + " surfels that no frame with colour saw");
  }
  summary.line("per frame", fixed(median(run.made.times.associate), 1) + " ms associate, " +
                                fixed(median(run.made.times.guided_filter), 1) + " ms guided filter, " +
                                fixed(median(run.made.times.integrate), 1) + " ms integrate (medians)");
  if (!run.made.exposures.empty()) {
    const json exposure = exposure_json(run);
    summary.line("exposure", "gains of " + fixed(exposure["min"].get<double>(), 2) + " to " +
                                 fixed(exposure["max"].get<double>(), 2) + " of the first frame's");
  }
  summary.line("cloud", run.options.out.string());
  if (run.options.mode_filter == ModeFilterUse::both) summary.line("average", run.options.average_out().string());
  if (!run.options.picture.empty()) summary.line("picture", run.options.picture.string());
  return text.str();
}

/// Fails early where a file that is to be written is one that is read or written besides.
Status check_outputs(const SurfelsOptions& options, const GlobalOptions& global) {
  const std::filesystem::path json_file = global.json_to_stdout() ? "" : global.json;
  SACCADE_CHECK(check_output(options.out, "--json", {json_file}));
  if (options.mode_filter == ModeFilterUse::both)
    SACCADE_CHECK(check_output(options.average_out(), "--json", {json_file}));
  if (!options.picture.empty()) SACCADE_CHECK(check_output(options.picture, "--picture", {options.out, json_file}));
  return check_beside_frames(options, options.picture, "--picture");
}

class Surfels final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"surfels", "fuses RGB-D frames into a cloud of surfels whose edges stay sharp"};
  }
  void declare(Options& options) override {
    command_ = &options.group();
    add_surfels_options(options.group(), surfels_);
  }
  void check(const GlobalOptions& /*global*/) override { check_surfels_options(*command_, surfels_); }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_TRY(OpenFrames frames, open_frames(surfels_));
    SACCADE_TRY(FusedSurfels none, no_surfels(surfels_));
    SurfelsRun run{surfels_, context.executor(), context.bar(), std::move(frames), std::move(none)};
    SACCADE_CHECK(check_color(run));
    SACCADE_CHECK(check_closing(surfels_.loops, run.frames.tracking));
    SACCADE_CHECK(check_outputs(surfels_, context.global()));
    context.lap("open");
    SACCADE_CHECK(fuse_surfels(run));
    context.lap("frames");
    if (run.made.fusion.map().size() == 0) return nothing_fused(run.record, surfels_.frames);
    Status closed;
    if (surfels_.loops == LoopMode::end && !interrupted()) {
      closed = close_surfel_loops(run);
      context.lap("loops");
    }
    SACCADE_CHECK(check_color(run));
    SACCADE_CHECK(write_clouds(run));
    if (!closed) return loops_failed(run, closed.error());
    if (run.written == 0) return nothing_written(run);
    context.lap("write");
    Outcome outcome{.result = result_json(run), .text = surfels_text(run)};
    if (run.frames.tracking == TrackingMode::rgbd) note_missing_colors(run.record, outcome);
    warn_of_left_out(run.record, outcome);
    warn_of_damage(surfels_.frames, run.frames.source->info(), outcome);
    if (interrupted()) {
      outcome.cut_short = "interrupted after " + std::to_string(run.made.times.total.size()) +
                          " frames; what they gave is in " + surfels_.out.string();
    }
    return outcome;
  }

 private:
  const CLI::App* command_{nullptr};
  SurfelsOptions surfels_;
};

}  // namespace

void add_surfels(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Surfels>(program, global, action);
}

}  // namespace saccade::cli
