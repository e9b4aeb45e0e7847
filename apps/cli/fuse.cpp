// SPDX-License-Identifier: Apache-2.0
// saccade fuse: RGB-D frames → map, mesh, trajectory, figures and pictures.
#include <array>
#include <memory>
#include <sstream>

#include "context.hpp"
#include "fuse_frames.hpp"
#include "fuse_measures.hpp"
#include "fuse_options.hpp"
#include "fuse_pictures.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/mesh.hpp"
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
  std::optional<MapFit> fit;
  std::optional<TrajectoryError> trajectory;
  std::size_t triangles{0};
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
  SACCADE_TRY(TsdfSnapshot map, load_map(run.options.continue_map, run.context.executor()));
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
              {"out", run.out},
              {"layout", run.info.is_bag ? "bag" : to_string(run.info.layout)},
              {"damage", run.info.damage.empty() ? json{} : json(run.info.damage)},
              {"notes", run.info.notes},
              {"depth_units_per_m", run.info.encoding.units_per_m},
              {"depth_units_from", to_string(run.info.units_from)},
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

std::string fuse_text(const FuseRun& run, const TsdfSnapshot& map) {
  std::ostringstream text;
  const FuseRecord& record = run.record;
  const Summary summary{text};
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
  const bool in_given_world = run.tracking != TrackingMode::icp && !run.folder.poses_file;
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
    const TriangleMesh mesh = extract_mesh(map, executor);
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
    FuseRun run{fuse_, context, context.out().string(), {}, {}, {}, {}, {}, {}, {}, 0};
    SACCADE_TRY(const auto source, open_frames(run));
    SACCADE_TRY(Reconstruction reconstruction, make_reconstruction(run));
    SACCADE_CHECK(context.open_folder());
    context.lap("open");
    std::optional<GapFilling> gaps;
    if (fuse_.fill_gaps_px) gaps = GapFilling{*fuse_.fill_gaps_px};
    run.record = fuse_frames(*source, reconstruction, run.tracking, gaps, context.executor(), context.bar());
    context.lap("frames");

    const TsdfSnapshot& map = reconstruction.map().content();
    if (run.record.fused.empty() || map.grid.empty()) return nothing_fused(run.record, fuse_.frames);
    if (run.tracking != TrackingMode::forced) run.trajectory = measure_trajectory(run.record);
    SACCADE_TRY(run.fit,
                measure_map(map, run.camera, *source, run.folder, run.record, context.executor(), context.bar()));
    context.lap("residual");
    SACCADE_CHECK(write_results(run, *source, *context.folder(), map));
    Outcome outcome{.result = result_json(run, map), .text = fuse_text(run, map)};
    warn_of_left_out(run.record, outcome);
    warn_of_damage(fuse_.frames, run.info, outcome);
    if (interrupted()) {
      outcome.cut_short =
          "interrupted after " + std::to_string(run.record.fused.size()) + " frames; what they gave is in " + run.out;
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
