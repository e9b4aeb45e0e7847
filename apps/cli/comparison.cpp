// SPDX-License-Identifier: Apache-2.0
#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "interrupt.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/camera_io.hpp"
#include "saccade/io/scene_yaml.hpp"
#include "saccade/scene/scene_hash.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

// To be raised whenever the same settings come to give other figures, so that old runs are not mixed with new ones.
constexpr int kFiguresRevision{2};

/// Everything that changes a run's figures, but for scene, strategy and seed; keys sorted, no blanks.
std::string settings_of(const SimulatedRunConfig& config) {
  const TsdfConfig map = config.map();
  const ViewSphereConfig& sphere = config.sphere;
  json settings{{"revision", kFiguresRevision},
                {"camera", camera_to_json(config.camera)},
                {"noise", config.noise},
                {"voxel_size_m", config.voxel_size_m},
                {"truncation_vox", map.truncation_vox},
                {"max_weight", map.max_weight},
                {"free_weight", map.free_weight},
                {"truth_spacing_m", kTruthSpacing_m},
                {"radii_m", sphere.radii_m},
                {"longitude_step_rad", sphere.longitude_step_rad},
                {"latitude_step_rad", sphere.latitude_step_rad},
                {"latitude_min_rad", sphere.latitude_min_rad},
                {"latitude_max_rad", sphere.latitude_max_rad},
                {"roll_step_rad", sphere.roll_step_rad},
                {"gain_width_px", config.gain_width_px},
                {"min_gain", config.exploration.min_gain},
                {"max_views", config.exploration.max_views},
                {"oscillation_rad", config.exploration.oscillation_rad},
                {"oscillation_frames", config.exploration.oscillation_frames}};
  if (config.sensor != DepthSensor::kinect_v1) settings["sensor"] = to_string(config.sensor);
  return settings.dump();
}

CampaignFigures figures_of(const MeasuredMap& map) {
  return {map.metrics.coverage,   map.unknown_left,      map.metrics.unknown_near_objects,
          map.metrics.accuracy_m, map.metrics.chamfer_m, map.metrics.f_score};
}

CampaignRun campaign_run(CampaignKey key, const SimulatedRun& simulated, double seconds) {
  CampaignRun run;
  run.key = std::move(key);
  run.initial = figures_of(simulated.initial);
  for (const MeasuredView& measured : simulated.views) {
    const ExploredView& view = measured.view;
    const auto gain = std::isnan(view.gain) ? std::nullopt : std::optional{view.gain};
    run.views.push_back({view.region, gain, view.T_world_camera, view.candidates, view.frames,
                         figures_of(measured.after), measured.newly_known.points_at_object(), view.candidates_ms,
                         view.evaluation_ms, view.motion_ms, view.fusion_ms});
  }
  run.stopped_because = to_string(simulated.stopped_because);
  run.seconds = seconds;
  run.program_version = SACCADE_VERSION;
  return run;
}

/// "40 s", "12 min", "3.5 h".
std::string duration_text(double seconds) {
  constexpr double kMinute_s{60.0};
  constexpr double kHour_s{3600.0};
  if (seconds < 1.5 * kMinute_s) return std::to_string(std::lround(seconds)) + " s";
  if (seconds < 1.5 * kHour_s) return std::to_string(std::lround(seconds / kMinute_s)) + " min";
  const long tenths = std::lround(10.0 * seconds / kHour_s);
  return std::to_string(tenths / 10) + '.' + std::to_string(tenths % 10) + " h";
}

}  // namespace

Result<Comparison> Comparison::create(const CompareOptions& options) {
  Comparison comparison{options};
  for (const std::string& name : options.scenes) {
    SACCADE_TRY(Scene scene, find_scene(name));
    SACCADE_TRY(RayScene rays, RayScene::build(std::move(scene)));
    ComparedScene compared{rays.scene().name, scene_hash(rays), rays};
    const auto twin = std::find_if(comparison.scenes_.begin(), comparison.scenes_.end(),
                                   [&compared](const ComparedScene& other) { return other.name == compared.name; });
    if (twin == comparison.scenes_.end()) {
      comparison.scenes_.push_back(std::move(compared));
    } else if (twin->hash != compared.hash) {
      return Error{Errc::invalid_argument, "two different scenes are called " + compared.name + "; rename one", name};
    }
  }
  return comparison;
}

SimulatedRunConfig Comparison::config_of(const PlannedRun& run) const {
  RunOptions options = options_.run;
  choose_strategy(options, run.strategy);
  SimulatedRunConfig config = options.run;
  config.seed = run.seed;
  config.exploration.max_views = run.max_views.value_or(config.exploration.max_views);
  return config;
}

CampaignKey Comparison::key_of(const PlannedRun& run) const {
  const ComparedScene& scene = scenes_[run.scene];
  return {scene.name, scene.hash, std::string{to_string(run.strategy)}, run.seed, settings_of(config_of(run))};
}

Result<PlannedRun> Comparison::planned(const Campaign* campaign, std::size_t scene, std::uint64_t seed,
                                       StrategyKind strategy) const {
  PlannedRun run{scene, strategy, seed, options_.run.run.exploration.max_views, false};
  const bool as_sphere =
      options_.equal_views && strategy != StrategyKind::sphere && options_.strategies.front() == StrategyKind::sphere;
  if (as_sphere) {
    const PlannedRun sphere{scene, StrategyKind::sphere, seed, run.max_views, false};
    run.max_views.reset();
    if (campaign != nullptr) {
      SACCADE_TRY(const std::optional<CampaignRun> taken, campaign->find(key_of(sphere)));
      if (taken) run.max_views = static_cast<int>(taken->views.size());
    }
  }
  if (campaign != nullptr && run.max_views) {
    SACCADE_TRY(run.found, campaign->has(key_of(run)));
  }
  return run;
}

Result<std::vector<PlannedRun>> Comparison::plan(const Campaign* campaign) const {
  std::vector<PlannedRun> runs;
  for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
    for (const std::uint64_t seed : options_.seeds) {
      for (const StrategyKind strategy : options_.strategies) {
        SACCADE_TRY(PlannedRun run, planned(campaign, scene, seed, strategy));
        runs.push_back(run);
      }
    }
  }
  return runs;
}

Result<std::size_t> Comparison::run(const Campaign& campaign, const Executor& executor, ProgressBar& progress) const {
  SACCADE_TRY(const std::vector<PlannedRun> runs, plan(&campaign));
  const auto found = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const PlannedRun& run) { return run.found; }));
  if (found > 0) {
    progress.note(std::to_string(found) + " of " + std::to_string(runs.size()) + " runs found in " +
                  campaign.path().string());
  }
  Progress cancel;
  const CancelOnInterrupt guard{cancel};
  const Stopwatch clock;
  std::size_t done = 0;
  std::optional<std::size_t> truth_of;
  std::optional<Truth> truth;
  for (const PlannedRun& before : runs) {
    if (before.found) continue;
    const ComparedScene& scene = scenes_[before.scene];
    std::string stage =
        scene.name + ", " + std::string{to_string(before.strategy)} + ", seed " + std::to_string(before.seed);
    if (done > 0) {
      const double left = static_cast<double>(runs.size() - found - done);
      stage += ", about " + duration_text(1e-3 * clock.elapsed_ms() / static_cast<double>(done) * left) + " left";
    }
    progress.update(stage, found + done, runs.size());
    if (truth_of != before.scene) {
      SACCADE_TRY(truth, Truth::build(scene.rays, kTruthSpacing_m, executor));
      truth_of = before.scene;
    }
    // Sphere has been run by now; and another process may have done this one.
    SACCADE_TRY(const PlannedRun run, planned(&campaign, before.scene, before.seed, before.strategy));
    if (!run.found) {
      const Stopwatch stopwatch;
      SACCADE_TRY(const SimulatedRun simulated, run_simulated(*truth, config_of(run), executor, cancel));
      if (simulated.stopped_because == StopReason::cancelled) break;
      SACCADE_CHECK(campaign.add(campaign_run(key_of(run), simulated, 1e-3 * stopwatch.elapsed_ms())));
    }
    ++done;
    if (interrupted()) break;
  }
  progress.finish();
  return done;
}

Result<std::vector<CampaignRun>> Comparison::finished(const Campaign& campaign) const {
  SACCADE_TRY(const std::vector<PlannedRun> runs, plan(&campaign));
  std::vector<CampaignRun> finished;
  for (const PlannedRun& run : runs) {
    if (!run.found) continue;
    SACCADE_TRY(std::optional<CampaignRun> stored, campaign.find(key_of(run)));
    if (stored) finished.push_back(std::move(*stored));
  }
  return finished;
}

}  // namespace saccade::cli
