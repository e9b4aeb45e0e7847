// SPDX-License-Identifier: Apache-2.0
// saccade nbv: ranks view poses by what they would show of a region in a saved map.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>

#include "add_value.hpp"
#include "command.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/report/view_picture.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kViewFiles{"views.json", "views.png"};
constexpr double kDefaultRadius_m{0.2};

struct NbvOptions {
  std::filesystem::path map;
  std::optional<Eigen::Vector3d> poi;
  std::optional<double> radius_m;
  std::optional<Box> box;
  bool forget{false};
  std::filesystem::path poses_file;
  CameraOptions camera;
  ViewSphereConfig sphere;
  std::optional<Eigen::Vector3d> up;  ///< default: world z
  GainConfig gain;
  std::optional<Box> workspace;
  std::size_t top{10};
  bool all{false};
  std::filesystem::path out;
  bool force{false};

  [[nodiscard]] Region region() const {
    if (box) return *box;
    return Sphere{*poi, radius_m.value_or(kDefaultRadius_m)};
  }
  [[nodiscard]] Eigen::Vector3d center() const { return box ? Eigen::Vector3d{0.5 * (box->min + box->max)} : *poi; }
};

/// Candidates: from the view sphere, whose angles are then known, or from a file.
struct Candidates {
  std::vector<Pose> poses;
  std::vector<ViewCandidate> sphere;  ///< empty when they came from a file
};

/// Turns the candidates about the sphere's centre, so that what was up (world z) points along `up`.
void turn_upwards(std::vector<ViewCandidate>& candidates, const Eigen::Vector3d& center, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  const Pose T_turn = Eigen::Translation3d{center} * turn * Eigen::Translation3d{-center};
  for (ViewCandidate& candidate : candidates) candidate.T_world_camera = T_turn * candidate.T_world_camera;
}

Result<Candidates> make_candidates(const NbvOptions& options) {
  Candidates candidates;
  if (options.poses_file.empty()) {
    SACCADE_TRY(candidates.sphere, view_sphere(options.center(), options.sphere));
    if (options.up) turn_upwards(candidates.sphere, options.center(), *options.up);
    candidates.poses = poses_of(candidates.sphere);
  } else {
    SACCADE_TRY(candidates.poses, read_poses(options.poses_file));
  }
  return candidates;
}

/// The map as the views are to be judged in: nothing of this goes back to the file.
Result<TsdfSnapshot> prepare_map(const NbvOptions& options, const Executor& executor) {
  SACCADE_TRY(TsdfSnapshot loaded, load_map(options.map, executor));
  if (options.workspace) loaded.config.workspace = options.workspace;
  if (!options.forget) return loaded;
  TsdfMap map{std::move(loaded)};
  SACCADE_CHECK(map.forget(options.region()));
  return map.snapshot();
}

json region_json(const NbvOptions& options) {
  if (const auto& box = options.box) {
    return {{"kind", "box"}, {"min_m", point_json(box->min)}, {"max_m", point_json(box->max)}};
  }
  return {{"kind", "sphere"},
          {"center_m", point_json(*options.poi)},
          {"radius_m", options.radius_m.value_or(kDefaultRadius_m)}};
}

json view_json(const OrderedView& view, const Candidates& candidates) {
  json entry{{"gain", view.gain}, {"index", view.index}, {"T_world_camera", pose_to_json(view.T_world_camera)}};
  if (!candidates.sphere.empty()) {
    const ViewCandidate& on_sphere = candidates.sphere[view.index];
    entry["radius_m"] = on_sphere.radius_m;
    entry["longitude_rad"] = on_sphere.longitude_rad;
    entry["latitude_rad"] = on_sphere.latitude_rad;
    entry["roll_rad"] = on_sphere.roll_rad;
  }
  return entry;
}

json result_json(const NbvOptions& options, const Candidates& candidates, const GainResult& gains,
                 const std::vector<OrderedView>& ranked, std::size_t shown) {
  json views = json::array();
  for (std::size_t i = 0; i < shown; ++i) views.push_back(view_json(ranked[i], candidates));
  return {{"map", options.map.string()},
          {"region", region_json(options)},
          {"forgotten", options.forget},
          {"sensor", camera_to_json(options.gain.sensor)},
          {"tilt_rad", options.gain.tilt_rad},
          {"count", kGainCountNames.of(options.gain.count)},
          {"unknown_outside", kUnknownOutsideNames.of(options.gain.unknown_outside)},
          {"candidates", candidates.poses.size()},
          {"evaluated", gains.gains.size()},
          {"rays_total", gains.rays_total},
          {"rays_cast", gains.rays_cast},
          {"ms", {{"prepare", gains.prepare_ms}, {"evaluate", gains.evaluate_ms}}},
          {"views", std::move(views)}};
}

void print_table(const NbvOptions& options, const Candidates& candidates, const GainResult& gains,
                 const std::vector<OrderedView>& ranked, std::size_t shown) {
  std::cout << "rank      gain  ";
  if (!candidates.sphere.empty()) std::cout << "longitude  latitude   roll  ";
  std::cout << "position (m)\n";
  for (std::size_t i = 0; i < shown; ++i) {
    const OrderedView& view = ranked[i];
    std::cout << std::right << std::setw(4) << i + 1 << std::setw(10) << view.gain << "  ";
    if (!candidates.sphere.empty()) {
      const ViewCandidate& on_sphere = candidates.sphere[view.index];
      std::cout << std::setw(8) << fixed(to_deg(on_sphere.longitude_rad), 0) << "°" << std::setw(9)
                << fixed(to_deg(on_sphere.latitude_rad), 0) << "°" << std::setw(6)
                << fixed(to_deg(on_sphere.roll_rad), 0) << "°  ";
    }
    const Eigen::Vector3d p = view.T_world_camera.translation();
    for (int axis = 0; axis < 3; ++axis) std::cout << std::setw(8) << fixed(p[axis], 3);
    std::cout << '\n';
  }
  const char* unit = options.gain.count == GainCount::rays ? "rays" : "distinct voxels";
  std::cout << "gain: " << unit << " that would end in unknown space of the region; " << gains.gains.size()
            << " poses in " << fixed(gains.prepare_ms + gains.evaluate_ms, 0) << " ms, " << gains.rays_cast
            << " rays cast one by one\n";
}

Status write_outputs(const NbvOptions& options, const RunFolder& out, const TsdfSnapshot& map,
                     const std::vector<OrderedView>& ranked, const json& document, const Executor& executor) {
  SACCADE_CHECK(out.remove(std::span{kViewFiles}.first(1)));
  std::vector<ScoredPose> scored;
  for (const OrderedView& view : ranked) scored.push_back({view.T_world_camera, static_cast<double>(view.gain)});
  ViewPictureConfig picture;
  picture.sensor = options.gain.sensor;
  picture.overview.up = options.up.value_or(Eigen::Vector3d::UnitZ());
  picture.gain_unit = kGainCountNames.of(options.gain.count);
  SACCADE_CHECK(write_png(out / "views.png", view_picture(map, options.region(), scored, executor, picture)));
  return write_json(out / "views.json", document);
}

std::string advice_without_gain(const NbvOptions& options) {
  std::string advice{"no view shows anything unknown of the region: every gain is 0"};
  if (!options.forget)
    advice += "; is all of it known (--forget sets it back to unknown), or is it hidden or elsewhere?";
  return advice;
}

Result<int> run_nbv(const NbvOptions& options, const GlobalOptions& global) {
  const Stopwatch total;
  Stopwatch stopwatch;
  TimingsMs timings_ms;
  const Executor executor = global.executor();
  ProgressBar bar{global.quiet};
  SACCADE_TRY(const Candidates candidates, make_candidates(options));
  bar.update("loading the map", 0, 0);
  SACCADE_TRY(const TsdfSnapshot map, prepare_map(options, executor));
  SACCADE_CHECK(check_json_output(global));
  std::optional<RunFolder> out;
  if (!options.out.empty()) {
    SACCADE_TRY(RunFolder opened, RunFolder::open(options.out, kViewFiles, "views.json", options.force));
    out.emplace(std::move(opened));
  }
  timings_ms["load"] = stopwatch.lap_ms();

  Progress progress{
      [&bar](std::string_view, std::size_t done, std::size_t count) { bar.update("evaluating views", done, count); }};
  const CancelOnInterrupt cancel{progress};
  SACCADE_TRY(const GainResult gains,
              evaluate_views(map, options.region(), candidates.poses, options.gain, executor, progress));
  const std::vector<OrderedView> ranked = order_views(gains.gains, candidates.poses);
  timings_ms["evaluate"] = stopwatch.lap_ms();

  const std::size_t shown = options.all ? ranked.size() : std::min(options.top, ranked.size());
  timings_ms["total"] = total.elapsed_ms();
  const json document =
      json_envelope("nbv", global, executor, timings_ms, result_json(options, candidates, gains, ranked, shown));
  if (out) {
    bar.update("drawing", 0, 0);
    SACCADE_CHECK(write_outputs(options, *out, map, ranked, document, executor));
  }
  bar.finish();
  SACCADE_CHECK(write_json_output(global, document));
  if (!global.json_to_stdout()) {
    print_table(options, candidates, gains, ranked, shown);
    if (out) std::cout << "results: " << options.out.string() << '\n';
  }
  if (ranked.front().gain > 0) return static_cast<int>(ExitStatus::done);
  print_error("nbv", advice_without_gain(options));
  return static_cast<int>(ExitStatus::no_result);
}

void add_region_options(CLI::App& command, NbvOptions& options) {
  add_point(command, "--poi", options.poi,
            "point of interest: the centre of the region and of the view sphere, metres");
  add_value(command, "--radius", options.radius_m, "METRES",
            "radius of the region around --poi, metres (default: 0.2)");
  add_box(command, "--box", options.box, "box region, instead of --poi and --radius");
  command.add_flag("--forget", options.forget, "set the region back to unknown first (the file stays as it is)");
  add_box(command, "--workspace", options.workspace,
          "box outside of which nothing counts as unknown, instead of the map's");
}

void add_candidate_options(CLI::App& command, NbvOptions& options) {
  add_value(command, "--poses", options.poses_file, "FILE",
            "candidate poses (TUM, matrices, JSON), instead of the view sphere");
  add_lengths(command, "--distance", options.sphere.radii_m,
              "radius of the view sphere, metres; several separated by commas (default: 0.8)");
  command
      .add_option_function<std::string>(
          "--up",
          [&options](const std::string& text) {
            const Eigen::Vector3d up = parse_point("--up", text);
            if (!(up.norm() > 0.0)) usage_error("--up", "needs a direction, not a zero vector");
            options.up = up.normalized();
          },
          "what is up in the map's world: the pole of the view sphere (default: 0,0,1)")
      ->type_name("X,Y,Z");
}

void add_gain_options(CLI::App& command, NbvOptions& options) {
  add_camera_options(command, options.camera, true);
  add_choice(command, "--count", options.gain.count, kGainCountNames,
             "what counts: rays, or the distinct voxels they end in");
  add_choice(command, "--unknown-outside", options.gain.unknown_outside, kUnknownOutsideNames,
             "what unknown voxels outside the region do to a ray");
  command
      .add_option_function<double>(
          "--tilt", [&options](const double& tilt_deg) { options.gain.tilt_rad = to_rad(tilt_deg); },
          "the sensor will be tilted up and down by this angle, degrees (default: 0)")
      ->type_name("DEGREES");
}

void check_nbv_options(NbvOptions& options) {
  if (options.poi.has_value() == options.box.has_value()) usage_error("--poi", "give either --poi or --box");
  if (options.box && options.radius_m) usage_error("--radius", "goes with --poi, not with --box");
  if (options.radius_m) require_positive(*options.radius_m, "--radius");
  if (options.top == 0) usage_error("--top", "must be at least 1");
  options.gain.sensor = options.camera.camera(options.gain.sensor);
  require_ok(options.gain.validate(), "the sensor");
}

}  // namespace

void add_nbv(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("nbv", "ranks view poses for a region in a saved map");
  auto options = std::make_shared<NbvOptions>();
  add_value(*command, "map", options->map, "MAP", "saved map (.sacmap)")->required();
  add_region_options(*command, *options);
  add_candidate_options(*command, *options);
  add_gain_options(*command, *options);
  add_value(*command, "--top", options->top, "N", "views to print and to write")->check(check_whole_number);
  command->add_flag("--all", options->all, "print and write all views");
  add_value(*command, "--out", options->out, "DIR", "folder for views.json and views.png");
  command->add_flag("--force", options->force, "write into a folder that holds other files");
  command->callback([options, &global, &action] {
    check_nbv_options(*options);
    action = [options, &global] { return run_nbv(*options, global); };
  });
}

}  // namespace saccade::cli
