// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/motion_planner.hpp"

#include <gtest/gtest.h>

#include <set>

#include "saccade/core/clock.hpp"
#include "support/effort.hpp"
#include "support/sliding_arms.hpp"
#include "support/trajectory_checks.hpp"

namespace saccade {
namespace {

using test::joints;
using test::only;

/// A post that the stretched arm cannot swing past.
ObstacleMap post() { return only({Box{{0.9, -0.1, -0.1}, {1.1, 0.1, 0.1}}}); }

/// Two plates beside the first bar where it points along x: it cannot turn away.
ObstacleMap plates() {
  return only({Box{{0.25, 0.06, -0.1}, {0.45, 0.1, 0.1}}, Box{{0.25, -0.1, -0.1}, {0.45, -0.06, 0.1}}});
}

const ArmCollision& bar_collision() {
  static const ArmCollision arm = ArmCollision::create(test::three_bars()).value();
  return arm;
}

const Configuration kLeft{joints({0.8, 0.0, 0.0})};
const Configuration kRight{joints({-0.8, 0.0, 0.0})};

MotionPlanner planner_with(const MotionPlannerConfig& config = {}, const ArmCollision& arm = bar_collision()) {
  return MotionPlanner::create(arm, config).value();
}

Result<PlanOutcome> plan_to(const MotionPlanner& planner, const Configuration& start, const Configuration& goal,
                            const ObstacleMap& obstacles) {
  return planner.plan(start, std::span{&goal, 1}, obstacles);
}

/// The plan's ends, its lines, its times, and every configuration on its way.
void expect_good(const MotionPlanner& planner, const Configuration& start, std::span<const Configuration> goals,
                 const ObstacleMap& obstacles, const PlanOutcome& outcome) {
  ASSERT_TRUE(outcome.plan) << outcome.why;
  EXPECT_FALSE(outcome.refusal);
  EXPECT_TRUE(outcome.why.empty());
  const ArmCollision& arm = planner.collision();
  const MotionPlan& plan = *outcome.plan;
  ASSERT_LT(plan.goal, goals.size());
  EXPECT_EQ(plan.path.front(), start);
  EXPECT_EQ(plan.path.back(), goals[plan.goal]);
  test::expect_sound(arm.arm(), plan.path, plan.trajectory);
  EXPECT_LE(plan.trajectory.duration_s(), rest_to_rest_s(arm.arm(), plan.path) + 1e-9);
  for (std::size_t i = 0; i + 1 < plan.path.size(); ++i) {
    EXPECT_FALSE(arm.motion_contact(plan.path[i], plan.path[i + 1], obstacles)) << "line " << i;
  }
  EXPECT_TRUE(planner.is_free(plan.trajectory, obstacles));
  for (double t_s = 0.0; t_s < plan.trajectory.duration_s(); t_s += 1e-3) {
    const Configuration q = plan.trajectory.at(t_s).q;
    ASSERT_FALSE(arm.contact(q, obstacles)) << "at " << t_s << " s of " << plan.trajectory.duration_s();
    ASSERT_TRUE(arm.arm().within_limits(q, 1e-9)) << "at " << t_s << " s";
  }
}

TEST(MotionPlanner, GoesStraightWhereThatIsFree) {
  const MotionPlanner planner = planner_with();
  const auto outcome = plan_to(planner, kLeft, kRight, only({}));
  ASSERT_TRUE(outcome.ok());
  expect_good(planner, kLeft, std::span{&kRight, 1}, only({}), *outcome);
  EXPECT_EQ(outcome->plan->path.size(), 2U);
  EXPECT_EQ(outcome->motions, 1);
  EXPECT_NEAR(outcome->plan->trajectory.duration_s(), rest_to_rest_s(bar_collision().arm(), kLeft, kRight), 1e-12);
}

TEST(MotionPlanner, GoesAroundWhatIsInTheWay) {
  const MotionPlanner planner = planner_with();
  const auto straight = planner.plan_straight(kLeft, std::span{&kRight, 1}, post());
  ASSERT_TRUE(straight.ok());
  EXPECT_FALSE(straight->plan);
  EXPECT_EQ(straight->refusal, Refusal::no_path);
  EXPECT_EQ(straight->why, "no straight motion to any goal is free");
  const auto outcome = plan_to(planner, kLeft, kRight, post());
  ASSERT_TRUE(outcome.ok());
  expect_good(planner, kLeft, std::span{&kRight, 1}, post(), *outcome);
  EXPECT_GT(outcome->plan->path.size(), 2U);
  EXPECT_GT(outcome->motions, 1);
}

TEST(MotionPlanner, StandsWhereItShallGo) {
  const MotionPlanner planner = planner_with();
  const auto outcome = plan_to(planner, kLeft, kLeft, post());
  ASSERT_TRUE(outcome.ok());
  ASSERT_TRUE(outcome->plan);
  EXPECT_EQ(outcome->plan->trajectory.duration_s(), 0.0);
  EXPECT_EQ(outcome->plan->trajectory.end(), kLeft);
}

TEST(MotionPlanner, SaysWhatIsWrongWithStartAndGoals) {
  const MotionPlanner planner = planner_with();
  const Configuration in_post = joints({0.0, 0.0, 0.0});
  const Configuration beyond = joints({0.8, 3.1, 0.0});
  struct Row {
    Configuration start;
    std::vector<Configuration> goals;
    Refusal refusal;
    std::string why;
  };
  const Row rows[]{
      {beyond, {kRight}, Refusal::outside_limits, "a joint of the start is outside its limits"},
      {in_post, {kRight}, Refusal::start_in_collision, "at the start link \"bar_3\" touches an obstacle"},
      {kLeft, {beyond, beyond}, Refusal::outside_limits, "every goal has a joint outside its limits"},
      {kLeft, {in_post}, Refusal::goal_in_collision, "at the last of the goals link \"bar_3\" touches an obstacle"},
      {kLeft,
       {beyond, in_post},
       Refusal::goal_in_collision,
       "at the last of the goals link \"bar_3\" touches an obstacle"},
      {joints({1.5, 2.2, 2.2}),
       {kRight},
       Refusal::start_in_collision,
       "at the start link \"bar_3\" touches link \"bar_1\""}};
  for (const Row& row : rows) {
    for (const bool straight : {false, true}) {
      const auto outcome =
          straight ? planner.plan_straight(row.start, row.goals, post()) : planner.plan(row.start, row.goals, post());
      ASSERT_TRUE(outcome.ok());
      EXPECT_FALSE(outcome->plan);
      EXPECT_EQ(outcome->refusal, row.refusal) << row.why;
      EXPECT_EQ(outcome->why, row.why);
      EXPECT_EQ(outcome->motions, 0);
    }
  }
}

TEST(MotionPlanner, AsksForNumbersAsManyAsJoints) {
  const MotionPlanner planner = planner_with();
  Configuration bad = kLeft;
  bad[1] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<Configuration, std::vector<Configuration>>> cases{{joints({0.0, 0.0}), {kRight}},
                                                                                {kLeft, {kRight, joints({0, 0, 0, 0})}},
                                                                                {kLeft, {}},
                                                                                {bad, {kRight}},
                                                                                {kLeft, {kRight, bad}},
                                                                                {Configuration{}, {kRight}}};
  for (const auto& [start, goals] : cases) {
    for (const auto& outcome : {planner.plan(start, goals, post()), planner.plan_straight(start, goals, post())}) {
      ASSERT_FALSE(outcome.ok());
      EXPECT_EQ(outcome.error().code, Errc::invalid_argument);
      EXPECT_NE(outcome.error().to_string().find("3 numbers"), std::string::npos) << outcome.error().to_string();
    }
  }
}

TEST(MotionPlanner, AStartOnALimitButForRoundingWillDo) {
  const MotionPlanner planner = planner_with();
  const Configuration limit = joints({3.0, 0.5, -0.5});
  const Configuration beyond = joints({3.0 + 1e-12, 0.5, -0.5});
  const Configuration goal = joints({-2.9, 0.5, -0.5});
  for (const Configuration& start : {limit, beyond}) {
    const auto outcome = plan_to(planner, start, goal, post());
    ASSERT_TRUE(outcome.ok());
    expect_good(planner, start, std::span{&goal, 1}, post(), *outcome);
  }
}

TEST(MotionPlanner, GoesToTheNearestGoalThatIsFree) {
  const MotionPlanner planner = planner_with();
  const Configuration in_post = joints({0.0, 0.0, 0.0});
  const std::vector<Configuration> goals{joints({2.5, 0.0, 0.0}), joints({0.8, 3.5, 0.0}),  in_post,
                                         joints({1.2, 0.1, 0.0}), joints({-0.8, 0.0, 0.0}), joints({1.2, 0.1, 0.0})};
  const auto outcome = planner.plan(kLeft, goals, post());
  ASSERT_TRUE(outcome.ok());
  expect_good(planner, kLeft, goals, post(), *outcome);
  EXPECT_EQ(outcome->plan->goal, 3U);
  // Some cannot be gone to straight: another is.
  const std::vector<Configuration> beyond_post{kRight, joints({2.9, 0.0, 0.0})};
  const auto farther = planner.plan(kLeft, beyond_post, post());
  ASSERT_TRUE(farther.ok());
  expect_good(planner, kLeft, beyond_post, post(), *farther);
  EXPECT_EQ(farther->plan->goal, 1U);
  // None can: a search finds one of them.
  const std::vector<Configuration> two{in_post, kRight, joints({-0.9, 0.2, 0.0})};
  const auto searched = planner.plan(kLeft, two, post());
  ASSERT_TRUE(searched.ok());
  expect_good(planner, kLeft, two, post(), *searched);
  EXPECT_GE(searched->plan->goal, 1U);
}

TEST(MotionPlanner, EveryPlannerGoesAroundAndGivesUp) {
  const Configuration inside = joints({0.0, 1.0, 1.0});
  ASSERT_FALSE(bar_collision().contact(inside, plates()));
  for (const std::string& name : planner_names()) {
    SCOPED_TRACE(name);
    MotionPlannerConfig config;
    config.planner = name;
    config.budget_s = 60.0;
    const MotionPlanner planner = planner_with(config);
    const auto outcome = plan_to(planner, kLeft, kRight, post());
    ASSERT_TRUE(outcome.ok());
    expect_good(planner, kLeft, std::span{&kRight, 1}, post(), *outcome);
    // No way leads in: it ends by its effort.
    config.max_motions = test::kSanitized ? 100 : 300;
    const MotionPlanner limited = planner_with(config);
    const Stopwatch stopwatch;
    const auto none = plan_to(limited, kLeft, inside, plates());
    ASSERT_TRUE(none.ok());
    EXPECT_FALSE(none->plan);
    EXPECT_EQ(none->refusal, Refusal::no_path);
    EXPECT_EQ(none->why.rfind("no path was found among ", 0), 0U) << none->why;
    EXPECT_LE(none->motions, 2 * config.max_motions);
    EXPECT_LT(stopwatch.elapsed_ms(), 20e3);
    // And out.
    const auto back = plan_to(limited, inside, kLeft, plates());
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(back->refusal, Refusal::no_path);
    EXPECT_EQ(back->why.rfind("no path was found among ", 0), 0U) << back->why;
    if (HasFatalFailure()) return;
  }
}

TEST(MotionPlanner, GoalsCountAsEffort) {
  MotionPlannerConfig config;
  config.max_motions = 50;
  const MotionPlanner planner = planner_with(config);
  std::vector<Configuration> goals;
  for (int i = 0; i < 200; ++i) goals.push_back(joints({-0.8 - 0.001 * i, 0.0, 0.0}));
  const auto outcome = planner.plan(kLeft, goals, post());
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome->refusal, Refusal::no_path);
  EXPECT_EQ(outcome->why, "no straight motion to any goal is free");
  EXPECT_EQ(outcome->motions, 50);
  config.max_motions = 5000;
  const auto patient = planner_with(config).plan(kLeft, goals, post());
  ASSERT_TRUE(patient.ok());
  expect_good(planner, kLeft, goals, post(), *patient);
  EXPECT_GT(patient->motions, 200);
}

TEST(MotionPlanner, TimeEndsASearchToo) {
  MotionPlannerConfig config;
  config.budget_s = 0.02;
  config.max_motions = 1000000000;
  const auto outcome = plan_to(planner_with(config), kLeft, joints({0.0, 1.0, 1.0}), plates());
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome->refusal, Refusal::no_path);
  EXPECT_EQ(outcome->why, "no path was found within the time of a search");
  EXPECT_LT(outcome->search_ms, 5000.0);
}

TEST(MotionPlanner, OtherSeedsFindOtherWays) {
  std::set<double> durations;
  for (std::uint64_t seed : {0U, 1U, 2U, 3U, 4U}) {
    MotionPlannerConfig config;
    config.seed = seed;
    const MotionPlanner planner = planner_with(config);
    const auto outcome = plan_to(planner, kLeft, kRight, post());
    ASSERT_TRUE(outcome.ok());
    expect_good(planner, kLeft, std::span{&kRight, 1}, post(), *outcome);
    durations.insert(outcome->plan->trajectory.duration_s());
  }
  EXPECT_GT(durations.size(), 1U);
}

TEST(MotionPlanner, JointsMayTurnWithoutEndOrSlide) {
  const ArmCollision endless =
      ArmCollision::create(test::plane_arm({JointKind::continuous, JointKind::revolute, JointKind::revolute})).value();
  const MotionPlanner turning = planner_with({}, endless);
  for (const double turns_rad : {0.0, 4.0 * std::numbers::pi, -8.0 * std::numbers::pi}) {
    const Configuration goal = joints({-0.8 + turns_rad, 0.0, 0.0});
    const auto outcome = plan_to(turning, kLeft, goal, post());
    ASSERT_TRUE(outcome.ok());
    expect_good(turning, kLeft, std::span{&goal, 1}, post(), *outcome);
    const Configuration from = joints({0.8 - turns_rad, 0.0, 0.0});
    const auto back = plan_to(turning, from, kRight, post());
    ASSERT_TRUE(back.ok());
    expect_good(turning, from, std::span{&kRight, 1}, post(), *back);
  }
  const ArmCollision rail =
      ArmCollision::create(test::plane_arm({JointKind::prismatic, JointKind::revolute, JointKind::revolute})).value();
  const MotionPlanner sliding = planner_with({}, rail);
  // The second bar swings past a box only where the rail is drawn back.
  const ObstacleMap box = only({Box{{1.15, -0.1, -0.1}, {1.25, 0.1, 0.1}}});
  const Configuration start = joints({0.3, 0.9, 0.5});
  const Configuration goal = joints({0.3, -0.9, -0.5});
  const auto outcome = plan_to(sliding, start, goal, box);
  ASSERT_TRUE(outcome.ok());
  expect_good(sliding, start, std::span{&goal, 1}, box, *outcome);
  EXPECT_GT(outcome->plan->path.size(), 2U);
}

TEST(MotionPlanner, KnowsBadSettings) {
  const auto message = [](const std::function<void(MotionPlannerConfig&)>& change) {
    MotionPlannerConfig config;
    change(config);
    const auto planner = MotionPlanner::create(bar_collision(), config);
    return planner.ok() ? std::string{} : planner.error().to_string();
  };
  EXPECT_EQ(message([](auto&) {}), "");
  EXPECT_NE(message([](auto& c) { c.planner = "rrt"; }).find("there is no planner \"rrt\"; known: RRTConnect, RRT,"),
            std::string::npos);
  EXPECT_NE(message([](auto& c) { c.max_motions = 0; }).find("one motion"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.budget_s = 0.0; }).find("time"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.budget_s = std::nan(""); }).find("time"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.shortcut_tries = -1; }).find("shortcuts"), std::string::npos);
  EXPECT_EQ(message([](auto& c) { c.budget_s = std::numeric_limits<double>::infinity(); }), "");
  EXPECT_EQ(message([](auto& c) { c.seed = ~std::uint64_t{0}; }), "");
}

TEST(MotionPlanner, TrajectoriesAreCheckedAlongTheWay) {
  const MotionPlanner planner = planner_with();
  const Trajectory across = parametrise(bar_collision().arm(), {kLeft, kRight});
  EXPECT_TRUE(planner.is_free(across, only({})));
  EXPECT_FALSE(planner.is_free(across, post()));
  const Trajectory far = parametrise(bar_collision().arm(), {kLeft, joints({3.5, 0.0, 0.0})});
  EXPECT_FALSE(planner.is_free(far, only({})));  // beyond a limit
  // A plate that the thin hand passes in a few milliseconds.
  EXPECT_FALSE(planner.is_free(across, only({Box{{1.2, -0.01, -0.1}, {1.4, 0.01, 0.1}}})));
  EXPECT_TRUE(planner.is_free(parametrise(bar_collision().arm(), {kLeft}), post()));
}

}  // namespace
}  // namespace saccade
