// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/simulated_run.hpp"

#include <limits>

#include "saccade/core/fnv1a.hpp"
#include "saccade/explore/baseline_planners.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/trial/internal/oracle_gain.hpp"
#include "saccade/trial/internal/pair_oracle.hpp"
#include "saccade/trial/recorded_run.hpp"
#include "saccade/trial/surfel_measures.hpp"
#include "saccade/views/fixed_views.hpp"

namespace saccade {
namespace {

/// Where all scenes have the same candidates, chance differs by scene: else random views were one sequence for all.
std::uint64_t seed_of_choices(const SimulatedRunConfig& config, const GroundTruth* truth) {
  if (!config.fixed_views || truth == nullptr) return config.seed;
  Fnv1a hash;
  hash.add(config.seed);
  for (const char letter : truth->scene().scene().name) hash.add(std::uint64_t{static_cast<unsigned char>(letter)});
  return hash.value();
}

/// Returns the robot that carries the camera in run_simulated.
Result<std::unique_ptr<Robot>> carrier(const RayScene& scene, const SimulatedRunConfig& config) {
  if (!config.arm) {
    SACCADE_TRY(FreeRobot robot, flying_camera(scene));
    return std::unique_ptr<Robot>{std::make_unique<FreeRobot>(std::move(robot))};
  }
  PlannedArmConfig robot_config = config.arm_robot;
  robot_config.planner.seed = config.seed;
  // No time limit: a search that runs out of time would depend on the machine and its load.
  robot_config.planner.budget_s = std::numeric_limits<double>::infinity();
  SACCADE_TRY(PlannedArm robot, planned_arm(*config.arm, scene.scene(), config, std::move(robot_config)));
  return std::unique_ptr<Robot>{std::make_unique<PlannedArm>(std::move(robot))};
}

/// Runs an exploration; surfels are nullptr where the map is a volume.
Result<RunRecord> run_with(const GroundTruth& truth, const SimulatedRunConfig& config, ViewPlanner& planner,
                           SurfelModel* surfels, Recorder& recorder, const Executor& executor,
                           const Progress& progress);

/// Fills in the straight paths of a flying camera. It begins at the last pose of the scan, unless one was skipped.
void measure_flights(RunRecord& run, const std::vector<Pose>& scan) {
  std::optional<Eigen::Vector3d> last;
  if (!scan.empty() && run.scan.refused.total() == 0) last = scan.back().translation();
  for (ViewRecord& view : run.views) {
    const Eigen::Vector3d here = view.T_world_camera.translation();
    if (view.path.size() < 2 && last) view.path_m = (here - *last).norm();
    last = here;
  }
}

}  // namespace

Status SimulatedRunConfig::validate() const {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK(sphere.validate());
  SACCADE_CHECK(contours.validate());
  SACCADE_CHECK(attention.validate());
  SACCADE_CHECK(planner.validate());
  SACCADE_CHECK(contour_views.validate());
  SACCADE_CHECK(exploration.validate());
  SACCADE_CHECK(map().validate());
  if (arm) SACCADE_CHECK(arm_robot.validate());
  if (fixed_views && fixed_views->empty()) {
    return Error{Errc::invalid_argument, "there is no view in the set of candidates", "exploration"};
  }
  if (gain_width_px < 1) {
    return Error{Errc::invalid_argument, "the virtual sensor must be one pixel wide at least", "exploration"};
  }
  return {};
}

SimulatedRunConfig SimulatedRunConfig::with(const NamedPlanner& named) const {
  SimulatedRunConfig config = *this;
  config.strategy = named;
  config.planner.min_gain = named.min_gain;
  return config;
}

TsdfConfig SimulatedRunConfig::map() const {
  TsdfConfig config;
  config.voxel_size_m = map_kind == MapKind::surfels ? free_voxel_m : voxel_size_m;
  config.truncation_vox = truncation_vox;
  config.clearing_percent = clearing_percent;
  return config;
}

Planners trial_planners() {
  Planners planners = builtin_planners();
  for (NamedPlanner& planner : baseline_planners()) planners.add(std::move(planner));
  planners.add(oracle_planner());
  planners.add(pair_oracle_planner());
  return planners;
}

std::vector<Region> regions_of(const Scene& scene, const NamedPlanner& planner) {
  if (!planner.looks_at_regions || scene.regions.empty()) return {scene.workspace};
  return scene.regions;
}

ViewPlanner make_planner(const SimulatedRunConfig& config, const PinholeCamera& camera, std::span<const Region> regions,
                         const GroundTruth* truth) {
  SACCADE_EXPECTS(!regions.empty() && (truth != nullptr || !config.strategy.needs_truth));
  PlannerSetup setup;
  setup.gain.sensor = camera.scaled_to_width(std::min(config.gain_width_px, camera.width));
  setup.gain.tilt_rad = config.exploration.oscillation_rad;
  setup.sphere = config.sphere;
  setup.contours = config.contours;
  setup.contour_views = config.contour_views;
  setup.attention = config.attention;
  setup.weigh_by_saliency = config.weigh_by_saliency;
  setup.as_printed = config.as_printed;
  setup.least_share = config.least_share;
  setup.looks_ahead = config.exploration.foresight().is_needed() || config.exploration.good_enough < 1.0;
  setup.planner = config.planner;
  setup.regions = {regions.begin(), regions.end()};
  setup.max_views = static_cast<std::size_t>(config.exploration.max_views);
  setup.seed = seed_of_choices(config, truth);
  setup.camera = camera;
  setup.truth = truth;
  PlannerParts parts = config.strategy.make(setup);
  if (config.fixed_views) parts.generator = std::make_shared<FixedViews>(config.fixed_views);
  return ViewPlanner{std::move(parts)};
}

Result<SimulatedCamera> simulated_camera(const RayScene& scene, const SimulatedRunConfig& config) {
  SimulatedCameraConfig camera;
  camera.camera = config.camera;
  camera.noise = config.noise ? std::optional{kinect_v1_noise(config.seed)} : std::nullopt;
  if (config.noise && config.sensor == DepthSensor::kinect_v2) {
    camera.time_of_flight.emplace().noise.seed = config.seed;
    camera.depth_filter.emplace();
  }
  return SimulatedCamera::create(scene, camera);
}

Result<FreeRobot> flying_camera(const RayScene& scene) {
  SACCADE_TRY(const Solids fixtures, Solids::build(scene, [](const SceneObject& object) { return object.fixture; }));
  return FreeRobot{[fixtures](const Eigen::Vector3d& p) {
    return fixtures.distance_m(p, 2.0 * kCameraClearance_m) > kCameraClearance_m && !fixtures.contain(p);
  }};
}

Result<PlannedArm> planned_arm(const ArmModel& arm, const Scene& scene, const SimulatedRunConfig& config,
                               PlannedArmConfig robot, std::shared_ptr<JointController> joints) {
  if (!scene.objects.empty()) {
    SACCADE_TRY(const std::vector<FixtureBox> fixtures, fixture_boxes(scene));
    for (const FixtureBox& fixture : fixtures) robot.obstacles.fixtures.push_back(fixture.box);
  }
  robot.first_poses = scene.scan;
  TsdfConfig map = config.map();
  map.workspace = scene.workspace;
  return PlannedArm::create(arm, map, robot, std::move(joints));
}

Measures measure_map(const GroundTruth& truth, const TsdfSnapshot& map, const Executor& executor) {
  const Metrics metrics = measure(truth, map, extract_mesh(map, executor), executor);
  return {metrics.coverage,
          count_unknown(map, truth.scene().scene().workspace),
          metrics.unknown_near_objects,
          metrics.accuracy_m,
          metrics.chamfer_m,
          metrics.f_score};
}

Measures measure_run(const GroundTruth& truth, const TsdfSnapshot& map, const SurfelModel* surfels,
                     const SimulatedRunConfig& config, const Executor& executor) {
  if (surfels == nullptr) return measure_map(truth, map, executor);
  return measure_surfels(truth, map, surfels->surfels(), UnknownSurfelConfig{}.min_weight, config.voxel_size_m,
                         executor);
}

Status TruthMeter::scanned(ScanRecord& scan, const TsdfSnapshot& map) {
  scan.measures = measure_run(truth_, map, surfels_, config_, executor_);
  before_ = map;
  return {};
}

Status TruthMeter::viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> /*frames*/) {
  view.measures = measure_run(truth_, map, surfels_, config_, executor_);
  view.reveals_object = newly_known(truth_, before_, map, executor_).reveals_object();
  view.looks_at_object = looks_at_object(truth_, view.T_world_camera);
  before_ = map;
  return {};
}

Result<RunRecord> run_simulated(const GroundTruth& truth, const SimulatedRunConfig& config, const Executor& executor,
                                const Progress& progress) {
  Recorder unheard;
  return run_recorded(truth, config, unheard, executor, progress);
}

Result<RunRecord> run_simulated(const GroundTruth& truth, const SimulatedRunConfig& config, ViewPlanner& planner,
                                const Executor& executor, const Progress& progress) {
  Recorder unheard;
  return run_recorded(truth, config, planner, unheard, executor, progress);
}

Result<RunRecord> run_recorded(const GroundTruth& truth, const SimulatedRunConfig& config, Recorder& recorder,
                               const Executor& executor, const Progress& progress) {
  SACCADE_CHECK(config.validate());
  std::shared_ptr<SurfelModel> surfels;
  SimulatedRunConfig planned = config;
  if (config.map_kind == MapKind::surfels) {
    SACCADE_TRY(SurfelModel model, SurfelModel::create());
    surfels = std::make_shared<SurfelModel>(std::move(model));
    planned.strategy = surfel_planner(surfels);
  }
  ViewPlanner planner =
      make_planner(planned, config.camera, regions_of(truth.scene().scene(), planned.strategy), &truth);
  return run_with(truth, config, planner, surfels.get(), recorder, executor, progress);
}

Result<RunRecord> run_recorded(const GroundTruth& truth, const SimulatedRunConfig& config, ViewPlanner& planner,
                               Recorder& recorder, const Executor& executor, const Progress& progress) {
  SACCADE_CHECK(config.validate());
  if (config.map_kind == MapKind::surfels) {
    return Error{Errc::invalid_argument, "a planner of one's own chooses views on a volume, not on surfels",
                 "exploration"};
  }
  return run_with(truth, config, planner, nullptr, recorder, executor, progress);
}

namespace {

Result<RunRecord> run_with(const GroundTruth& truth, const SimulatedRunConfig& config, ViewPlanner& planner,
                           SurfelModel* surfels, Recorder& recorder, const Executor& executor,
                           const Progress& progress) {
  const Scene& scene = truth.scene().scene();
  TsdfConfig map_config = config.map();
  map_config.workspace = scene.workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(map_config));
  SACCADE_TRY(SimulatedCamera sensor, simulated_camera(truth.scene(), config));
  SACCADE_TRY(std::unique_ptr<Robot> robot, carrier(truth.scene(), config));
  SACCADE_TRY(MaskedCamera camera,
              MaskedCamera::create(std::move(sensor), std::move(robot), config.arm.get(), executor));
  TruthMeter meter{truth, config, surfels, executor};
  Recorders recorders{&meter, &recorder};
  Explorer explorer{{map, camera, camera.robot(), executor, &recorders, nullptr, {}, &progress, {}, surfels},
                    config.exploration};
  RunRecord run;
  SACCADE_TRY(run.scan, explorer.scan(scene.scan));
  if (!run.scan.complete) {
    run.scan.measures = measure_run(truth, map.content(), surfels, config, executor);
    run.stopped_because = StopReason::cancelled;
    return run;
  }
  SACCADE_TRY(run, explorer.explore(planner, std::move(run)));
  measure_flights(run, scene.scan);
  return run;
}

}  // namespace

}  // namespace saccade
