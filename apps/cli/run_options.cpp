// SPDX-License-Identifier: Apache-2.0
#include "run_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "add_value.hpp"
#include "length_options.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

std::vector<double> parse_distances(const std::string& text) {
  const auto count = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1;
  constexpr const char* kOption{"--distance, --radius"};
  const std::vector<double> distances_m = parse_numbers(kOption, text, count);
  for (const double distance_m : distances_m) require_length(distance_m, kOption);
  return distances_m;
}

}  // namespace

void add_run_options(CLI::App& command, RunOptions& options, const std::string& min_gain) {
  add_value(command, "--max-views", options.run.exploration.max_views, "N", "views at most, after the initial scan")
      ->check(CLI::Range(0, 1000));
  add_value(command, "--min-gain", options.min_gain, "GAIN",
            "least gain of a view worth taking (default: " + min_gain + ")");
  add_value(command, "--good-enough", options.run.exploration.good_enough, "SHARE",
            "take a view that the robot reaches sooner if it has this share of the best view's gain");
  add_value(command, "--rivals", options.run.planner.rival_share, "SHARE",
            "attention: choose the view among segments with at least this share of the greatest saliency; 1: for the "
            "most salient segment alone, as in the thesis");
  add_value(command, "--least-share", options.run.least_share, "SHARE",
            "surface: least gain of a view worth taking, as a share of the surface seen so far");
  command.add_flag(
      "--as-printed", options.run.as_printed,
      "attention, standard, sphere: as in the thesis; of segments the most salient alone, and every promise "
      "is believed, whatever earlier views have shown; update: also hands by GMM-AS, a virtual sensor of all pixels, "
      "and gains of views that the robot cannot take");
  add_value(command, "--gain-width", options.gain_width_px, "PIXELS",
            "pixels across of the virtual sensor that views are chosen with (default: " +
                std::to_string(options.run.gain_width_px) + "; update --as-printed: the camera's)")
      ->check(CLI::Range(1, 100000));
  add_value(command, "--distance,--radius", options.distances, "METRES[,METRES...]",
            "distances of views from what they look at, metres: radii of the view sphere, and of contour views");
  add_value(command, "--voxel-size", options.run.voxel_size_m, "METRES", "edge of a voxel, metres");
  add_value(command, "--truncation", options.run.truncation_vox, "VOXELS", "truncation distance, voxels");
  add_clearing_option(command, options.run.clearing_percent);
  command.add_flag("--no-noise{false}", options.run.noise, "exact depth instead of that of the sensor");
  add_choice(command, "--sensor", options.run.sensor, kDepthSensorNames,
             "noise of the simulated camera's depth; a Kinect v2's depth goes through its filter (default: that of "
             "--camera, if it has one of its own, else kinect-v1)")
      ->default_str("")
      ->each([&options](const std::string&) { options.sensor_given = true; });
  add_camera_options(command, options.camera, true);
}

void add_foresight_options(CLI::App& command, RunOptions& options) {
  add_value(
      command, "--lookahead", options.run.exploration.lookahead, "N",
      "choose the next view as one of N that together are expected to show most; they are chosen again after each view")
      ->check(CLI::Range(1, 100));
  add_choice(command, "--objective", options.run.exploration.objective, kObjectiveNames,
             "criterion for the choice of a view: the surface that it is expected to show, or that surface per second "
             "of motion and looking");
  add_value(command, "--frame-on-way", options.run.exploration.frame_on_way_s, "SECONDS",
            "also fuse a frame every SECONDS on an arm's way to a view; the choice of the view counts what these "
            "frames are expected to show (0: none)");
}

void add_mesh_options(CLI::App& command, MeshSceneConfig& mesh) {
  add_value(command, "--mesh-scale", mesh.scale, "METRES", "metres per unit of mesh files");
  add_choice(command, "--mesh-up", mesh.up, kUpAxisNames,
             "the axis of mesh files that points up (default: z, but y for glTF)");
}

void check_foresight(const RunOptions& options, const std::string& robot) {
  if (options.run.exploration.frame_on_way_s > 0.0 && robot == "free") {
    usage_error("--frame-on-way", "a camera that flies is at the next view at once; this needs an arm");
  }
}

Status check_workspace(const Scene& scene, double voxel_size_m) {
  constexpr double kMostVoxels{4e9};
  const Eigen::Vector3d size_m = scene.workspace.max - scene.workspace.min;
  const Index3 voxels = voxels_with_center_in(scene.workspace, voxel_size_m).size();
  const double count = static_cast<double>(voxels.x) * voxels.y * voxels.z;
  const bool is_small = std::min({voxels.x, voxels.y, voxels.z}) < 1;
  if (!is_small && count <= kMostVoxels) return {};
  return Error{Errc::invalid_argument,
               "the workspace of " + fixed(size_m.x(), 3) + " x " + fixed(size_m.y(), 3) + " x " +
                   fixed(size_m.z(), 3) + " m " +
                   (is_small ? "holds no voxel of " : "holds more than 4,000,000,000 voxels of ") +
                   fixed(1e3 * voxel_size_m, 1) + " mm; are its lengths in metres? If so, change --voxel-size",
               scene.name};
}

void check_run_options(RunOptions& options) {
  if (options.min_gain && !(*options.min_gain >= 0.0 && std::isfinite(*options.min_gain))) {
    usage_error("--min-gain", "must be a number of at least 0");
  }
  require_positive(options.run.voxel_size_m, "--voxel-size");
  require_positive(options.run.truncation_vox, "--truncation");
  require_ok(options.run.map().validate(), "--voxel-size, --truncation, --clearing");
  options.run.sphere.radii_m = parse_distances(options.distances);
  options.run.contour_views.distances_m = options.run.sphere.radii_m;
  options.run.camera = options.camera.camera(options.run.camera);
  if (!options.sensor_given && options.camera.preset_name == "kinect-v2") options.run.sensor = DepthSensor::kinect_v2;
  options.run.gain_width_px = options.gain_width_px.value_or(options.run.gain_width_px);
  require_ok(options.run.planner.validate(), "--rivals");
  if (!(options.run.least_share >= 0.0 && options.run.least_share <= 1.0)) {
    usage_error("--least-share", "is a share: within 0 and 1");
  }
  require_ok(options.run.validate(), "the exploration");
}

std::string min_gain_by_strategy() {
  const double usual = NamedPlanner{}.min_gain;
  const Planners planners = builtin_planners();
  std::string text;
  for (const NamedPlanner& planner : planners.all()) {
    if (planner.min_gain == usual) continue;
    text += fixed(planner.min_gain, 0) + ' ' + planner.gain_unit + " for " + planner.name + ", ";
  }
  return text + "any for baselines, " + fixed(usual, 0) + " for the others";
}

void choose_strategy(RunOptions& options, const NamedPlanner& strategy) {
  options.run = options.run.with(strategy);
  if (options.min_gain) options.run.planner.min_gain = *options.min_gain;
  require_ok(options.run.planner.validate(), "--min-gain");
}

std::string mixed_camera(const RunOptions& options) {
  const std::string& camera = options.camera.preset_name;
  if (!options.run.noise || camera.empty()) return {};
  const bool is_v2 = options.run.sensor == DepthSensor::kinect_v2;
  const bool fits = is_v2 ? camera == "kinect-v2" : camera == "kinect-v1" || camera == "xtion";
  if (fits) return {};
  return "the image and range are those of the camera " + camera + ", the noise is that of a " +
         noise_name(options.run) + " (--sensor chooses another one, --no-noise leaves it out)";
}

std::string noise_name(const SimulatedRunConfig& run) {
  if (!run.noise) return "none";
  return run.sensor == DepthSensor::kinect_v2 ? "Kinect v2, filtered" : "Kinect v1";
}

}  // namespace saccade::cli
