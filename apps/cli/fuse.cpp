// SPDX-License-Identifier: Apache-2.0
// saccade fuse: RGB-D frames → map, mesh, trajectory, figures and pictures.
#include <array>
#include <memory>
#include <sstream>

#include "context.hpp"
#include "fuse_frames.hpp"
#include "fuse_loops.hpp"
#include "fuse_measures.hpp"
#include "fuse_options.hpp"
#include "fuse_paging.hpp"
#include "fuse_pictures.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/mesh.hpp"
#include "shell_quoted.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kGravityFile{"gravity-direction.txt"};
constexpr std::array<std::string_view, 9> kRunFiles{"run.json",          "map.sacmap",      "trajectory.txt",
                                                    kGravityFile,        "mesh.ply",        "fusion-first.png",
                                                    "fusion-middle.png", "fusion-last.png", "ternary.png"};
constexpr std::size_t kFirstRemoved{4};  // those before are always written, or removed by copy_gravity

/// Everything between the command line and the summary.
struct FuseRun {
  const FuseOptions& options;
  Context& context;
  std::string out;  ///< folder of the results
  RgbdFolderConfig folder;
  TrackingMode tracking{TrackingMode::icp};
  PinholeCamera camera;
  RgbdFolderInfo info;
  FuseRecord record;
  std::optional<Pose> T_world_last;  ///< last pose in a map that is gone on with
  std::optional<MapFit> fit;
  std::optional<TrajectoryError> trajectory;
  std::size_t triangles{0};
  std::optional<LoopReport> loops;
  std::optional<PagingStats> paging;
  std::unique_ptr<GpuTracker> gpu;  ///< null: the CPU tracks
  bool gpu_worked{false};
  std::optional<Error> gpu_problem;
};

Result<std::unique_ptr<RgbdFolderSource>> open_frames(FuseRun& run) {
  SACCADE_TRY(OpenFrames frames, open_frames(run.options));
  run.folder = std::move(frames.folder);
  run.tracking = frames.tracking;
  run.camera = frames.source->camera();
  run.info = frames.source->info();
  return std::move(frames.source);
}

/// The pose of the last frame of a saved map: its run wrote the trajectory beside it.
std::optional<Pose> last_pose_beside(const std::filesystem::path& map) {
  const auto trajectory = read_tum_trajectory(map.parent_path() / "trajectory.txt");
  if (!trajectory || trajectory->empty()) return std::nullopt;
  return trajectory->back().T_world_camera;
}

Result<Reconstruction> make_reconstruction(FuseRun& run) {
  if (run.options.continue_map.empty()) return Reconstruction::create({run.options.map, IcpConfig{}});
  SACCADE_TRY(TsdfSnapshot map, load_map(run.options.continue_map, run.context.executor()));
  if (run.options.map.workspace) map.config.workspace = run.options.map.workspace;
  run.T_world_last = last_pose_beside(run.options.continue_map);
  if (!run.T_world_last && !needs_pose(run.tracking)) {
    run.context.bar().warn("warning: there is no trajectory.txt that can be read beside " +
                           run.options.continue_map.string() + ": a first frame without a pose starts at the origin");
  }
  return Reconstruction::resume(std::move(map), IcpConfig{});
}

/// Opens the GPU, where frames are to be tracked on it.
Status open_gpu(FuseRun& run, Reconstruction& reconstruction) {
  if (run.tracking == TrackingMode::forced) {
    if (run.options.backend != ComputeBackend::cuda) return {};
    return Error{Errc::invalid_argument,
                 "the frames are fused at their poses (--tracking forced), so that a GPU has nothing to track; give "
                 "--tracking icp, or leave --backend out",
                 "--backend"};
  }
  if (run.options.is_paged()) return {};
  SACCADE_TRY(run.gpu, gpu_tracker_on(run.options.backend, reconstruction.map().config(), run.gpu_problem));
  if (run.gpu_problem) {
    run.context.bar().warn("the GPU cannot be used: " + run.gpu_problem->message + "; the CPU does its work");
  }
  reconstruction.track_on(run.gpu.get());
  return {};
}

/// Gives the GPU back, and the map that it keeps; tells of what it could not do.
void leave_gpu(FuseRun& run, Reconstruction& reconstruction) {
  if (!run.gpu) return;
  run.gpu_worked = run.gpu->answered() > 0;
  run.gpu_problem = run.gpu->take_problem();
  if (run.gpu_problem) run.context.bar().warn("the GPU failed: " + run.gpu_problem->message + "; the CPU went on");
  reconstruction.track_on(nullptr);
  run.gpu.reset();
}

/// Closes loops where that was not done beside the frames, and fuses again along the corrected poses.
Status close_all(FuseRun& run, const RgbdFolderSource& source, Reconstruction& reconstruction) {
  const Executor& executor = run.context.executor();
  ProgressBar& bar = run.context.bar();
  if (run.options.loops == LoopMode::end) {
    SACCADE_TRY(run.loops, close_loops(source, run.folder, reconstruction.map().config(), executor, bar, run.record));
  }
  if (run.loops->T_world_corrected.empty()) return {};
  return fuse_record_again(source, run.folder, *run.loops, run.record, reconstruction, executor, bar);
}

/// Tracks and fuses all frames, and closes loops where this is asked for.
Status fuse_all(FuseRun& run, RgbdFolderSource& source, Reconstruction& reconstruction) {
  const Executor& executor = run.context.executor();
  ProgressBar& bar = run.context.bar();
  std::optional<GapFilling> gaps;
  if (run.options.fill_gaps_px) gaps = GapFilling{*run.options.fill_gaps_px};
  if (run.options.loops == LoopMode::online) {
    SACCADE_TRY(const OpenFrames again, open_frames(run.options));
    SACCADE_TRY(run.loops, fuse_frames_with_loops(source, *again.source, run.folder, reconstruction, run.tracking, gaps,
                                                  executor, bar, run.record));
  } else {
    run.record = fuse_frames(source, reconstruction, run.tracking, gaps, run.T_world_last, executor, bar);
  }
  leave_gpu(run, reconstruction);
  run.context.lap("frames");
  if (run.record.fused.empty()) return {};
  if (run.record.failure || run.options.loops == LoopMode::off || interrupted()) return {};
  const Status closed = close_all(run, source, reconstruction);
  if (!closed) run.record.failure = closed.error();  // reading a frame again, mostly; the map stands
  run.context.lap("loops");
  return {};
}

Status check_loops(const FuseRun& run) {
  if (run.options.loops != LoopMode::off && run.options.is_paged()) {
    return Error{Errc::invalid_argument, "the map that is fused again lies in memory: leave the options of paging out",
                 "--loops"};
  }
  return check_closing(run.options.loops, run.tracking);
}

json map_json(const TsdfSnapshot& map) {
  const TsdfGrid::Usage usage = map.grid.usage();
  return {{"bricks", usage.bricks()},
          {"bytes", usage.bytes + usage.away_bytes},
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
              {"out", run.out},
              {"layout", run.info.is_bag ? "bag" : kRgbdLayoutWords.of(run.info.layout)},
              {"damage", run.info.damage.empty() ? json{} : json(run.info.damage)},
              {"notes", run.info.notes},
              {"depth_units_per_m", run.info.encoding.units_per_m},
              {"depth_units_from", to_string(run.info.units_from)},
              {"camera", camera_to_json(run.camera)},
              {"intrinsics_from", run.info.intrinsics_from},
              {"tracking", to_string(run.tracking)},
              {"compute", compute_json(run.options.backend, run.gpu_worked, run.gpu_problem)},
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
              {"confidence", confidence_json(record)},
              {"depth_residual_m", nullptr},
              {"trajectory_error_m", nullptr},
              {"map", map_json(map)},
              {"paging", paging_json(run.paging, run.options)},
              {"loops", run.loops ? loops_json(*run.loops) : json{}},
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
                                    {"last_pose", run.trajectory->last_pose_m},
                                    {"poses", run.trajectory->poses}};
  }
  return result;
}

std::string fuse_text(const FuseRun& run, const TsdfSnapshot& map) {
  std::ostringstream text;
  const FuseRecord& record = run.record;
  const Summary summary{text};
  summary.line("frames", std::to_string(record.fused.size()) + " fused, " + std::to_string(record.lost.size()) +
                             " lost, " + std::to_string(record.skipped.size()) + " skipped");
  const std::string source =
      run.folder.poses_file ? run.folder.poses_file->string() : std::string{run.info.is_bag ? "the bag" : "the folder"};
  const std::string why = " (" + source + (run.info.has_poses ? " has poses)" : " has no poses)");
  summary.line("tracking", std::string{to_string(run.tracking)} + (run.options.tracking ? "" : why));
  if (run.fit) {
    summary.line("residual", millimetres(run.fit->residual.median_m()) + " median over " +
                                 percent(run.fit->residual.share()) + " of the pixels");
  }
  constexpr std::size_t kLeastPoses{3};  // alignment leaves nothing of the error of fewer
  if (run.trajectory && run.trajectory->poses >= kLeastPoses) {
    summary.line("trajectory", millimetres(run.trajectory->aligned_rmse_m) + " RMSE aligned, " +
                                   millimetres(run.trajectory->first_pose_rmse_m) + " from the first pose");
  }
  if (run.loops) summary.line("loops", loops_text(*run.loops));
  const TsdfGrid::Usage usage = map.grid.usage();
  summary.line("map", std::to_string(usage.bricks()) + " bricks, " + mebibytes(usage.bytes + usage.away_bytes));
  if (run.paging) summary.line("paging", paging_text(*run.paging));
  summary.line("per frame", fixed(median(record.track_ms), 1) + " ms track, " + fixed(median(record.raycast_ms), 1) +
                                " ms ray cast, " + fixed(median(record.integrate_ms), 1) + " ms integrate (medians)");
  summary.line("results", run.out);
  return text.str();
}

Status write_trajectory(const RunFolder& out, const FuseRecord& record) {
  std::vector<StampedPose> poses;
  for (const FusedFrame& frame : record.fused) {
    poses.push_back({frame.time_s.value_or(static_cast<double>(frame.index)), frame.T_world_camera});
  }
  return write_tum_trajectory(out / "trajectory.txt", poses);
}

/// Copies the direction of gravity from the folder of the frames, for saccade show, where the map is in the world of
/// the folder's poses. Removes that of an earlier run.
Status copy_gravity(const FuseRun& run, const RunFolder& out) {
  std::error_code ignored;
  const std::filesystem::path given = run.options.frames / kGravityFile;
  if (std::filesystem::equivalent(given, out / kGravityFile, ignored)) return {};
  SACCADE_CHECK(out.remove(std::array{kGravityFile}));
  const bool in_given_world = needs_pose(run.tracking) && !run.folder.poses_file;
  if (!in_given_world || !std::filesystem::is_regular_file(given, ignored)) return {};
  SACCADE_TRY(const std::string direction, read_text_file(given));
  return write_file_atomically(out / kGravityFile, direction);
}

/// The results but run.json, which stands for a complete run: an earlier one goes first, the new one comes last.
Status write_results(FuseRun& run, const RgbdFolderSource& source, const RunFolder& out, const TsdfSnapshot& map) {
  SACCADE_CHECK(out.remove(std::span{kRunFiles}.first(1)));
  const Executor& executor = run.context.executor();
  run.context.stage("saving the map");
  SACCADE_CHECK(save_map(map, out / "map.sacmap", executor));
  SACCADE_CHECK(write_trajectory(out, run.record));
  SACCADE_CHECK(out.remove(std::span{kRunFiles}.subspan(kFirstRemoved)));
  SACCADE_CHECK(copy_gravity(run, out));
  run.context.lap("save");
  if (run.options.write_mesh) {
    run.context.stage("extracting the mesh");
    SACCADE_TRY(const TriangleMesh mesh, mesh_of(map, executor));
    run.triangles = mesh.triangles.size();
    SACCADE_CHECK(write_mesh(out / "mesh.ply", mesh));
    run.context.lap("mesh");
  }
  if (run.options.write_pictures && !interrupted()) {
    SACCADE_CHECK(
        write_fuse_pictures(out, map, run.camera, source, run.folder, run.record, executor, run.context.bar()));
    run.context.lap("pictures");
  }
  return {};
}

/// Saves what the frames gave before a failure that is no frame's: of the store of a paged map, or of frames that are
/// read again. Returns the failure, and where the map is.
Error save_before_failure(const FuseRun& run, const RunFolder& out, const TsdfSnapshot& map) {
  Error failure = *run.record.failure;
  if (run.record.fused.empty() || !out.remove(std::span{kRunFiles}.first(1))) return failure;
  const bool saved = save_map(map, out / "map.sacmap", run.context.executor()) && write_trajectory(out, run.record);
  if (!saved) return failure;
  failure.message += "; the map of the " + std::to_string(run.record.fused.size()) + " frames before is " +
                     (out / "map.sacmap").string() + ", for --continue";
  return failure;
}

/// Options with which an interrupted run goes on, where frames are left and no loops are to be closed among all of
/// them.
std::string how_to_go_on(const FuseRun& run, std::size_t frames) {
  const std::size_t done = run.record.fused.size() + run.record.lost.size() + run.record.skipped.size();
  if (done >= frames || run.options.loops != LoopMode::off) return {};
  return "; go on with --first " + std::to_string(run.folder.first + done * run.folder.every_nth) + " --continue " +
         shell_quoted((std::filesystem::path{run.out} / "map.sacmap").string()) + " and another --out";
}

class Fuse final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"fuse", "fuses RGB-D frames into a map, with mesh, trajectory, measures and pictures"};
  }

  void declare(Options& options) override {
    options.folder({.value = "RUN",
                    .help = "folder for the results; made if it is not there",
                    .files = {kRunFiles.begin(), kRunFiles.end()},
                    .document = kRunFiles.front(),
                    .required = true,
                    .opened_by_command = true});
    declare_fuse(options, fuse_);
    command_ = &options.group();
  }

  void check(const GlobalOptions& /*global*/) override {
    fuse_.map_size_given =
        command_->count("--voxel-size") + command_->count("--truncation") + command_->count("--clearing") > 0;
    check_fuse_options(fuse_);
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    FuseRun run{fuse_, context, context.out().string(), {}, {}, {}, {}, {}, {}, {}, {}, 0, {}, {}, {}, false, {}};
    SACCADE_TRY(const auto source, open_frames(run));
    SACCADE_TRY(Reconstruction reconstruction, make_reconstruction(run));
    SACCADE_CHECK(check_loops(run));
    SACCADE_CHECK(open_gpu(run, reconstruction));
    SACCADE_CHECK(context.open_folder());
    context.lap("open");
    SACCADE_CHECK(page_map(reconstruction.map(), fuse_, context.folder()->path()));
    SACCADE_CHECK(fuse_all(run, *source, reconstruction));
    run.paging = reconstruction.map().paging();
    // The steps below bring in what they need, one view or block after the other.
    const Status rests = reconstruction.map().page_out_all(context.executor());
    if (!rests && !run.record.failure) run.record.failure = rests.error();
    const TsdfSnapshot& map = reconstruction.map().content();
    if (run.record.failure) return save_before_failure(run, *context.folder(), map);
    if (run.record.fused.empty() || map.grid.empty()) return nothing_fused(run.record, fuse_.frames);
    if (run.tracking != TrackingMode::forced) run.trajectory = measure_trajectory(run.record);
    auto fit = measure_map(map, run.camera, *source, run.folder, run.record, context.executor(), context.bar());
    if (!fit) {
      run.record.failure = fit.error();
      return save_before_failure(run, *context.folder(), map);
    }
    run.fit = *std::move(fit);
    context.lap("residual");
    SACCADE_CHECK(write_results(run, *source, *context.folder(), map));
    Outcome outcome{.result = result_json(run, map), .text = fuse_text(run, map)};
    if (run.tracking == TrackingMode::rgbd) note_missing_colors(run.record, outcome);
    warn_of_left_out(run.record, outcome);
    warn_of_damage(fuse_.frames, run.info, outcome);
    if (interrupted()) {
      outcome.cut_short = "interrupted after " + std::to_string(run.record.fused.size()) +
                          " frames; what they gave is in " + run.out + how_to_go_on(run, source->size().value_or(0));
    }
    return outcome;
  }

 private:
  const CLI::App* command_{nullptr};
  FuseOptions fuse_;
};

}  // namespace

void add_fuse(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Fuse>(program, global, action);
}

}  // namespace saccade::cli
