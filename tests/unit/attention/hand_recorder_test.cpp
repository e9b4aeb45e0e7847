// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/hand_recorder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace saccade {
namespace {

constexpr double kStep_s{0.01};

HandRecorder unit_box_recorder() {
  HandRecorderConfig config;
  config.workspace = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
  return HandRecorder::create(config).value();
}

/// A stream of a hand that is told where to be, at 100 Hz.
class HandStream {
 public:
  explicit HandStream(HandRecorder& recorder) : recorder_{recorder} {}

  void stay(double x_m, double duration_s) {
    const auto samples = std::lround(duration_s / kStep_s);
    for (int i = 0; i < samples; ++i) push(x_m);
  }
  void push(double x_m) {
    time_s_ += kStep_s;
    if (auto task = recorder_.push({time_s_, {x_m, 0.5, 0.5}, std::nullopt})) tasks.push_back(std::move(*task));
  }
  void be_silent(double duration_s) { time_s_ += duration_s; }
  void finish() {
    if (auto task = recorder_.finish()) tasks.push_back(std::move(*task));
  }

  std::vector<HandTrajectory> tasks;

 private:
  HandRecorder& recorder_;
  double time_s_{0.0};
};

TEST(HandRecorder, ATaskGoesFromEnteringToLeaving) {
  HandRecorder recorder = unit_box_recorder();
  HandStream stream{recorder};
  stream.stay(-0.5, 1.0);
  EXPECT_TRUE(recorder.under_way().empty());
  stream.stay(0.5, 2.0);
  EXPECT_EQ(recorder.under_way().size(), 200U);
  stream.stay(1.5, 1.0);
  ASSERT_EQ(stream.tasks.size(), 1U);
  EXPECT_EQ(stream.tasks[0].size(), 200U);
  EXPECT_NEAR(stream.tasks[0].front().time_s, 1.01, 1e-9);
  EXPECT_NEAR(stream.tasks[0].back().time_s, 3.0, 1e-9);
  stream.finish();
  EXPECT_EQ(stream.tasks.size(), 1U);
}

TEST(HandRecorder, TheBorderHasAMarginOnceTheHandIsIn) {
  HandRecorder recorder = unit_box_recorder();
  HandStream stream{recorder};
  stream.stay(-0.01, 1.0);
  EXPECT_TRUE(recorder.under_way().empty());
  stream.stay(0.01, 1.0);
  stream.stay(-0.01, 1.0);
  stream.stay(-0.03, 1.0);
  ASSERT_EQ(stream.tasks.size(), 1U);
  EXPECT_EQ(stream.tasks[0].size(), 200U);
}

TEST(HandRecorder, ShortDropoutsAndExcursionsBelongToTheTask) {
  HandRecorder recorder = unit_box_recorder();
  HandStream stream{recorder};
  stream.stay(0.5, 1.0);
  stream.stay(1.5, 0.4);
  stream.stay(0.5, 1.0);
  stream.be_silent(0.4);
  stream.stay(std::nan(""), 0.05);
  stream.stay(0.5, 1.0);
  EXPECT_TRUE(stream.tasks.empty());
  stream.finish();
  ASSERT_EQ(stream.tasks.size(), 1U);
  EXPECT_EQ(stream.tasks[0].size(), 340U);
  EXPECT_EQ(recorder.bad_samples(), 5U);
}

TEST(HandRecorder, LongSilenceEndsATaskAndTheNextSampleBeginsAnother) {
  HandRecorder recorder = unit_box_recorder();
  HandStream stream{recorder};
  stream.stay(0.5, 1.0);
  stream.be_silent(0.6);
  stream.stay(0.5, 1.0);
  stream.finish();
  ASSERT_EQ(stream.tasks.size(), 2U);
  EXPECT_EQ(stream.tasks[0].size(), 100U);
  EXPECT_EQ(stream.tasks[1].size(), 100U);
}

TEST(HandRecorder, SamplesBackInTimeAreLeftOut) {
  HandRecorder recorder = unit_box_recorder();
  EXPECT_FALSE(recorder.push({1.0, {0.5, 0.5, 0.5}, std::nullopt}));
  EXPECT_FALSE(recorder.push({1.0, {0.6, 0.5, 0.5}, std::nullopt}));
  EXPECT_FALSE(recorder.push({0.9, {0.6, 0.5, 0.5}, std::nullopt}));
  EXPECT_FALSE(recorder.push({HUGE_VAL, {0.6, 0.5, 0.5}, std::nullopt}));
  EXPECT_FALSE(recorder.push({1.1, {0.7, 0.5, 0.5}, std::nullopt}));
  EXPECT_EQ(recorder.bad_samples(), 3U);
  const auto task = recorder.finish();
  ASSERT_TRUE(task.has_value());
  EXPECT_EQ(task->size(), 2U);
}

TEST(HandRecorder, BrushingTheBorderIsNoTaskAndLongTasksAreCut) {
  HandRecorderConfig config;
  config.workspace = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
  config.min_samples = 10;
  config.max_samples = 50;
  HandRecorder recorder = HandRecorder::create(config).value();
  HandStream stream{recorder};
  stream.stay(0.5, 0.09);
  stream.stay(1.5, 1.0);
  EXPECT_TRUE(stream.tasks.empty());
  stream.stay(0.5, 1.2);
  stream.finish();
  ASSERT_EQ(stream.tasks.size(), 3U);
  EXPECT_EQ(stream.tasks[0].size(), 50U);
  EXPECT_EQ(stream.tasks[1].size(), 50U);
  EXPECT_EQ(stream.tasks[2].size(), 20U);
}

TEST(HandRecorder, ATaskEndsSoonAfterTheHandIsNotSeenAnyMore) {
  HandRecorder recorder = unit_box_recorder();
  HandStream stream{recorder};
  stream.stay(0.5, 1.0);
  stream.stay(std::nan(""), 0.45);  // a glove that hides its marker for a moment
  EXPECT_TRUE(stream.tasks.empty());
  stream.stay(0.5, 0.5);
  stream.stay(std::nan(""), 0.6);
  ASSERT_EQ(stream.tasks.size(), 1U);
  EXPECT_EQ(stream.tasks[0].size(), 150U);
  EXPECT_TRUE(recorder.under_way().empty());
}

TEST(HandRecorder, BadConfigurationsAreRefused) {
  HandRecorderConfig config;
  EXPECT_FALSE(HandRecorder::create(config));  // no workspace
  config.workspace = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
  EXPECT_TRUE(HandRecorder::create(config));
  config.margin_m = -0.1;
  EXPECT_FALSE(HandRecorder::create(config));
  config.margin_m = 0.0;
  config.dropout_s = std::nan("");
  EXPECT_FALSE(HandRecorder::create(config));
}

}  // namespace
}  // namespace saccade
