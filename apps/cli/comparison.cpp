// SPDX-License-Identifier: Apache-2.0
#include "comparison.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "robot_options.hpp"
#include "saccade/arm/arm_model.hpp"
#include "saccade/core/fnv1a.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/views/baseline_gains.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

// To be raised whenever the same settings come to give other figures, so that old runs are not mixed with new ones.
constexpr int kFiguresRevision{3};

/// Hash of a set of views that all strategies choose from.
std::string hash_of(const std::vector<Pose>& views) {
  Fnv1a hash;
  for (const Pose& view : views) hash.add_all(view.matrix());
  return hash.text();
}

/// Everything that changes a run's figures, but for scene, strategy and seed; keys sorted, no blanks.
std::string settings_of(const SimulatedRunConfig& config, const std::string& arm_hash) {
  const TsdfConfig map = config.map();
  const ViewSphereConfig& sphere = config.sphere;
  json settings{{"revision", kFiguresRevision},
                {"camera", camera_to_json(config.camera)},
                {"noise", noise_key(config)},
                {"voxel_size_m", config.voxel_size_m},
                {"truncation_vox", map.truncation_vox},
                {"max_weight", map.max_weight},
                {"free_weight", map.free_weight},
                {"truth_spacing_m", kTruthSpacing_m},
                {"radii_m", sphere.radii_m},
                {"contour_distances_m", config.contour_views.distances_m},
                {"longitude_step_rad", sphere.longitude_step_rad},
                {"latitude_step_rad", sphere.latitude_step_rad},
                {"latitude_min_rad", sphere.latitude_min_rad},
                {"latitude_max_rad", sphere.latitude_max_rad},
                {"roll_step_rad", sphere.roll_step_rad},
                {"gain_width_px", config.gain_width_px},
                {"min_gain", config.planner.min_gain},
                {"good_enough", config.exploration.good_enough},
                {"max_views", config.exploration.max_views},
                {"oscillation_rad", config.exploration.oscillation_rad},
                {"oscillation_frames", config.exploration.oscillation_frames},
                {"robot", config.arm ? config.arm->name() : "free"}};
  if (map.clearing_percent != 100) settings["clearing_percent"] = map.clearing_percent;
  if (config.as_printed) settings["as_printed"] = true;
  if (config.fixed_views) {
    settings["fixed_views"] = config.fixed_views->size();
    settings["fixed_views_hash"] = hash_of(*config.fixed_views);
  }
  if (config.exploration.frame_on_way_s > 0.0) settings["frame_on_way_s"] = config.exploration.frame_on_way_s;
  if (config.exploration.lookahead > 1) settings["lookahead"] = config.exploration.lookahead;
  if (config.exploration.objective != Objective::surface)
    settings["objective"] = to_string(config.exploration.objective);
  if (config.strategy.name == surface_planner().name) settings["least_share"] = config.least_share;
  if (config.strategy.name == attention_planner().name) settings["rival_share"] = config.planner.rival_share;
  if (config.strategy.name == kVolumetricInformationNames.of(VolumetricInformation::area_factor))
    settings["touched_of"] = "rays, else box";
  if (config.strategy.name.ends_with(kOneShotSuffix)) settings["one_shot"] = "promises, then distance";
  if (config.arm) {
    settings["robot_hash"] = arm_hash;
    settings["planner"] = config.arm_robot.planner.planner;
    settings["max_motions"] = config.arm_robot.planner.max_motions;
    settings["obstacle_cell_m"] = config.arm_robot.obstacles.cell_size_m;
  }
  return settings.dump();
}

/// The scenes that one part of --scenes names.
Result<std::vector<Scene>> scenes_named(const std::string& name, const MeshSceneConfig& config) {
  std::vector<Scene> scenes;
  std::error_code ignored;
  if (std::filesystem::is_directory(name, ignored)) {
    SACCADE_TRY(const std::vector<std::filesystem::path> files, mesh_files(name));
    for (const std::filesystem::path& file : files) {
      SACCADE_TRY(Scene scene, mesh_scene(file, config));
      scenes.push_back(std::move(scene));
    }
  } else if (is_mesh_file(name) && std::filesystem::exists(name, ignored)) {
    SACCADE_TRY(Scene scene, mesh_scene(name, config));
    scenes.push_back(std::move(scene));
  } else {
    SACCADE_TRY(Scene scene, find_scene(name));
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace

std::size_t done_of(const std::vector<PlannedRun>& runs) {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const PlannedRun& run) { return run.found; }));
}

Status Comparison::add_scene(Scene scene, const std::string& given_as) {
  const bool empty = std::all_of(scene.objects.begin(), scene.objects.end(),
                                 [](const SceneObject& object) { return object.support || object.fixture; });
  if (empty) {
    return Error{Errc::invalid_argument, "there is no object in the scene, so that there is nothing to explore",
                 given_as};
  }
  SACCADE_CHECK(check_workspace(scene, options_.run.run.map().voxel_size_m));
  SACCADE_TRY(RayScene rays, RayScene::build(std::move(scene)));
  ComparedScene compared{rays.scene().name, scene_hash(rays), rays};
  const auto twin = std::find_if(scenes_.begin(), scenes_.end(),
                                 [&compared](const ComparedScene& other) { return other.name == compared.name; });
  if (twin == scenes_.end()) {
    scenes_.push_back(std::move(compared));
  } else if (twin->hash != compared.hash) {
    return Error{Errc::invalid_argument, "two different scenes are called " + compared.name + "; rename one", given_as};
  }
  return {};
}

Result<Comparison> Comparison::create(const CompareOptions& options) {
  Comparison comparison{options};
  for (const std::string& name : options.scenes) {
    SACCADE_TRY(std::vector<Scene> scenes, scenes_named(name, options.mesh));
    for (Scene& scene : scenes) SACCADE_CHECK(comparison.add_scene(std::move(scene), name));
  }
  SACCADE_CHECK(comparison.read_arm());
  return comparison;
}

Result<Comparison> Comparison::create(const CompareOptions& options, std::vector<Scene> scenes) {
  Comparison comparison{options};
  for (Scene& scene : scenes) {
    const std::string name = scene.name;
    SACCADE_CHECK(comparison.add_scene(std::move(scene), name));
  }
  SACCADE_CHECK(comparison.read_arm());
  return comparison;
}

Status Comparison::read_arm() {
  if (options_.robot == "free") return {};
  SACCADE_TRY(UrdfArm read, find_robot(options_.robot, options_.arm_reading.urdf));
  arm_hash_ = arm_hash(read.arm);
  arm_choices_ = std::move(read.choices);
  arm_ = std::make_shared<const ArmModel>(std::move(read.arm));
  return {};
}

SimulatedRunConfig Comparison::config_of(const PlannedRun& run) const {
  RunOptions options = options_.run;
  choose_strategy(options, run.strategy);
  SimulatedRunConfig config = options.run;
  set_noise(config, run.noise);
  config.seed = run.seed;
  config.exploration.max_views = run.max_views.value_or(config.exploration.max_views);
  config.arm = arm_;
  config.arm_robot.ik.numeric.restarts = kNumericRestarts;
  return config;
}

CampaignKey Comparison::key_of(const PlannedRun& run) const {
  SettingsTexts texts;
  return key_of(run, texts);
}

CampaignKey Comparison::key_of(const PlannedRun& run, SettingsTexts& texts) const {
  const ComparedScene& scene = scenes_[run.scene];
  std::string& settings = texts[{run.strategy.name, run.noise, run.max_views.value_or(-1)}];
  if (settings.empty()) settings = settings_of(config_of(run), arm_hash_);
  return {scene.name, scene.hash, run.strategy.name, run.noise, run.seed, settings};
}

PlannedRun Comparison::plan_again(const CampaignIndex& found, const PlannedRun& run) const {
  SettingsTexts texts;
  return plan_again(found, run, texts);
}

PlannedRun Comparison::plan_again(const CampaignIndex& found, const PlannedRun& run, SettingsTexts& texts) const {
  PlannedRun now = run;
  if (options_.equal_views && run.strategy.name != kEqualViewsOf) {
    PlannedRun sphere = run;
    sphere.strategy = *std::find_if(options_.strategies.begin(), options_.strategies.end(),
                                    [](const NamedPlanner& strategy) { return strategy.name == kEqualViewsOf; });
    sphere.max_views = options_.run.run.exploration.max_views;
    const std::optional<std::size_t> taken = found.find(key_of(sphere, texts));
    now.max_views = taken ? std::optional{static_cast<int>(*taken)} : std::nullopt;
  }
  if (now.max_views) now.found = found.find(key_of(now, texts)).has_value();
  return now;
}

bool Comparison::is_same_for_all_seeds(const NamedPlanner& strategy, const std::string& noise) const {
  SimulatedRunConfig run;
  set_noise(run, noise);
  return !run.noise && !arm_ && !strategy.uses_seed;
}

std::vector<PlannedRun> Comparison::plan(const CampaignIndex& found) const {
  std::vector<PlannedRun> runs;
  SettingsTexts texts;
  for (std::size_t scene = 0; scene < scenes_.size(); ++scene) {
    for (const std::string& noise : options_.noises) {
      for (const std::uint64_t seed : options_.seeds) {
        for (const NamedPlanner& strategy : options_.strategies) {
          const bool is_again = seed != options_.seeds.front() && is_same_for_all_seeds(strategy, noise);
          if (options_.same_runs_once && is_again) continue;
          PlannedRun run{scene, strategy, noise, seed, options_.run.run.exploration.max_views, false};
          if (options_.equal_views && strategy.name != kEqualViewsOf) run.max_views.reset();
          runs.push_back(plan_again(found, run, texts));
        }
      }
    }
  }
  return runs;
}

Result<std::vector<CampaignEntry>> Comparison::finished(const Campaign& campaign, const CampaignIndex& found) const {
  CampaignIndex places;  // in the plan
  SettingsTexts texts;
  std::size_t place = 0;
  for (const PlannedRun& run : plan(found)) {
    if (run.found) places.add(key_of(run, texts), place++);
  }
  SACCADE_TRY(std::vector<CampaignEntry> stored,
              campaign.figures([&places](const CampaignKey& key) { return places.find(key).has_value(); }));
  std::vector<CampaignEntry> finished(place);
  for (CampaignEntry& run : stored) {
    CampaignEntry& entry = finished[*places.find(run.key)];
    entry = std::move(run);
  }
  return finished;
}

}  // namespace saccade::cli
