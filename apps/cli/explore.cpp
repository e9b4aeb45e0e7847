// SPDX-License-Identifier: Apache-2.0
// saccade explore: a simulated camera looks, fuses and decides where to look next, until a scene is known.
#include <array>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>

#include "command.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/explore/exploration.hpp"
#include "saccade/explore/metrics.hpp"
#include "saccade/io/image_io.hpp"
#include "saccade/io/json_io.hpp"
#include "saccade/io/ply_io.hpp"
#include "saccade/io/sacmap.hpp"
#include "saccade/io/scene_yaml.hpp"
#include "saccade/report/ternary_picture.hpp"
#include "saccade/scene/simulated_camera.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr double kMaxRange_m{2.0};  // beyond it, depth is too coarse for objects on a table

struct ExploreOptions {
  std::string scene;
  std::filesystem::path out;
  std::string robot{"free"};
  std::string strategy{"sphere"};
  CameraOptions camera;
  TsdfConfig map;
  ExplorationConfig exploration;
  double radius_m{0.8};
  bool noise{true};
  bool write_pictures{true};
  bool force{false};
};

/// Everything between the command line and the summary.
struct ExploreRun {
  const ExploreOptions& options;
  const RunFolder& out;
  Executor executor;
  ProgressBar progress;
  Truth truth;
  TsdfMap map;
  json views;
  Metrics last;
};

/// The map as it is now against the truth.
Metrics measure_now(const ExploreRun& run) {
  return measure(run.truth, run.map.content(), extract_mesh(run.map.content(), run.executor), run.executor);
}

std::size_t unknown_left(const ExploreRun& run) {
  return count_unknown(run.map.content(), run.truth.scene().scene().workspace);
}

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

/// The map with unknown in black, from the same place for every view.
Status draw(const ExploreRun& run, std::size_t number, const std::string& title) {
  if (!run.options.write_pictures) return {};
  std::ostringstream name;
  name << "view-" << std::setw(2) << std::setfill('0') << number << ".png";
  const Viewpoint overview = overview_of(run.truth.scene().scene().workspace);
  return write_png(run.out / name.str(), ternary_figure(run.map.content(), overview, run.executor, title));
}

json view_json(ExploreRun& run, const ExploredView& view, const TsdfSnapshot& before) {
  run.last = measure_now(run);
  const NewlyKnown known = newly_known(run.truth, before, run.map.content(), run.executor);
  return {{"index", run.views.size()},
          {"region", view.region},
          {"gain", view.gain},
          {"candidates", view.candidates},
          {"T_world_camera", pose_to_json(view.T_world_camera)},
          {"unknown_left", unknown_left(run)},
          {"unknown_near_objects", run.last.unknown_near_objects},
          {"points_at_object", known.points_at_object()},
          {"coverage", run.last.coverage},
          {"ms",
           {{"candidates", view.candidates_ms},
            {"evaluation", view.evaluation_ms},
            {"motion", view.motion_ms},
            {"fusion", view.fusion_ms}}}};
}

/// An earlier, longer run may have left more pictures than this one will write over.
Status remove_pictures(const RunFolder& out) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{out.path()}) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("view-") && name.ends_with(".png")) names.push_back(name);
  }
  return out.remove(std::vector<std::string_view>{names.begin(), names.end()});
}

/// Regions of the scene, or its whole workspace; never the true objects.
std::vector<Region> regions_of(const Scene& scene) {
  return scene.regions.empty() ? std::vector<Region>{scene.workspace} : scene.regions;
}

Result<SimulatedCamera> make_camera(const ExploreOptions& options, const RayScene& rays, std::uint64_t seed) {
  SimulatedCameraConfig config;
  config.camera = options.exploration.gain.sensor;
  config.noise = options.noise ? std::optional{kinect_v1_noise(seed)} : std::nullopt;
  return SimulatedCamera::create(rays, config);
}

Result<ExplorationResult> scan_and_explore(ExploreRun& run, const GlobalOptions& global, json& initial) {
  const Scene& scene = run.truth.scene().scene();
  SACCADE_TRY(SimulatedCamera camera, make_camera(run.options, run.truth.scene(), global.seed));
  FreeRobot robot;
  const auto observe = [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose, run.executor); };
  ExplorationCell cell{camera.camera(), observe, robot};
  ExplorationConfig config = run.options.exploration;
  config.seed = global.seed;
  run.progress.update("initial scan", 0, 0);
  SACCADE_CHECK(scan(run.map, cell, scene.scan, config, run.executor));
  run.last = measure_now(run);
  initial = {{"coverage", run.last.coverage}, {"unknown_left", unknown_left(run)}};
  SACCADE_CHECK(draw(run, 0, "After the initial scan"));
  TsdfSnapshot before = run.map.snapshot();
  Status drawn;
  const auto on_view = [&](const ExploredView& view) {
    run.views.push_back(view_json(run, view, before));
    run.progress.update("exploring", run.views.size(), static_cast<std::size_t>(config.max_views));
    drawn = draw(run, run.views.size(), "After view " + std::to_string(run.views.size()));
    before = run.map.snapshot();
    return drawn.ok() && !interrupted();
  };
  auto result = explore(run.map, cell, regions_of(scene), config, run.executor, on_view);
  if (!drawn.ok()) return drawn.error();
  return result;
}

void print_summary(const ExploreRun& run, const json& result) {
  std::cout << std::fixed << std::setprecision(1);
  for (const json& view : run.views) {
    std::cout << "view " << std::setw(2) << view["index"].get<std::size_t>() + 1 << "  gain " << std::setw(7)
              << view["gain"].get<std::uint64_t>() << "  coverage " << 100.0 * view["coverage"].get<double>()
              << " %  unknown " << view["unknown_left"].get<std::size_t>() << '\n';
  }
  std::cout << "coverage  " << 100.0 * result["initial"]["coverage"].get<double>() << " % after the scan, "
            << 100.0 * run.last.coverage << " % at the end\n";
  if (run.last.f_score) {
    std::cout << "accuracy  " << 1e3 * *run.last.accuracy_m << " mm, Chamfer " << 1e3 * *run.last.chamfer_m
              << " mm, F-score at 5 mm " << std::setprecision(3) << *run.last.f_score << '\n';
  }
  std::cout << "stopped   " << result["stopped_because"].get<std::string>() << '\n'
            << "results   " << run.options.out.string() << '\n';
}

Result<int> run_explore(const ExploreOptions& options, const GlobalOptions& global) {
  const Stopwatch total;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(Scene scene, find_scene(options.scene));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  SACCADE_TRY(const RunFolder out, RunFolder::open(options.out, {}, "run.json", options.force));
  SACCADE_CHECK(remove_pictures(out));
  constexpr double kTruthSpacing_m{0.004};
  SACCADE_TRY(Truth truth, Truth::build(rays, kTruthSpacing_m, executor));
  TsdfConfig config = options.map;
  config.workspace = rays.scene().workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(config));
  ExploreRun run{options,        out,           executor, ProgressBar{global.quiet}, std::move(truth),
                 std::move(map), json::array(), {}};

  json initial;
  SACCADE_TRY(const ExplorationResult explored, scan_and_explore(run, global, initial));
  SACCADE_CHECK(save_map(run.map.content(), out / "map.sacmap", executor));
  SACCADE_CHECK(write_mesh(out / "mesh.ply", extract_mesh(run.map.content(), executor)));
  json result{{"scene", rays.scene().name},
              {"out", options.out.string()},
              {"robot", options.robot},
              {"strategy", options.strategy},
              {"noise", options.noise},
              {"camera", camera_to_json(options.exploration.gain.sensor)},
              {"interrupted", interrupted()},
              {"initial", std::move(initial)},
              {"views", run.views},
              {"final",
               {{"coverage", run.last.coverage},
                {"unknown_left", unknown_left(run)},
                {"unknown_near_objects", run.last.unknown_near_objects},
                {"accuracy_m", optional_json(run.last.accuracy_m)},
                {"chamfer_m", optional_json(run.last.chamfer_m)},
                {"f_score", optional_json(run.last.f_score)}}},
              {"stopped_because", to_string(explored.stopped_because)}};
  run.progress.finish();
  const json document = json_envelope("explore", global, executor, {{"total", total.elapsed_ms()}}, result);
  SACCADE_CHECK(write_json(out / "run.json", document));
  SACCADE_CHECK(write_json_output(global, document));
  if (!global.json_to_stdout()) print_summary(run, result);
  if (interrupted()) {
    print_error("explore", "interrupted after " + std::to_string(run.views.size()) + " views; what they gave is in " +
                               options.out.string());
    return interrupt_status();
  }
  return static_cast<int>(explored.views.empty() && explored.stopped_because == StopReason::no_candidate
                              ? ExitStatus::no_result
                              : ExitStatus::done);
}

}  // namespace

void add_explore(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("explore", "a simulated camera explores a scene, view by view");
  auto options = std::make_shared<ExploreOptions>();
  command->add_option("scene", options->scene, "name of a built-in scene, clutter:SEED, or a YAML file")
      ->required()
      ->type_name("SCENE");
  command->add_option("--out", options->out, "folder for the results; made if it is not there")
      ->required()
      ->type_name("RUN");
  command->add_option("--robot", options->robot, "what carries the camera; free: it flies")
      ->check(CLI::IsMember({"free"}))
      ->capture_default_str();
  command
      ->add_option("--strategy", options->strategy,
                   "sphere: best gain on the view sphere around each region; random: its poses in random order")
      ->check(CLI::IsMember({"sphere", "random"}))
      ->capture_default_str();
  command->add_option("--max-views", options->exploration.max_views, "views at most, after the initial scan")
      ->check(CLI::Range(0, 1000))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--min-gain", options->exploration.min_gain, "gain below which a region is done")
      ->type_name("RAYS")
      ->capture_default_str();
  command->add_option("--radius", options->radius_m, "radius of the view sphere, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command->add_option("--voxel-size", options->map.voxel_size_m, "edge of a voxel, metres")
      ->type_name("METRES")
      ->capture_default_str();
  command->add_flag("--no-noise{false}", options->noise, "exact depth instead of that of a Kinect v1");
  command->add_flag("--no-pictures{false}", options->write_pictures, "draw no pictures");
  add_camera_options(*command, options->camera, true);
  command->add_flag("--force", options->force, "write into a folder that holds other files");
  command->callback([options, &global, &action] {
    if (options->out.empty()) usage_error("--out", "needs the name of a folder");
    require_positive(options->map.voxel_size_m, "--voxel-size");
    require_positive(options->radius_m, "--radius");
    options->exploration.sphere.radii_m = {options->radius_m};
    options->exploration.strategy = options->strategy == "random" ? Strategy::random : Strategy::sphere;
    PinholeCamera near_camera = options->exploration.gain.sensor;
    near_camera.max_range_m = kMaxRange_m;
    options->exploration.gain.sensor = options->camera.camera(near_camera);
    options->exploration.gain.tilt_rad = options->exploration.oscillation_rad;
    require_ok(options->map.validate(), "--voxel-size");
    require_ok(options->exploration.validate(), "the exploration");
    action = [options, &global] { return run_explore(*options, global); };
  });
}

}  // namespace saccade::cli
