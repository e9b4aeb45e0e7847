// SPDX-License-Identifier: Apache-2.0
// Simulated runs with an arm: the same figures whatever else the machine does.
#include "saccade/explore/simulated_run.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "saccade/io/urdf.hpp"
#include "saccade/scene/random_clutter.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::size_t kViews{test::kSanitized ? 1 : 2};

const Truth& small_truth() {
  static const Truth truth =
      Truth::build(RayScene::build(random_clutter(5, 4)).value(), 0.008, Executor::with_threads(2)).value();
  return truth;
}

SimulatedRunConfig small_run(std::uint64_t seed, bool with_arm) {
  SimulatedRunConfig config;
  config.voxel_size_m = 0.015;
  config.camera = PinholeCamera{120, 90, 98.4375, 98.4375, 59.5, 44.5, 0.5, 2.0};
  config.strategy = StrategyKind::sphere;
  config.gain_width_px = 60;
  config.sphere.roll_step_rad = 1.5707963267948966;
  config.exploration.min_gain = 10;
  config.exploration.max_views = static_cast<int>(kViews);
  config.exploration.oscillation_frames = 3;
  config.seed = seed;
  if (with_arm) config.arm = std::make_shared<const ArmModel>(find_robot("comau").value().arm);
  return config;
}

SimulatedRun run_of(const SimulatedRunConfig& config, std::size_t threads = 1) {
  return run_simulated(small_truth(), config, Executor::with_threads(threads)).value();
}

void expect_equal(const SimulatedRun& a, const SimulatedRun& b) {
  EXPECT_EQ(a.scan.views, b.scan.views);
  EXPECT_EQ(a.initial.unknown_left, b.initial.unknown_left);
  EXPECT_EQ(a.stopped_because, b.stopped_because);
  ASSERT_EQ(a.views.size(), b.views.size());
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    const MeasuredView& of_a = a.views[i];
    const MeasuredView& of_b = b.views[i];
    EXPECT_EQ(of_a.view.T_world_camera.matrix(), of_b.view.T_world_camera.matrix());
    EXPECT_EQ(of_a.view.motion_s, of_b.view.motion_s);
    EXPECT_EQ(of_a.view.refused.total(), of_b.view.refused.total());
    EXPECT_EQ(of_a.after.unknown_left, of_b.after.unknown_left);
    EXPECT_EQ(of_a.after.metrics.coverage, of_b.after.metrics.coverage);
    EXPECT_EQ(of_a.after.metrics.chamfer_m, of_b.after.metrics.chamfer_m);
    EXPECT_EQ(of_a.after.metrics.f_score, of_b.after.metrics.f_score);
  }
}

TEST(SimulatedRun, AnArmCarriesTheCamera) {
  const SimulatedRun run = run_of(small_run(1, true), 2);
  EXPECT_GE(run.scan.views, 1U);
  ASSERT_EQ(run.views.size(), kViews);
  for (const MeasuredView& measured : run.views) {
    EXPECT_TRUE(measured.view.q);
    EXPECT_GT(measured.view.motion_s, 0.0);
    EXPECT_GT(measured.view.path.size(), 1U);
    EXPECT_GT(measured.view.refused.total(), 0U);  // an arm does not reach all of the view sphere
  }
  EXPECT_GT(run.final().metrics.coverage, run.initial.metrics.coverage);
  const SimulatedRun flying = run_of(small_run(1, false), 2);
  ASSERT_FALSE(flying.views.empty());
  EXPECT_FALSE(flying.views.front().view.q);
  EXPECT_EQ(flying.views.front().view.motion_s, 0.0);
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
  std::vector<SimulatedRun> at_once(kRuns);
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
  const SimulatedRun run = run_of(hasty, 2);
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
