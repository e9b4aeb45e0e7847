// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/attention_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/attention/dip_detector.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "unit/report/pixels.hpp"
#include "unit/report/well_formed.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kPoiColor{214, 28, 92};
constexpr Rgb8 kLabelColor{20, 20, 24};

TEST(AttentionPicture, ShowsWhatThereIs) {
  const SyntheticTask task = synthetic_task(1);
  const ColorImage plain = attention_picture(task.trajectory, {});
  AttentionFindings findings;
  findings.labels_m = task.actions_m;
  const ColorImage labelled = attention_picture(task.trajectory, findings);
  EXPECT_EQ(test::count(plain, kLabelColor), 0U);
  EXPECT_GT(test::count(labelled, kLabelColor), 100U);
  findings.actions.push_back({task.actions_m.front(), 1.0, 1.0, {}});
  findings.gaussians.push_back({task.actions_m.front(), 1e-3 * Eigen::Matrix3d::Identity(), true});
  const ColorImage found = attention_picture(task.trajectory, findings);
  EXPECT_EQ(test::count(labelled, kPoiColor), 0U);
  EXPECT_GT(test::count(found, kPoiColor), 200U);
}

TEST(AttentionPicture, NumbersOfNearActionsShareALabel) {
  const SyntheticTask task = synthetic_task(1);
  const auto with_actions = [&](std::size_t count) {
    AttentionFindings findings;
    findings.actions.assign(count, {task.actions_m.front(), 1.0, 1.0, {}});
    AttentionPictureConfig config;
    config.region_radius_m = 0.001;
    return attention_picture(task.trajectory, findings, config);
  };
  const ColorImage one = with_actions(1);
  const ColorImage four = with_actions(4);
  ASSERT_EQ(one.width(), four.width());
  ASSERT_EQ(one.height(), four.height());
  int left = one.width();
  int right = 0;
  for (int v = 0; v < one.height(); ++v) {
    for (int u = 0; u < one.width(); ++u) {
      if (one(u, v) == four(u, v)) continue;
      left = std::min(left, u);
      right = std::max(right, u);
    }
  }
  EXPECT_GT(right - left, 50);  // "1, 2, 3, 4"; digits on each other are 13 pixels wide at most
}

TEST(AttentionPicture, NothingAndASinglePointHaveAPicture) {
  EXPECT_GT(attention_picture({}, {}).width(), 100);
  const HandTrajectory one(1, HandSample{});
  EXPECT_GT(attention_picture(one, {}).width(), 100);
}

TEST(SpeedPlot, MarksBothEndsOfEveryDip) {
  const DipResult result = detect_dips(synthetic_task(3, {.actions = 3}).trajectory).value();
  ASSERT_EQ(result.dips.size(), 3U);
  ASSERT_GT(result.motion.size(), 60U);  // a curve without markers
  AttentionFindings findings;
  findings.motion = result.motion;
  const std::string plain = speed_plot(findings, "a <task>");
  findings.dips = result.dips;
  const std::string svg = speed_plot(findings, "a <task>");
  EXPECT_EQ(test::well_formed(svg).problem, "");
  EXPECT_NE(svg.find("a &lt;task&gt;"), std::string::npos);
  EXPECT_EQ(plain.find(">dips<"), std::string::npos);
  EXPECT_NE(svg.find(">dips<"), std::string::npos);
  EXPECT_EQ(test::count(svg, "<rect x="), 2 * result.dips.size() + 1);  // and the one of the legend
  EXPECT_EQ(test::count(plain, "<rect x="), 0U);
}

TEST(SpeedPlot, IsEmptyWithoutMotion) { EXPECT_TRUE(speed_plot({}, "title").empty()); }

}  // namespace
}  // namespace saccade
