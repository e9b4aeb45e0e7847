// SPDX-License-Identifier: Apache-2.0
#pragma once
// ScannedClutter: what tests of strategies share.

#include <gtest/gtest.h>

#include "saccade/explore/attention_strategy.hpp"
#include "saccade/explore/simulated_run.hpp"
#include "saccade/scene/random_clutter.hpp"

namespace saccade::test {

/// A clutter of four objects after its initial scan by a small camera.
class ScannedClutter : public ::testing::Test {
 protected:
  static const RayScene& rays() {
    static const RayScene built = *RayScene::build(random_clutter(5, 4));
    return built;
  }
  static const Truth& truth() {
    static const Truth made = *Truth::build(rays(), 0.008, Executor::with_threads(2));
    return made;
  }
  static SimulatedRunConfig config() {
    SimulatedRunConfig config;
    config.voxel_size_m = 0.012;
    config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 3.0};
    config.gain_width_px = 80;
    config.exploration.min_gain = 10.0;
    config.exploration.oscillation_frames = 3;
    return config;
  }
  static GainConfig gain() {
    GainConfig gain;
    gain.sensor = coarser(config().camera, config().gain_width_px);
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
      ExplorationCell cell{config().camera, [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose); },
                           robot};
      EXPECT_TRUE(scan(map, cell, rays().scene().scan, config().exploration, Executor{})->complete);
      return map.snapshot();
    }();
    return after_scan;
  }

  static const Region& workspace() {
    static const Region region = rays().scene().workspace;
    return region;
  }
  static Situation situation(const TsdfSnapshot& map) {
    static const Executor executor;
    Situation situation{map, workspace(), 0, 0, executor};
    situation.min_gain = config().exploration.min_gain;
    return situation;
  }
  static Proposals proposed(const Strategy& strategy, const Situation& situation) {
    auto proposals = strategy.propose(situation);
    EXPECT_TRUE(proposals) << proposals.error().to_string();
    return *proposals;
  }
  static AttentionStrategy attention() { return {config().attention, config().contour_views, gain()}; }
};

}  // namespace saccade::test
