// SPDX-License-Identifier: Apache-2.0
// One seed gives one plan: for every planner, whatever was planned before, and while others plan. OMPL is silent.
#include <gtest/gtest.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <thread>

#include "saccade/arm/motion_planner.hpp"
#include "support/effort.hpp"
#include "support/sliding_arms.hpp"

namespace saccade {
namespace {

using test::joints;

const ArmCollision& bars() {
  static const ArmCollision arm = ArmCollision::create(test::three_bars(), {0.01, 0.01}).value();
  return arm;
}
const ObstacleMap& post() {
  static const ObstacleMap map = test::only({Box{{0.9, -0.1, -0.1}, {1.1, 0.1, 0.1}}});
  return map;
}

MotionPlanner planner_with(const std::string& name, std::uint64_t seed) {
  MotionPlannerConfig config;
  config.planner = name;
  config.seed = seed;
  config.budget_s = 600.0;
  config.shortcut_tries = 10;
  return MotionPlanner::create(bars(), config).value();
}

MotionPlan around_post(const std::string& name, std::uint64_t seed) {
  const Configuration goals[]{joints({-0.8, 0.0, 0.0}), joints({-0.8, 0.1, 0.1})};
  auto outcome = planner_with(name, seed).plan(joints({0.8, 0.0, 0.0}), goals, post());
  SACCADE_EXPECTS(outcome.ok() && outcome->plan && outcome->shortcut_ms > 0.0);
  return *outcome->plan;
}

void expect_same_plan(const MotionPlan& a, const MotionPlan& b) {
  EXPECT_EQ(a.goal, b.goal);
  EXPECT_EQ(a.path, b.path);
  EXPECT_EQ(a.trajectory.duration_s(), b.trajectory.duration_s());
}

TEST(MotionPlanningProperty, OneSeedGivesOnePlanWhateverWasPlannedBefore) {
  const std::vector<std::string> names = planner_names();
  ASSERT_EQ(names.size(), 10U);
  std::vector<MotionPlan> first;
  for (const std::string& name : names) first.push_back(around_post(name, 5));
  for (std::size_t i = 0; i < names.size(); ++i) {
    SCOPED_TRACE(names[i]);
    const ompl::RNG drawn;  // by the program itself
    static_cast<void>(around_post(names[(i + 3) % names.size()], 99 + i));
    expect_same_plan(around_post(names[i], 5), first[i]);
  }
}

TEST(MotionPlanningProperty, OneSeedGivesOnePlanWhileOthersPlan) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer does not see the reference counts inside OMPL's library";
#endif
  const std::vector<std::string> names = planner_names();
  const std::size_t rounds = static_cast<std::size_t>(test::kSanitized ? 1 : 2);
  const std::size_t planners = test::kSanitized ? 3 : names.size();
  std::vector<MotionPlan> alone;
  for (std::size_t i = 0; i < planners; ++i) alone.push_back(around_post(names[i], 7));
  std::vector<std::vector<MotionPlan>> together(4);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < together.size(); ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < planners; ++i) together[t].push_back(around_post(names[(i + t) % planners], 7));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::size_t compared = 0;
  for (std::size_t t = 0; t < together.size(); ++t) {
    for (std::size_t k = 0; k < together[t].size(); ++k, ++compared) {
      SCOPED_TRACE(names[(k % planners + t) % planners]);
      expect_same_plan(together[t][k], alone[(k % planners + t) % planners]);
    }
  }
  EXPECT_EQ(compared, together.size() * rounds * planners);
}

class Listening final : public ompl::msg::OutputHandler {
 public:
  void log(const std::string& text, ompl::msg::LogLevel, const char*, int) override { heard.push_back(text); }
  std::vector<std::string> heard;
};

TEST(MotionPlanningProperty, OmplIsSilentAndItsHandlerComesBack) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer does not see the reference counts inside OMPL's library";
#endif
  const ompl::msg::LogLevel level = ompl::msg::getLogLevel();
  ompl::msg::setLogLevel(ompl::msg::LOG_DEV2);
  ompl::msg::OutputHandler* const usual = ompl::msg::getOutputHandler();
  Listening listening;
  for (ompl::msg::OutputHandler* handler : {static_cast<ompl::msg::OutputHandler*>(&listening), usual}) {
    ompl::msg::useOutputHandler(handler);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    std::vector<std::thread> threads;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      threads.emplace_back([seed] { static_cast<void>(around_post("RRTConnect", seed)); });
    }
    static_cast<void>(around_post("KPIECE1", 1));
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(ompl::msg::getOutputHandler(), handler);
  }
  EXPECT_TRUE(listening.heard.empty());
  ompl::msg::noOutputHandler();
  static_cast<void>(around_post("RRTConnect", 1));
  EXPECT_EQ(ompl::msg::getOutputHandler(), nullptr);
  ompl::msg::useOutputHandler(usual);
  ompl::msg::setLogLevel(level);
}

}  // namespace
}  // namespace saccade
