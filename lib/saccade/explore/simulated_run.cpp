// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/simulated_run.hpp"

#include <limits>

#include "saccade/explore/attention_strategy.hpp"
#include "saccade/explore/oracle_strategy.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/scene/fixture_boxes.hpp"

namespace saccade {
namespace {

/// What carries the camera in run_simulated.
Result<std::unique_ptr<Robot>> carrier(const RayScene& scene, const SimulatedRunConfig& config) {
  if (!config.arm) {
    SACCADE_TRY(FreeRobot robot, flying_camera(scene));
    return std::unique_ptr<Robot>{std::make_unique<FreeRobot>(std::move(robot))};
  }
  ArmRobotConfig robot_config = config.arm_robot;
  robot_config.planner.seed = config.seed;
  // A search that ran out of time would depend on the machine and on what else runs there.
  robot_config.planner.budget_s = std::numeric_limits<double>::infinity();
  SACCADE_TRY(SimulatedRobot robot, simulated_arm(*config.arm, scene.scene(), config, std::move(robot_config)));
  return std::unique_ptr<Robot>{std::make_unique<SimulatedRobot>(std::move(robot))};
}

}  // namespace

std::string_view to_string(DepthSensor sensor) { return sensor == DepthSensor::kinect_v1 ? "kinect-v1" : "kinect-v2"; }

Result<DepthSensor> depth_sensor(std::string_view name) {
  for (const DepthSensor sensor : {DepthSensor::kinect_v1, DepthSensor::kinect_v2}) {
    if (to_string(sensor) == name) return sensor;
  }
  return Error{Errc::invalid_argument, "there is no sensor \"" + std::string{name} + "\"; known: kinect-v1, kinect-v2",
               ""};
}

Status SimulatedRunConfig::validate() const {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK(sphere.validate());
  SACCADE_CHECK(attention.validate());
  SACCADE_CHECK(contour_views.validate());
  SACCADE_CHECK(exploration.validate());
  SACCADE_CHECK(map().validate());
  if (arm) SACCADE_CHECK(arm_robot.validate());
  if (gain_width_px < 1) {
    return Error{Errc::invalid_argument, "the virtual sensor must be one pixel wide at least", "exploration"};
  }
  return {};
}

SimulatedRunConfig SimulatedRunConfig::with(StrategyKind kind) const {
  SimulatedRunConfig config = *this;
  config.strategy = kind;
  config.exploration.min_gain = min_gain_of(kind);
  return config;
}

TsdfConfig SimulatedRunConfig::map() const {
  TsdfConfig config;
  config.voxel_size_m = voxel_size_m;
  config.truncation_vox = truncation_vox;
  config.clearing_percent = clearing_percent;
  return config;
}

std::vector<Region> regions_of(const Scene& scene, StrategyKind strategy) {
  if (!looks_at_regions(strategy) || scene.regions.empty()) return {scene.workspace};
  return scene.regions;
}

std::unique_ptr<Strategy> make_strategy(const SimulatedRunConfig& config, const PinholeCamera& camera,
                                        std::size_t regions, const Truth* truth) {
  SACCADE_EXPECTS(regions > 0);
  GainConfig gain;
  gain.sensor = coarser(camera, std::min(config.gain_width_px, camera.width));
  gain.tilt_rad = config.exploration.oscillation_rad;
  const ContourConfig& contours = config.attention.contours;
  const auto max_views = static_cast<std::size_t>(config.exploration.max_views);
  const std::size_t views_per_region = (max_views + regions - 1) / regions;
  switch (config.strategy) {
    case StrategyKind::attention:
      return std::make_unique<AttentionStrategy>(config.attention, config.contour_views, gain);
    case StrategyKind::standard: return std::make_unique<StandardStrategy>(contours, config.contour_views, gain);
    case StrategyKind::sphere: return std::make_unique<SphereStrategy>(config.sphere, ray_gain(gain));
    case StrategyKind::random:
      return std::make_unique<RandomStrategy>(config.sphere, ray_gain(gain), views_per_region, config.seed);
    case StrategyKind::random_contours:
      return std::make_unique<RandomContourStrategy>(contours, config.contour_views, ray_gain(gain), config.seed);
    default:
      SACCADE_EXPECTS(truth != nullptr);
      return std::make_unique<OracleStrategy>(*truth, camera, gain.tilt_rad, contours, config.contour_views);
  }
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

Result<SimulatedRobot> simulated_arm(const ArmModel& arm, const Scene& scene, const SimulatedRunConfig& config,
                                     ArmRobotConfig robot) {
  if (!scene.objects.empty()) {
    SACCADE_TRY(const std::vector<FixtureBox> fixtures, fixture_boxes(scene));
    for (const FixtureBox& fixture : fixtures) robot.obstacles.fixtures.push_back(fixture.box);
  }
  robot.first_poses = scene.scan;
  TsdfConfig map = config.map();
  map.workspace = scene.workspace;
  return SimulatedRobot::create(arm, map, robot);
}

MeasuredMap measure_map(const Truth& truth, const TsdfSnapshot& map, const Executor& executor) {
  return {measure(truth, map, extract_mesh(map, executor), executor),
          count_unknown(map, truth.scene().scene().workspace)};
}

Result<SimulatedRun> run_simulated(const Truth& truth, const SimulatedRunConfig& config, const Executor& executor,
                                   const Progress& progress) {
  SACCADE_CHECK(config.validate());
  const std::size_t regions = regions_of(truth.scene().scene(), config.strategy).size();
  return run_simulated(truth, config, *make_strategy(config, config.camera, regions, &truth), executor, progress);
}

Result<SimulatedRun> run_simulated(const Truth& truth, const SimulatedRunConfig& config, const Strategy& strategy,
                                   const Executor& executor, const Progress& progress) {
  SACCADE_CHECK(config.validate());
  const Scene& scene = truth.scene().scene();
  TsdfConfig map_config = config.map();
  map_config.workspace = scene.workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(map_config));
  SACCADE_TRY(SimulatedCamera sensor, simulated_camera(truth.scene(), config));
  SACCADE_TRY(std::unique_ptr<Robot> robot, carrier(truth.scene(), config));
  SACCADE_TRY(CarriedCamera camera, CarriedCamera::create(std::move(sensor), std::move(robot), config.arm.get()));
  ExplorationCell cell{config.camera, [&](const Pose& pose) { return camera.capture(pose, executor); }, camera.robot()};

  SimulatedRun run;
  SACCADE_TRY(run.scan, scan(map, cell, scene.scan, config.exploration, executor, {}, progress));
  run.initial = measure_map(truth, map.content(), executor);
  if (!run.scan.complete) {
    run.stopped_because = StopReason::cancelled;
    return run;
  }
  TsdfSnapshot before = map.snapshot();
  ExplorationHooks hooks;
  hooks.after_view = [&](const ExploredView& view, const Proposals&) {
    run.views.push_back({view, measure_map(truth, map.content(), executor),
                         newly_known(truth, before, map.content(), executor),
                         looks_at_object(truth, view.T_world_camera)});
    before = map.snapshot();
    return true;
  };
  SACCADE_TRY(const ExplorationResult explored, explore(map, cell, regions_of(scene, config.strategy), strategy,
                                                        config.exploration, executor, hooks, progress));
  run.stopped_because = explored.stopped_because;
  run.refused_at_end = explored.refused_at_end;
  return run;
}

}  // namespace saccade
