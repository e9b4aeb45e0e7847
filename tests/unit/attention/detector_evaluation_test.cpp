// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/detector_evaluation.hpp"

#include <gtest/gtest.h>

#include "saccade/trial/simulated_task.hpp"

namespace saccade {
namespace {

HandAction action_at(double x_m) { return {{x_m, 0.0, 0.0}, 0.0, 1.0, {}}; }
Eigen::Vector3d label_at(double x_m) { return {x_m, 0.0, 0.0}; }

TEST(DetectorEvaluation, ScoresByDistance) {
  const std::vector<HandAction> actions{action_at(0.1), action_at(-0.05), action_at(0.95), action_at(5.0)};
  const std::vector<Eigen::Vector3d> labels{label_at(0.0), label_at(1.0), label_at(2.0)};
  const TrajectoryScore scored = score(actions, labels);
  EXPECT_EQ(scored.counts.labels, 3U);
  EXPECT_EQ(scored.counts.true_positives, 2U);
  EXPECT_EQ(scored.counts.false_positives, 1U);
  EXPECT_EQ(scored.counts.false_negatives(), 1U);
  EXPECT_DOUBLE_EQ(scored.counts.precision().value(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(scored.counts.recall().value(), 2.0 / 3.0);
  ASSERT_EQ(scored.location_errors_m.size(), 2U);
  EXPECT_DOUBLE_EQ(scored.location_errors_m[0], 0.05);
  EXPECT_NEAR(scored.location_errors_m[1], 0.05, 1e-12);

  const TrajectoryScore close = score(actions, labels, 0.04);
  EXPECT_EQ(close.counts.true_positives, 0U);
  EXPECT_EQ(close.counts.false_positives, 4U);
  EXPECT_FALSE(score({}, {}).counts.precision().has_value());
  EXPECT_FALSE(score({}, {}).counts.recall().has_value());
  EXPECT_EQ(score({}, labels).counts.recall(), 0.0);
}

std::vector<LabelledTrajectory> made_up_set(std::size_t count) {
  std::vector<LabelledTrajectory> set;
  for (std::size_t i = 0; i < count; ++i) {
    SyntheticTask task = synthetic_task(i);
    set.push_back({"task " + std::to_string(i), std::move(task.trajectory), std::move(task.actions_m)});
  }
  return set;
}

TEST(DetectorEvaluation, MislabelledIsFarFromEverySample) {
  LabelledTrajectory labelled = made_up_set(1).front();
  EXPECT_FALSE(is_mislabelled(labelled));
  labelled.labels_m.push_back(labelled.trajectory.front().position_m + Eigen::Vector3d{0.0, -0.21, 0.0});
  EXPECT_TRUE(is_mislabelled(labelled));
  EXPECT_FALSE(is_mislabelled(labelled, 0.3));
  labelled.labels_m.clear();
  EXPECT_FALSE(is_mislabelled(labelled));
}

TEST(DetectorEvaluation, AddsUpOverTrajectoriesAndLeavesOutTheMislabelled) {
  std::vector<LabelledTrajectory> set = made_up_set(5);
  set[3].labels_m.front() = {9.0, 9.0, 9.0};
  std::size_t next{0};
  const HandActionDetector perfect = [&](const HandTrajectory&) -> Result<std::vector<HandAction>> {
    std::vector<HandAction> actions;
    for (const Eigen::Vector3d& label : set[next].labels_m) actions.push_back({label, 0.0, 1.0, {}});
    next = next == 2 ? 4 : next + 1;
    return actions;
  };
  const DetectorEvaluation result = evaluate_detector(perfect, set, {.exclude_mislabelled = true}).value();
  EXPECT_EQ(result.trajectories, 4U);
  EXPECT_EQ(result.excluded, 1U);
  EXPECT_EQ(result.counts.labels, 8U);
  EXPECT_EQ(result.counts.true_positives, 8U);
  EXPECT_EQ(result.counts.false_positives, 0U);
  EXPECT_EQ(result.ms.size(), 4U);
  EXPECT_EQ(result.median_location_error_m(), 0.0);
  DetectorEvaluation twice = result;
  twice += result;
  EXPECT_EQ(twice.trajectories, 8U);
  EXPECT_EQ(twice.counts.labels, 16U);
  EXPECT_EQ(twice.location_errors_m.size(), 16U);
  EXPECT_FALSE(DetectorEvaluation{}.median_ms().has_value());
}

/// Returns the input of detectors under some conditions.
std::vector<HandTrajectory> given_under(const EvaluationConditions& conditions) {
  std::vector<HandTrajectory> given;
  const auto set = made_up_set(2);
  const auto result = evaluate_detector(
      [&](const HandTrajectory& trajectory) -> Result<std::vector<HandAction>> {
        given.push_back(trajectory);
        return std::vector<HandAction>{};
      },
      set, conditions);
  EXPECT_TRUE(result.ok());
  return given;
}

TEST(DetectorEvaluation, NoiseComesAfterTheSpeedAndDiffersBetweenSeedsAndTrajectories) {
  const auto clean = given_under({.speed = 0.5});
  const auto noisy = given_under({.speed = 0.5, .sigma_m = 0.05});
  const auto again = given_under({.speed = 0.5, .sigma_m = 0.05});
  const auto other = given_under({.speed = 0.5, .sigma_m = 0.05, .seed = 2});
  const HandTrajectory original = synthetic_task(0).trajectory;
  ASSERT_EQ(noisy.size(), 2U);
  EXPECT_NEAR(static_cast<double>(noisy[0].size()), 0.5 * static_cast<double>(original.size()), 1.0);
  const auto noise = [&](const std::vector<HandTrajectory>& set, std::size_t i, std::size_t sample) {
    return Eigen::Vector3d{set[i][sample].position_m - clean[i][sample].position_m};
  };
  EXPECT_EQ(noise(noisy, 0, 9), noise(again, 0, 9));
  EXPECT_NE(noise(noisy, 0, 9), noise(other, 0, 9));
  EXPECT_GT((noise(noisy, 0, 9) - noise(noisy, 1, 9)).norm(), 1e-3);
}

TEST(DetectorEvaluation, ErrorsNameTheTrajectory) {
  const auto set = made_up_set(1);
  const auto failed = evaluate_detector(
      [](const HandTrajectory&) -> Result<std::vector<HandAction>> {
        return Error{Errc::invalid_argument, "no", "sample 3"};
      },
      set);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().to_string(), "task 0, sample 3: no");
  const HandActionDetector none = [](const HandTrajectory&) -> Result<std::vector<HandAction>> {
    return std::vector<HandAction>{};
  };
  EXPECT_FALSE(evaluate_detector(none, set, {.speed = 0.0}));
  EXPECT_FALSE(evaluate_detector(none, set, {.sigma_m = -1.0}));
  EXPECT_FALSE(evaluate_detector(none, set, {.match_radius_m = 0.0}));
}

}  // namespace
}  // namespace saccade
