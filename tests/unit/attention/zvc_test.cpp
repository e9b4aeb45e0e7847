// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/zvc.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/trial/simulated_task.hpp"

namespace saccade {
namespace {

/// Eq. 2.14, 2.15 straight from the formulas.
double plain_mean_speed(const std::vector<Eigen::Vector3d>& q, double interval_s, std::size_t i, double radius_m) {
  double sum{0.0};
  int count{0};
  for (std::size_t j = 1; j < q.size(); ++j) {
    bool within{true};
    for (std::size_t k = std::min(i, j); k <= std::max(i, j); ++k) within = within && (q[k] - q[i]).norm() < radius_m;
    if (!within) continue;
    sum += (q[j] - q[j - 1]).norm() / interval_s;
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

TEST(Zvc, SpeedsAreThoseOfTheFormulas) {
  const HandTrajectory task = synthetic_task(3).trajectory;
  ZvcConfig config;
  const ZvcResult result = detect_by_zvc(task, config).value();
  std::vector<Eigen::Vector3d> q;
  const auto n = static_cast<int>(task.size());
  for (int i = 0; i < n; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int j = i - 4; j <= i + 4; ++j) sum += task[static_cast<std::size_t>(std::clamp(j, 0, n - 1))].position_m;
    q.emplace_back(sum / 9.0);
  }
  ASSERT_EQ(result.near_speed_m_s.size(), task.size());
  std::size_t compared{0};
  for (std::size_t i = 0; i < task.size(); i += 7, ++compared) {
    EXPECT_NEAR(result.near_speed_m_s[i], plain_mean_speed(q, 0.01, i, 0.10), 1e-9);
    EXPECT_NEAR(result.far_speed_m_s[i], plain_mean_speed(q, 0.01, i, 0.25), 1e-9);
  }
  EXPECT_GT(compared, 20U);
  for (const SlowSegment& segment : result.segments) {
    for (std::size_t i = segment.first; i <= segment.last; ++i) {
      EXPECT_LT(result.near_speed_m_s[i] * config.threshold, result.far_speed_m_s[i]);
    }
  }
}

TEST(Zvc, FindsTheActionsOfMadeUpTasks) {
  DetectionCounts counts;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const SyntheticTask task = synthetic_task(seed, {.actions = 1 + static_cast<int>(seed % 2)});
    counts += score(detect_by_zvc(task.trajectory).value().actions, task.actions_m).counts;
  }
  EXPECT_EQ(counts.labels, 60U);
  EXPECT_GT(counts.recall().value(), 0.95);
  EXPECT_GT(counts.precision().value(), 0.95);
}

/// Slow at the start, in the middle and at the end.
HandTrajectory thrice_slow() {
  HandTrajectory trajectory;
  double x_m{0.0};
  for (int i = 0; i < 600; ++i) {
    const bool slow = i < 50 || (i > 275 && i < 325) || i >= 550;
    x_m += slow ? 0.001 : 0.01;
    trajectory.push_back({0.01 * i, {x_m, 0.0, 0.0}, std::nullopt});
  }
  return trajectory;
}

TEST(Zvc, SlowEndsAreDroppedUnlessAsked) {
  ZvcConfig config;
  const ZvcResult dropped = detect_by_zvc(thrice_slow(), config).value();
  ASSERT_EQ(dropped.segments.size(), 3U);
  EXPECT_TRUE(dropped.segments[0].at_end);
  EXPECT_FALSE(dropped.segments[1].at_end);
  EXPECT_TRUE(dropped.segments[2].at_end);
  ASSERT_EQ(dropped.actions.size(), 1U);
  EXPECT_NEAR(dropped.actions[0].time_s, 3.0, 0.05);
  EXPECT_GT(dropped.actions[0].saliency, config.threshold);
  EXPECT_NE(dropped.actions[0].why.find("times as slow"), std::string::npos);
  config.drop_at_ends = false;
  EXPECT_EQ(detect_by_zvc(thrice_slow(), config).value().actions.size(), 3U);
  EXPECT_FALSE(ZvcConfig::as_printed().drop_at_ends);
  EXPECT_EQ(ZvcConfig::as_printed().threshold, 1.72);
}

TEST(Zvc, LittleOrNothingGivesNoAction) {
  EXPECT_TRUE(detect_by_zvc({}).value().actions.empty());
  HandTrajectory few;
  for (int i = 0; i < 5; ++i) {
    few.push_back({0.01 * i, {0.1 * i, 0.0, 0.0}, std::nullopt});
    EXPECT_TRUE(detect_by_zvc(few).value().actions.empty()) << few.size() << " samples";
  }
  HandTrajectory still(300, HandSample{});
  for (std::size_t i = 0; i < still.size(); ++i) still[i].time_s = 0.01 * static_cast<double>(i);
  EXPECT_TRUE(detect_by_zvc(still).value().actions.empty());
}

TEST(Zvc, BadSamplesAndConfigurationsAreRefused) {
  HandTrajectory task = synthetic_task(1).trajectory;
  ZvcConfig config;
  config.far_m = config.near_m;
  EXPECT_FALSE(detect_by_zvc(task, config));
  config = {};
  config.half_window = -1;
  EXPECT_FALSE(detect_by_zvc(task, config));
  config = {};
  config.threshold = std::nan("");
  EXPECT_FALSE(detect_by_zvc(task, config));
  task[5].time_s = task[4].time_s;
  const auto result = detect_by_zvc(task);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().context, "sample 5");
}

}  // namespace
}  // namespace saccade
