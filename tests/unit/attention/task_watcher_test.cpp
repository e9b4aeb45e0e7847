// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/task_watcher.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace saccade {
namespace {

HandRecorderConfig unit_box() {
  HandRecorderConfig config;
  config.workspace = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
  return config;
}

/// Puts one action where a trajectory is in its middle.
Result<std::vector<HandAction>> middle_of(const HandTrajectory& trajectory) {
  const HandSample& middle = trajectory[trajectory.size() / 2];
  return std::vector<HandAction>{{middle.position_m, middle.time_s, 1.0, "the middle"}};
}

/// A hand that comes into the box along x and leaves it, each time at another y; between, it is outside or not seen.
HandTrajectory visits(int count, bool seen_outside) {
  HandTrajectory samples;
  double time_s = 0.0;
  for (int visit = 0; visit < count; ++visit) {
    for (int i = -150; i <= 150; ++i) {
      const double x = 0.5 + 0.01 * i;
      const bool inside = x >= 0.0 && x <= 1.0;
      const double nowhere = std::numeric_limits<double>::quiet_NaN();
      samples.push_back({time_s += 0.01, {inside || seen_outside ? x : nowhere, 0.2 + 0.2 * visit, 0.5}, std::nullopt});
    }
  }
  return samples;
}

std::unique_ptr<HandTracker> recorded(HandTrajectory samples) {
  return std::make_unique<RecordedHand>(std::move(samples));
}

TEST(TaskWatcher, EachVisitOfTheHandIsATask) {
  for (const bool seen_outside : {true, false}) {
    std::atomic<int> entered{0};
    const auto watcher =
        TaskWatcher::create(recorded(visits(3, seen_outside)), unit_box(), middle_of, 0.2, [&] { ++entered; }).value();
    for (int visit = 0; visit < 3; ++visit) {
      const auto task = watcher->next_task();
      ASSERT_TRUE(task.ok() && *task) << visit;
      EXPECT_GE((*task)->trajectory.size(), 95U);
      ASSERT_EQ((*task)->regions.size(), 1U);
      const auto& ball = std::get<Sphere>((*task)->regions.front().bounds);
      EXPECT_LT((ball.center - Eigen::Vector3d{0.5, 0.2 + 0.2 * visit, 0.5}).norm(), 0.03);
      EXPECT_EQ(ball.radius_m, 0.2);
    }
    EXPECT_FALSE(watcher->next_task().value());
    EXPECT_FALSE(watcher->next_task().value());
    EXPECT_FALSE(watcher->hand_inside());
    EXPECT_EQ(entered, 3);
  }
}

/// A hand that comes into the box and stays there.
class StayingHand final : public HandTracker {
 public:
  [[nodiscard]] Result<std::optional<HandSample>> next() override {
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
    return std::optional{HandSample{time_s_ += 0.01, {0.5, 0.5, 0.5}, std::nullopt}};
  }

 private:
  double time_s_{0.0};
};

TEST(TaskWatcher, TellsThatTheHandIsInsideWhileTheCallerDoesSomethingElse) {
  std::atomic<bool> entered{false};
  const auto watcher =
      TaskWatcher::create(std::make_unique<StayingHand>(), unit_box(), middle_of, 0.2, [&] { entered = true; }).value();
  for (int i = 0; i < 5000 && !entered; ++i) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  EXPECT_TRUE(entered);
  EXPECT_TRUE(watcher->hand_inside());
  Progress cancelled;
  cancelled.request_cancel();
  EXPECT_FALSE(watcher->next_task(&cancelled).value());
}

TEST(TaskWatcher, ErrorsOfTrackerAndDetectorArePassedOn) {
  class Broken final : public HandTracker {
   public:
    [[nodiscard]] Result<std::optional<HandSample>> next() override {
      return Error{Errc::unavailable, "the tracker is unplugged", "hand"};
    }
  };
  const auto broken = TaskWatcher::create(std::make_unique<Broken>(), unit_box(), middle_of).value();
  EXPECT_EQ(broken->next_task().error().message, "the tracker is unplugged");
  EXPECT_EQ(broken->next_task().error().message, "the tracker is unplugged");
  const auto failing = TaskWatcher::create(recorded(visits(1, true)), unit_box(),
                                           [](const HandTrajectory&) -> Result<std::vector<HandAction>> {
                                             return Error{Errc::invalid_argument, "too short", "detector"};
                                           })
                           .value();
  EXPECT_EQ(failing->next_task().error().message, "too short");
  EXPECT_FALSE(TaskWatcher::create(recorded({}), unit_box(), middle_of, 0.0).ok());
  EXPECT_FALSE(TaskWatcher::create(recorded({}), HandRecorderConfig{}, middle_of).ok());
}

}  // namespace
}  // namespace saccade
