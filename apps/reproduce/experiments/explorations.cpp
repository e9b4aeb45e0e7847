// SPDX-License-Identifier: Apache-2.0
#include "experiments/explorations.hpp"

#include <algorithm>
#include <memory>

#include "experiments/exploration_pictures.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/recorded_run.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

constexpr double kMost_m{2.0};  // beyond, depth is too coarse for things on a table
constexpr int kUsualWidth_px{160};

/// As the thesis': a Kinect v2 on the Comau arm, all of whose rays count.
Result<SimulatedRunConfig> config_of(const NamedPlanner& strategy, const TableOptions& options) {
  SimulatedRunConfig config = SimulatedRunConfig{}.with(strategy);
  SACCADE_TRY(config.camera, camera_preset("kinect-v2"));
  config.camera.max_range_m = kMost_m;
  if (options.image_width_px > 0) {
    config.camera = config.camera.scaled_to_width(std::min(options.image_width_px, config.camera.width));
  }
  config.sensor = DepthSensor::kinect_v2;
  config.gain_width_px = config.camera.width;
  const double scale = static_cast<double>(config.gain_width_px) / kUsualWidth_px;
  config.planner.min_gain *= scale * scale;
  config.exploration.max_views = kExplorationViews;
  config.seed = options.seed;
  config.as_printed = strategy.name != surface_planner().name;
  SACCADE_TRY(UrdfArm arm, find_robot("comau"));
  config.arm = std::make_shared<const ArmModel>(std::move(arm.arm));
  return config;
}

}  // namespace

std::vector<RunRecord> Explorations::runs() const {
  std::vector<RunRecord> all;
  for (const std::optional<Exploration>& one : in_scene) all.push_back(one.value().run);
  return all;
}

Result<const Exploration*> exploration(const TableOptions& options, const Executor& executor, const Progress& progress,
                                       Explorations& all, std::size_t scene) {
  std::optional<Exploration>& made = all.in_scene.at(scene);
  if (made) return &*made;
  SACCADE_TRY(Scene found, find_scene(kTabletops.at(scene)));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(found)));
  SACCADE_TRY(const GroundTruth truth, GroundTruth::build(rays, kTruthSpacing_m, executor));
  SACCADE_TRY(const NamedPlanner planner, builtin_planners().find(all.strategy));
  SACCADE_TRY(const SimulatedRunConfig config, config_of(planner, options));
  ExplorationPainter painter{rays.scene().workspace, config, executor};
  Recorder unheard;
  Recorder& recorder = options.draws ? static_cast<Recorder&>(painter) : unheard;
  SACCADE_TRY(RunRecord run, run_recorded(truth, config, recorder, executor, progress));
  if (run.stopped_because == StopReason::cancelled) return Error{Errc::cancelled, "cancelled", kTabletops.at(scene)};
  made = Exploration{std::move(run), std::move(painter).pictures()};
  return &*made;
}

Status carry_out_explorations(const TableOptions& options, const Executor& executor, const Progress& progress,
                              ExplorationExperiments& all) {
  std::size_t done = 0;
  for (std::size_t scene = 0; scene < kTabletops.size(); ++scene) {
    for (Explorations* of_strategy : {&all.attention, &all.standard, &all.surface}) {
      progress.report("explorations", done++, 3 * kTabletops.size());
      SACCADE_TRY([[maybe_unused]] const Exploration* one,
                  exploration(options, executor, progress, *of_strategy, scene));
    }
  }
  return {};
}

double phase_seconds(const ViewRecord& view, std::initializer_list<Phase> phases) {
  double ms = 0.0;
  for (const Phase phase : phases) ms += view.times.ms(phase);
  return 1e-3 * ms;
}

double next_best_view_s(const ViewRecord& view) {
  return phase_seconds(view,
                       {Phase::segmentation, Phase::saliency, Phase::candidates, Phase::reachability, Phase::gain});
}

void add_exploration_notes(const TableOptions& options, ReproducedTable& table) {
  table.notes.emplace_back(
      "Here the four tabletop scenes, the arm and the Kinect v2 with its filter are simulated; the thesis' were real, "
      "with other objects. Figures compare in kind.");
  if (options.image_width_px > 0) {
    table.notes.push_back("Images are " + std::to_string(options.image_width_px) +
                          " pixels wide (--image-width), which is quicker, but not what the thesis did.");
  }
}

json experiments_json(const ExplorationExperiments& all) {
  json rows = json::array();
  for (const Explorations* of_strategy : {&all.attention, &all.standard, &all.surface}) {
    const std::vector<RunRecord> runs = of_strategy->runs();
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const RunRecord& run = runs[i];
      json views = json::array();
      for (const ViewRecord& view : run.views) {
        views.push_back({{"candidates", view.candidates},
                         {"evaluated", view.evaluated},
                         {"gain", view.gain_predicted},
                         {"coverage", *view.measures.coverage},
                         {"unknown_near_objects", *view.measures.unknown_near_objects},
                         {"points_at_object", *view.reveals_object},
                         {"looks_at_object", *view.looks_at_object},
                         {"nbv_ms", 1e3 * next_best_view_s(view)},
                         {"motion_s", view.motion_s}});
      }
      rows.push_back({{"scene", kTabletops.at(i)},
                      {"strategy", of_strategy->strategy},
                      {"unknown_near_objects", run.scan.measures.unknown_near_objects.value_or(0)},
                      {"views", std::move(views)}});
    }
  }
  return {{"experiments", std::move(rows)}};
}

}  // namespace saccade::reproduce
