// SPDX-License-Identifier: Apache-2.0
// An exploration whose gains or expected surface a device computes takes the same views as one on the CPU, to the bit:
// on a device with room for the map, with room for parts of it, and with next to none.
#include <gtest/gtest.h>

#include "saccade/cuda/gpu_map.hpp"
#include "saccade/explore/explorer.hpp"
#include "saccade/explore/planners.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

const RayScene& scene_for_device() {
  static const RayScene built = *RayScene::build(random_clutter(6, 3));
  return built;
}

TsdfMap map_for_device() {
  TsdfConfig config;
  config.voxel_size_m = 0.014;
  config.workspace = scene_for_device().scene().workspace;
  return *TsdfMap::create(config);
}

struct Strategy {
  const char* name;
  bool as_printed{false};
};

/// @param device nullptr: none.
RunRecord explored(TsdfMap& map, const Strategy& strategy, ViewDevice* device) {
  const Executor executor = Executor::with_threads(2, test::kParallelBackend);
  SimulatedCameraConfig sensor;
  sensor.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 3.0};
  SimulatedCamera camera = *SimulatedCamera::create(scene_for_device(), sensor);
  FunctionCamera frames{camera.camera(), [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose); }};
  FreeRobot robot = *flying_camera(scene_for_device());
  ExplorerConfig config;
  config.max_views = 3;
  config.oscillation_frames = 2;
  PlannerSetup setup;
  setup.gain.sensor = sensor.camera;
  setup.sphere.longitude_step_rad = 60_deg;
  setup.sphere.latitude_step_rad = 30_deg;
  setup.sphere.roll_step_rad = 90_deg;
  setup.least_share = 0.0;
  setup.planner.min_gain = 0.0;
  setup.regions = {scene_for_device().scene().workspace};
  setup.as_printed = strategy.as_printed;
  ExplorerParts parts{map, frames, robot, executor};
  parts.device = device;
  Explorer explorer{std::move(parts), config};
  const std::vector<Pose> scan{scene_for_device().scene().scan.front()};
  EXPECT_TRUE(explorer.scan(scan)->complete);
  ViewPlanner planner{builtin_planners().find(strategy.name)->make(setup)};
  return *explorer.explore(planner, RunRecord{});
}

/// @param kernels  least number of them on a device with room for the map
void expect_views_of_cpu(const Strategy& strategy, std::uint64_t kernels) {
  SCOPED_TRACE(strategy.name);
  TsdfMap expected_map = map_for_device();
  const RunRecord expected = explored(expected_map, strategy, nullptr);
  ASSERT_FALSE(expected.views.empty());
  for (const std::size_t memory : {~std::size_t{0}, std::size_t{3'000'000}, std::size_t{100'000}}) {
    SCOPED_TRACE(memory);
    TsdfMap map = map_for_device();
    GpuMap gpu =
        GpuMap::create_emulated(map.config(), Executor::with_threads(2, test::kParallelBackend), memory).value();
    const RunRecord run = explored(map, strategy, &gpu);
    ASSERT_EQ(run.views.size(), expected.views.size());
    for (std::size_t i = 0; i < run.views.size(); ++i) {
      EXPECT_EQ(run.views[i].T_world_camera.matrix(), expected.views[i].T_world_camera.matrix());
      EXPECT_EQ(run.views[i].gain_predicted, expected.views[i].gain_predicted);
    }
    EXPECT_TRUE(map.content().grid == expected_map.content().grid);
    if (memory == ~std::size_t{0}) {
      EXPECT_GE(gpu.traffic().kernels, kernels) << "the device did the work";
      EXPECT_FALSE(gpu.is_paged());
    }
  }
}

TEST(ExploreOnDevice, ExpectedSurfaceLeadsToTheViewsOfTheCpu) { expect_views_of_cpu({"surface"}, 20); }

TEST(ExploreOnDevice, GainsLeadToTheViewsOfTheCpu) {
  expect_views_of_cpu({"sphere"}, 3);
  expect_views_of_cpu({"sphere", true}, 3);  // Algorithm 1 to the letter
}

}  // namespace
}  // namespace saccade
