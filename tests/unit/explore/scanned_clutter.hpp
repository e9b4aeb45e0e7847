// SPDX-License-Identifier: Apache-2.0
#pragma once
// ScannedClutter: what tests of planners share.

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/scene/scene.hpp"
#include "saccade/trial/internal/oracle_gain.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade::test {

/// Tells whether gains never rise.
inline bool falls(std::span<const RankedView> views) {
  return std::is_sorted(views.begin(), views.end(),
                        [](const RankedView& a, const RankedView& b) { return a.gain > b.gain; });
}

/// A clutter of four objects after its initial scan by a small camera.
class ScannedClutter : public ::testing::Test {
 protected:
  static const RayScene& rays() {
    static const RayScene built = *RayScene::build(random_clutter(5, 4));
    return built;
  }
  static const GroundTruth& truth() {
    static const GroundTruth made = *GroundTruth::build(rays(), 0.008, Executor::with_threads(2));
    return made;
  }
  static SimulatedRunConfig config() {
    SimulatedRunConfig config;
    config.voxel_size_m = 0.012;
    config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 3.0};
    config.gain_width_px = 80;
    config.planner.min_gain = 10.0;
    config.exploration.oscillation_frames = 3;
    return config;
  }
  static GainConfig gain() {
    GainConfig gain;
    gain.sensor = config().camera.scaled_to_width(config().gain_width_px);
    gain.tilt_rad = config().exploration.oscillation_rad;
    return gain;
  }
  static TsdfMap empty_map() {
    TsdfConfig map = config().map();
    map.workspace = rays().scene().workspace;
    return *TsdfMap::create(map);
  }
  static const TsdfSnapshot& scanned() {
    static const TsdfSnapshot after_scan = [] {
      TsdfMap map = empty_map();
      SimulatedCamera camera = *simulated_camera(rays(), config());
      FreeRobot robot;
      FunctionCamera sensor{config().camera, [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose); }};
      const Executor executor;
      Explorer explorer{{map, sensor, robot, executor}, config().exploration};
      EXPECT_TRUE(explorer.scan(rays().scene().scan)->complete);
      return map.snapshot();
    }();
    return after_scan;
  }

  static const Region& workspace() {
    static const Region region = rays().scene().workspace;
    return region;
  }
  static PlanningScene scene(const TsdfSnapshot& map, const Attempts* attempts = nullptr,
                             const Robot* robot = nullptr) {
    static const Executor executor;
    return {map, executor, nullptr, robot, attempts, 0};
  }
  static ViewPlanner planner(std::string_view name, const SimulatedRunConfig& wanted = config()) {
    SimulatedRunConfig named = wanted;
    named.strategy = trial_planners().find(name).value();
    const std::vector<Region> regions{workspace()};
    return make_planner(named, named.camera, regions, &truth());
  }
  static Ranking ranked(ViewPlanner planner, const PlanningScene& scene) {
    auto ranking = planner.rank(scene);
    EXPECT_TRUE(ranking) << ranking.error().to_string();
    return *ranking;
  }
};

}  // namespace saccade::test
