// SPDX-License-Identifier: Apache-2.0
// Motions of the built-in arm in the built-in scenes, looked at along the whole trajectory by FCL.
// SACCADE_PLANNING_SEEDS: seeds of views, pairs and plans (1); from two on, more pairs per scene.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/clock.hpp"
#include "support/effort.hpp"
#include "support/fcl_arm.hpp"
#include "support/planning_scenes.hpp"

namespace saccade {
namespace {

constexpr double kStep_m{0.002};  ///< no point of the arm moves farther between two configurations that FCL looks at
constexpr double kStep_s{0.002};
/// Every kAnyEvery-th pair goes to a view by any of its configurations, mostly straight; the others to one
/// configuration whose straight motion is not free.
constexpr std::size_t kAnyEvery{4};
constexpr int kDraws{200};

int seeds() {
  const char* wanted = std::getenv("SACCADE_PLANNING_SEEDS");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : 1;
}

struct PlanTally {
  std::size_t pairs{0};
  std::size_t solved{0};
  std::size_t straight{0};
  std::size_t searched{0};  ///< searched among the solved ones
  std::size_t out_of_time{0};
  std::size_t looked_at{0};   ///< configurations
  std::size_t collisions{0};  ///< collisions among these
  std::size_t touching_plans{0};
  std::size_t grazing_plans{0};  ///< by our own check, at other configurations than when it was planned
  std::vector<double> straight_ms;
  std::vector<double> search_ms;
  std::vector<double> trajectory_s;
  std::vector<double> stopping_s;
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Samples of the trajectory in which FCL finds a contact.
std::size_t collisions_along(const ArmCollision& arm, test::FclArm& fcl, const Trajectory& trajectory,
                             PlanTally& tally) {
  std::size_t collisions = 0;
  double dt_s = 0.0;
  for (double t_s = 0.0; t_s < trajectory.duration_s() + dt_s; t_s += dt_s) {
    const Trajectory::State state = trajectory.at(t_s);
    ++tally.looked_at;
    collisions += fcl.collides(forward_kinematics(arm.arm(), state.q)) ? 1 : 0;
    const double speed_m_per_s = arm.travel_bound_m(Configuration::Zero(state.q.size()), state.speed);
    dt_s = speed_m_per_s * kStep_s > kStep_m ? kStep_m / speed_m_per_s : kStep_s;
  }
  return collisions;
}

void plan_in(const std::string& scene, std::uint64_t seed, std::size_t pairs, const ArmCollision& arm,
             PlanTally& tally) {
  const Executor executor = Executor::with_threads(0);
  const ObstacleMap obstacles = test::seen_scene(scene, 4, seed, executor);
  const Reachability reachability = Reachability::create(arm).value();
  const std::vector<std::vector<Configuration>> views = test::free_views(reachability, obstacles);
  ASSERT_GT(views.size(), 20U) << scene;
  MotionPlannerConfig config;
  config.seed = seed;
  const MotionPlanner planner = MotionPlanner::create(arm, config).value();
  test::FclArm fcl{arm, obstacles};
  std::mt19937_64 random{seed};
  const auto any_of = [&](const std::vector<Configuration>& some) -> const Configuration& {
    return some[random() % some.size()];
  };
  const auto any_view = [&]() -> const std::vector<Configuration>& { return views[random() % views.size()]; };
  for (std::size_t i = 0; i < pairs; ++i) {
    Configuration start = any_view().front();
    std::vector<Configuration> goals = any_view();
    for (int draw = 0; i % kAnyEvery != 0 && draw < kDraws; ++draw) {
      start = any_of(any_view());
      goals = {any_of(any_view())};
      if (arm.motion_contact(start, goals.front(), obstacles)) break;
    }
    const Stopwatch stopwatch;
    const auto planned = planner.plan(start, goals, obstacles);
    const double ms = stopwatch.elapsed_ms();
    ASSERT_TRUE(planned.ok()) << planned.error().to_string();
    ++tally.pairs;
    if (!planned->plan) {
      EXPECT_EQ(planned->refusal, Refusal::no_path);
      EXPECT_FALSE(planned->why.empty());
      tally.out_of_time += planned->motions < config.max_motions ? 1 : 0;
      tally.search_ms.push_back(ms);
      continue;
    }
    ++tally.solved;
    const MotionPlan& plan = *planned->plan;
    const bool straight = plan.path.size() == 2 && planned->shortcut_ms == 0.0;
    (straight ? tally.straight : tally.searched) += 1;
    (straight ? tally.straight_ms : tally.search_ms).push_back(ms);
    tally.trajectory_s.push_back(plan.trajectory.duration_s());
    tally.stopping_s.push_back(rest_to_rest_s(arm.arm(), plan.path));
    ASSERT_EQ(plan.path.back(), goals[plan.goal]);
    tally.grazing_plans += planner.is_free(plan.trajectory, obstacles) ? 0 : 1;
    const std::size_t collisions = collisions_along(arm, fcl, plan.trajectory, tally);
    EXPECT_EQ(collisions, 0U) << scene << ", seed " << seed << ", pair " << i << (straight ? ", straight" : "");
    tally.collisions += collisions;
    tally.touching_plans += collisions > 0 ? 1 : 0;
  }
}

TEST(MotionPlanningParity, FclFindsNoCollisionAlongAnyTrajectory) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer takes Embree's threads for a race";
#endif
  const ArmCollision arm = ArmCollision::create(find_robot("comau_smart_six")->arm).value();
  const std::size_t pairs = seeds() > 1 ? 12 : 2;
  PlanTally tally;
  std::size_t scenes = 0;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (test::kSanitized && scenes == 1) break;
    ++scenes;
    for (int seed = 1; seed <= seeds(); ++seed) {
      plan_in(std::string{scene.name}, static_cast<std::uint64_t>(seed), pairs, arm, tally);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_EQ(tally.pairs, scenes * static_cast<std::size_t>(seeds()) * pairs);
  EXPECT_GE(10 * tally.solved, 9 * tally.pairs);
  EXPECT_GT(tally.searched, 0U);
  EXPECT_GT(tally.looked_at, 100 * tally.solved);
  EXPECT_EQ(tally.collisions, 0U);
  EXPECT_LE(100 * tally.grazing_plans, tally.solved);
  std::cout << "scenes " << scenes << ", seeds " << seeds() << ", pairs " << tally.pairs << ", solved " << tally.solved
            << ", straight " << tally.straight << ", searched " << tally.searched << ", out of time "
            << tally.out_of_time << '\n'
            << "configurations looked at " << tally.looked_at << ", collisions " << tally.collisions << " in "
            << tally.touching_plans << " plans; grazes by our own check " << tally.grazing_plans << '\n'
            << "straight: median ms " << quantile(tally.straight_ms, 0.5) << ", p90 ms "
            << quantile(tally.straight_ms, 0.9) << '\n'
            << "search: median ms " << quantile(tally.search_ms, 0.5) << ", p90 ms " << quantile(tally.search_ms, 0.9)
            << '\n'
            << "duration: median s " << quantile(tally.trajectory_s, 0.5) << ", with stops "
            << quantile(tally.stopping_s, 0.5) << '\n';
}

}  // namespace
}  // namespace saccade
