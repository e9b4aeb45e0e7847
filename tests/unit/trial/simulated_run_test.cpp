// SPDX-License-Identifier: Apache-2.0
// Simulated runs with an arm: the same figures whatever else the machine does.
#include "saccade/trial/simulated_run.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "saccade/arm/urdf.hpp"
#include "saccade/scene/scene.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::size_t kViews{test::kSanitized ? 1 : 2};

const GroundTruth& small_truth() {
  static const GroundTruth truth =
      GroundTruth::build(RayScene::build(random_clutter(5, 4)).value(), 0.008, Executor::with_threads(2)).value();
  return truth;
}

SimulatedRunConfig small_run(std::uint64_t seed, bool with_arm) {
  SimulatedRunConfig config;
  config.voxel_size_m = 0.015;
  config.camera = PinholeCamera{120, 90, 98.4375, 98.4375, 59.5, 44.5, 0.5, 2.0};
  config.strategy = builtin_planners().find("sphere").value();
  config.gain_width_px = 60;
  config.sphere.roll_step_rad = 1.5707963267948966;
  config.planner.min_gain = 10;
  config.exploration.max_views = static_cast<int>(kViews);
  config.exploration.oscillation_frames = 3;
  config.seed = seed;
  if (with_arm) config.arm = std::make_shared<const ArmModel>(find_robot("comau").value().arm);
  return config;
}

RunRecord run_of(const SimulatedRunConfig& config, std::size_t threads = 1) {
  return run_simulated(small_truth(), config, Executor::with_threads(threads)).value();
}

void expect_equal(const RunRecord& a, const RunRecord& b) {
  EXPECT_EQ(a.scan.views, b.scan.views);
  EXPECT_EQ(a.scan.measures, b.scan.measures);
  EXPECT_EQ(a.stopped_because, b.stopped_because);
  ASSERT_EQ(a.views.size(), b.views.size());
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    const ViewRecord& of_a = a.views[i];
    const ViewRecord& of_b = b.views[i];
    EXPECT_EQ(of_a.T_world_camera.matrix(), of_b.T_world_camera.matrix());
    EXPECT_EQ(of_a.motion_s, of_b.motion_s);
    EXPECT_EQ(of_a.refused.total(), of_b.refused.total());
    EXPECT_EQ(of_a.measures.unknown_left, of_b.measures.unknown_left);
    EXPECT_EQ(of_a.measures.coverage, of_b.measures.coverage);
    EXPECT_EQ(of_a.measures.chamfer_m, of_b.measures.chamfer_m);
    EXPECT_EQ(of_a.measures.f_score, of_b.measures.f_score);
  }
}

TEST(SimulatedRun, AnArmCarriesTheCamera) {
  const RunRecord run = run_of(small_run(1, true), 2);
  EXPECT_GE(run.scan.views, 1U);
  ASSERT_EQ(run.views.size(), kViews);
  for (const ViewRecord& measured : run.views) {
    EXPECT_TRUE(measured.q);
    EXPECT_GT(measured.motion_s, 0.0);
    EXPECT_GT(measured.path.size(), 1U);
    EXPECT_GT(measured.refused.total(), 0U);  // an arm does not reach all of the view sphere
  }
  EXPECT_GT(run.final().coverage, run.scan.measures.coverage);
  const RunRecord flying = run_of(small_run(1, false), 2);
  ASSERT_FALSE(flying.views.empty());
  EXPECT_FALSE(flying.views.front().q);
  EXPECT_EQ(flying.views.front().motion_s, 0.0);
}

TEST(SimulatedRun, HasTheSameFiguresForEveryThreadCount) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  for (const bool with_arm : {true, false}) {
    const SimulatedRunConfig config = small_run(2, with_arm);
    expect_equal(run_of(config, 1), run_of(config, 4));
  }
}

TEST(SimulatedRun, RunsThatGoOnAtOnceDoNotDisturbEachOther) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  constexpr std::size_t kRuns{4};
  std::vector<RunRecord> at_once(kRuns);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kRuns; ++i) {
    threads.emplace_back([&at_once, i] { at_once[i] = run_of(small_run(i + 1, true)); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < kRuns; ++i) expect_equal(at_once[i], run_of(small_run(i + 1, true)));
}

TEST(SimulatedRun, TakesAllTheTimeThatItsMotionsTake) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  SimulatedRunConfig hasty = small_run(3, true);
  hasty.exploration.max_views = test::kSanitized ? 1 : 6;
  const RunRecord run = run_of(hasty, 2);
  hasty.arm_robot.planner.budget_s = 1e-9;
  expect_equal(run_of(hasty, 2), run);
}

TEST(SimulatedRun, RefusesAnArmThatCannotStand) {
  SimulatedRunConfig config = small_run(1, true);
  config.arm_robot.planner.planner = "Dijkstra";
  auto run = run_simulated(small_truth(), config, Executor{});
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, Errc::invalid_argument);
  config.arm_robot.planner = {};
  config.arm_robot.start = Configuration::Zero(2);
  run = run_simulated(small_truth(), config, Executor{});
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
