// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/split_label.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace saccade {
namespace {

constexpr std::uint32_t kColumns{40};
constexpr std::uint32_t kRows{20};

/// Plane of 40 × 20 points, a centimetre apart, that one label has, seen from above: a point is 10 px from the next.
class LabelSplitTest : public ::testing::Test {
 protected:
  LabelSplitTest() {
    for (std::uint32_t i = 0; i < kColumns * kRows; ++i) {
      const auto column = static_cast<float>(i % kColumns);
      const auto row = static_cast<float>(i / kColumns);
      cloud_.positions_m.emplace_back(0.01F * (column + 0.5F), 0.01F * (row + 0.5F), 0.0F);
    }
    NeighbourhoodConfig config;
    config.max_path = 1000.0;
    annotation_.emplace(
        std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud_, config, Executor{}).value()));
    annotation_->apply({1, SetControlPoints{{0}, 3, 0.0}});
    view_.width = 400;
    view_.height = 200;
    view_.point_size_px = 10;
    view_.clip_world << 5, 0, 0, -1, 0, -10, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1;
  }
  [[nodiscard]] Result<LabelSplit> split(std::vector<ScreenPoint> line, SplitPart part = SplitPart::smaller,
                                         std::uint32_t given = 4) const {
    return split_label(*annotation_, cloud_.positions_m, view_, {std::move(line), 4.0}, part, given, Executor{});
  }
  /// Points of the columns before the first, or from it on.
  static std::vector<std::uint32_t> columns(std::uint32_t first, std::uint32_t end) {
    std::vector<std::uint32_t> points;
    for (std::uint32_t i = 0; i < kColumns * kRows; ++i) {
      if (i % kColumns >= first && i % kColumns < end) points.push_back(i);
    }
    return points;
  }

  PointCloud cloud_;
  std::optional<Annotation> annotation_;
  SelectionView view_;
};

TEST_F(LabelSplitTest, TheSmallerPartIsTheOneWithFewerPoints) {
  const auto made = split({{120, -5}, {120, 205}});
  ASSERT_TRUE(made) << made.error().to_string();
  EXPECT_EQ(made->label, 3U);
  EXPECT_EQ(made->points, columns(0, 12));
  EXPECT_EQ(split({{120, 205}, {120, -5}})->points, columns(0, 12)) << "whichever way it is drawn";
  EXPECT_EQ(split({{120, -5}, {120, 205}}, SplitPart::larger)->points, columns(12, kColumns));
}

TEST_F(LabelSplitTest, ABentStrokeIsFollowed) {
  const auto made = split({{100, -5}, {100, 100}, {200, 100}, {200, 205}});
  ASSERT_TRUE(made) << made.error().to_string();
  EXPECT_EQ(made->points.size(), 10U * 10U + 20U * 10U);
}

TEST_F(LabelSplitTest, AStrokeThatEndsInsideSeparatesNothing) {
  EXPECT_EQ(split({{120, -5}, {120, 100}}).error().code, Errc::invalid_argument);
  EXPECT_EQ(split({{120, 50}, {120, 50}}).error().code, Errc::invalid_argument);
}

TEST_F(LabelSplitTest, TheGivenLabelIsNotSplit) {
  EXPECT_EQ(split({{120, -5}, {120, 205}}, SplitPart::smaller, 3).error().code, Errc::invalid_argument);
  annotation_->apply({1, PaintPoints{columns(0, 12), 4}});
  const auto made = split({{60, 100}, {300, 100}, {300, 205}});
  ASSERT_TRUE(made) << made.error().to_string();
  EXPECT_EQ(made->label, 3U) << "label 4 is crossed, too";
  EXPECT_EQ(made->points.size(), 18U * 10U);
}

TEST_F(LabelSplitTest, PointsThatAreNotThereTakeNoPart) {
  std::vector<Eigen::Vector3f> shown_m = cloud_.positions_m;
  for (const std::uint32_t point : columns(0, 5)) shown_m[point].setConstant(std::nanf(""));
  const auto made =
      split_label(*annotation_, shown_m, view_, {{{120, -5}, {120, 205}}, 4.0}, SplitPart::smaller, 4, {});
  ASSERT_TRUE(made) << made.error().to_string();
  EXPECT_EQ(made->points, columns(5, 12));
}

TEST_F(LabelSplitTest, MayBeSplitOnlyWhereThereIsALine) {
  EXPECT_FALSE(split({}));
  EXPECT_FALSE(split({{10, 10}}));
}

}  // namespace
}  // namespace saccade
