// SPDX-License-Identifier: Apache-2.0
// saccade fuse: RGB-D frames → map, mesh, trajectory, figures and pictures.
#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <memory>

#include "command.hpp"
#include "exit_status.hpp"
#include "fuse_frames.hpp"
#include "fuse_measures.hpp"
#include "fuse_options.hpp"
#include "fuse_pictures.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/mesh.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 8> kRunFiles{"run.json",        "map.sacmap",       "trajectory.txt",
                                                    "mesh.ply",        "fusion-first.png", "fusion-middle.png",
                                                    "fusion-last.png", "ternary.png"};
constexpr std::size_t kNamesAlwaysWritten{3};

/// Everything between the command line and the summary.
struct FuseRun {
  const FuseOptions& options;
  const GlobalOptions& global;
  Executor executor;
  ProgressBar progress;
  RgbdFolderConfig folder;
  TrackingMode tracking{TrackingMode::icp};
  PinholeCamera camera;
  RgbdFolderInfo info;
  FuseRecord record;
  std::optional<MapFit> fit;
  std::optional<TrajectoryError> trajectory;
  std::size_t triangles{0};
  TimingsMs timings_ms;
};

Result<std::unique_ptr<RgbdFolderSource>> open_frames(FuseRun& run) {
  SACCADE_TRY(OpenFrames frames, open_frames(run.options));
  run.folder = std::move(frames.folder);
  run.tracking = frames.tracking;
  run.camera = frames.source->camera();
  run.info = frames.source->info();
  return std::move(frames.source);
}

Result<Reconstruction> make_reconstruction(const FuseRun& run) {
  if (run.options.continue_map.empty()) return Reconstruction::create({run.options.map, IcpConfig{}});
  SACCADE_TRY(TsdfSnapshot map, load_map(run.options.continue_map, run.executor));
  if (run.options.map.workspace) map.config.workspace = run.options.map.workspace;
  return Reconstruction::resume(std::move(map), IcpConfig{});
}

json map_json(const TsdfSnapshot& map) {
  const TsdfGrid::Usage usage = map.grid.usage();
  return {{"bricks", usage.bricks()},
          {"bytes", usage.bytes},
          {"sectors", usage.sectors},
          {"constant_free_bricks", usage.constant_free_bricks},
          {"free_bricks", usage.free_bricks},
          {"dense_bricks", usage.dense_bricks},
          {"voxel_size_m", map.config.voxel_size_m},
          {"truncation_m", map.config.truncation_m()}};
}

json result_json(const FuseRun& run, const TsdfSnapshot& map) {
  const FuseRecord& record = run.record;
  const auto timing = [](const std::vector<double>& ms) -> json {
    return {{"median", median(ms)}, {"frames", ms.size()}};
  };
  const bool tracked = !record.raycast_ms.empty() || !run.fit;
  json result{{"folder", run.options.frames.string()},
              {"out", run.options.out.string()},
              {"layout", run.info.is_bag ? "bag" : to_string(run.info.layout)},
              {"damage", run.info.damage.empty() ? json{} : json(run.info.damage)},
              {"camera", camera_to_json(run.camera)},
              {"intrinsics_from", run.info.intrinsics_from},
              {"tracking", to_string(run.tracking)},
              {"fill_gaps_px", record.gaps.max_gap_px},
              {"interrupted", interrupted()},
              {"frames", record.fused.size()},
              {"lost", record.lost.size()},
              {"lost_frames", left_out_json(record.lost)},
              {"skipped", left_out_json(record.skipped)},
              {"ms_per_frame",
               {{"track", timing(record.track_ms)},
                {"integrate", timing(record.integrate_ms)},
                {"raycast", timing(tracked ? record.raycast_ms : run.fit->raycast_ms)}}},
              {"depth_residual_m", nullptr},
              {"trajectory_error_m", nullptr},
              {"map", map_json(map)},
              {"mesh", {{"triangles", run.triangles}}},
              {"peak_rss_bytes", peak_rss_bytes()}};
  if (run.fit) {
    result["depth_residual_m"] = {{"median", run.fit->residual.median_m()},
                                  {"share", run.fit->residual.share()},
                                  {"frames", run.fit->frames},
                                  {"valid_pixels", run.fit->residual.valid()}};
  }
  if (run.trajectory) {
    result["trajectory_error_m"] = {{"first_pose_rmse", run.trajectory->first_pose_rmse_m},
                                    {"aligned_rmse", run.trajectory->aligned_rmse_m},
                                    {"max", run.trajectory->max_m},
                                    {"poses", run.trajectory->poses}};
  }
  return result;
}

void print_summary(const FuseRun& run, const TsdfSnapshot& map) {
  const FuseRecord& record = run.record;
  Summary summary{std::cout};
  summary.line("frames", std::to_string(record.fused.size()) + " fused, " + std::to_string(record.lost.size()) +
                             " lost, " + std::to_string(record.skipped.size()) + " skipped");
  const std::string source = run.info.is_bag ? "bag" : "folder";
  const std::string why = " (the " + source + (run.info.has_poses ? " has poses)" : " has no poses)");
  summary.line("tracking", std::string{to_string(run.tracking)} + (run.options.tracking ? "" : why));
  if (run.fit) {
    summary.line("residual", millimetres(run.fit->residual.median_m()) + " median over " +
                                 percent(run.fit->residual.share()) + " of the pixels");
  }
  if (run.trajectory) {
    summary.line("trajectory", millimetres(run.trajectory->aligned_rmse_m) + " RMSE aligned, " +
                                   millimetres(run.trajectory->first_pose_rmse_m) + " from the first pose");
  }
  const TsdfGrid::Usage usage = map.grid.usage();
  summary.line("map", std::to_string(usage.bricks()) + " bricks, " + mebibytes(usage.bytes));
  summary.line("per frame", fixed(median(record.track_ms), 1) + " ms track, " + fixed(median(record.raycast_ms), 1) +
                                " ms ray cast, " + fixed(median(record.integrate_ms), 1) + " ms integrate (medians)");
  summary.line("results", run.options.out.string());
}

Status write_trajectory(const RunFolder& out, const FuseRecord& record) {
  std::vector<StampedPose> poses;
  for (const FusedFrame& frame : record.fused) {
    poses.push_back({frame.time_s.value_or(static_cast<double>(frame.index)), frame.T_world_camera});
  }
  return write_tum_trajectory(out / "trajectory.txt", poses);
}

/// The results but run.json, which stands for a complete run: an earlier one goes first, the new one comes last.
Status write_results(FuseRun& run, const RgbdFolderSource& source, const RunFolder& out, const TsdfSnapshot& map) {
  SACCADE_CHECK(out.remove(std::span{kRunFiles}.first(1)));
  Stopwatch stopwatch;
  run.progress.update("saving the map", 0, 0);
  SACCADE_CHECK(save_map(map, out / "map.sacmap", run.executor));
  SACCADE_CHECK(write_trajectory(out, run.record));
  SACCADE_CHECK(out.remove(std::span{kRunFiles}.subspan(kNamesAlwaysWritten)));
  run.timings_ms["save"] = stopwatch.lap_ms();
  if (run.options.write_mesh) {
    run.progress.update("extracting the mesh", 0, 0);
    const TriangleMesh mesh = extract_mesh(map, run.executor);
    run.triangles = mesh.triangles.size();
    SACCADE_CHECK(write_mesh(out / "mesh.ply", mesh));
    run.timings_ms["mesh"] = stopwatch.lap_ms();
  }
  if (run.options.write_pictures && !interrupted()) {
    SACCADE_CHECK(
        write_fuse_pictures(out, map, run.camera, source, run.folder, run.record, run.executor, run.progress));
    run.timings_ms["pictures"] = stopwatch.lap_ms();
  }
  return {};
}

Result<int> run_fuse(const FuseOptions& options, const GlobalOptions& global) {
  const Stopwatch total;
  Stopwatch stopwatch;
  FuseRun run{options, global, global.executor(), ProgressBar{global.quiet}, {}, {}, {}, {}, {}, {}, {}, 0, {}};
  SACCADE_TRY(const auto source, open_frames(run));
  SACCADE_TRY(Reconstruction reconstruction, make_reconstruction(run));
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(const RunFolder out, RunFolder::open(options.out, kRunFiles, "run.json", options.force));
  run.timings_ms["open"] = stopwatch.lap_ms();

  std::optional<GapFilling> gaps;
  if (options.fill_gaps_px) gaps = GapFilling{*options.fill_gaps_px};
  run.record = fuse_frames(*source, reconstruction, run.tracking, gaps, run.executor, run.progress);
  run.timings_ms["frames"] = stopwatch.lap_ms();

  const TsdfSnapshot& map = reconstruction.map().content();
  if (run.record.fused.empty() || map.grid.empty()) return nothing_fused("fuse", run.record, options.frames);
  if (run.tracking != TrackingMode::forced) run.trajectory = measure_trajectory(run.record);
  SACCADE_TRY(run.fit, measure_map(map, run.camera, *source, run.folder, run.record, run.executor, run.progress));
  run.timings_ms["residual"] = stopwatch.lap_ms();
  SACCADE_CHECK(write_results(run, *source, out, map));
  run.timings_ms["total"] = total.elapsed_ms();

  const json document = json_envelope("fuse", global, run.executor, run.timings_ms, result_json(run, map));
  SACCADE_CHECK(write_json(out / "run.json", document));
  run.progress.finish();
  SACCADE_CHECK(write_json_output(global, document));
  if (!global.json_to_stdout()) print_summary(run, map);
  warn_of_left_out("fuse", run.record);
  warn_of_damage("fuse", options.frames, run.info);
  if (!interrupted()) return static_cast<int>(ExitStatus::done);
  print_error("fuse", "interrupted after " + std::to_string(run.record.fused.size()) +
                          " frames; what they gave is in " + options.out.string());
  return interrupt_status();
}

}  // namespace

void add_fuse(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("fuse", "RGB-D frames -> map, mesh, trajectory, figures and pictures");
  auto options = std::make_shared<FuseOptions>();
  add_fuse_options(*command, *options);
  command->callback([options, command, &global, &action] {
    options->map_size_given =
        command->count("--voxel-size") + command->count("--truncation") + command->count("--clearing") > 0;
    check_fuse_options(*options);
    action = [options, &global] { return run_fuse(*options, global); };
  });
}

}  // namespace saccade::cli
