// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/action.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace saccade {
namespace {

constexpr std::size_t kCheckedPoints{10};
constexpr double kCheckedPath{0.5};

std::string why_not(AnnotationChange change) {
  const Status status = check_action({1, std::move(change)}, kCheckedPoints, kCheckedPath);
  if (status) return "";
  EXPECT_EQ(status.error().code, Errc::invalid_argument);
  return status.error().message;
}

TEST(CheckAction, AcceptsWhatMakesSense) {
  EXPECT_EQ(why_not(SetControlPoints{{9, 0, 3}, kMaxLabel, 0.499}), "");
  EXPECT_EQ(why_not(RemoveControlPoints{{0}}), "");
  EXPECT_EQ(why_not(MoveControlPoint{9, 0}), "");
  EXPECT_EQ(why_not(PaintPoints{{0, 1, 2, 9}, 3}), "");
  EXPECT_EQ(why_not(PaintPoints{{5}, kNoLabel}), "");
  EXPECT_EQ(why_not(DefineLabels{{{2, {"cup", {1, 2, 3}, "", 0}}, {1, {}}}}), "");
  EXPECT_EQ(why_not(ClearAnnotation{}), "");
  EXPECT_EQ(why_not(UndoAction{}), "");
  EXPECT_EQ(why_not(RedoAction{}), "");
}

TEST(CheckAction, RefusesPointsThatAreNone) {
  for (const auto& points : {std::vector<std::uint32_t>{10}, {0, 1, 0xFFFFFFFF}}) {
    EXPECT_NE(why_not(SetControlPoints{points, 1, 0.0}).find("not one of the cloud's 10"), std::string::npos);
    EXPECT_NE(why_not(RemoveControlPoints{points}).find("not one of"), std::string::npos);
    EXPECT_NE(why_not(PaintPoints{points, 1}).find("not one of"), std::string::npos);
  }
  EXPECT_NE(why_not(MoveControlPoint{0, 10}).find("point 10"), std::string::npos);
  EXPECT_NE(why_not(MoveControlPoint{10, 0}).find("point 10"), std::string::npos);
  EXPECT_EQ(why_not(MoveControlPoint{3, 3}), "it moves a control point to where it is");
  EXPECT_EQ(why_not(PaintPoints{{}, 1}), "it names no point");
  EXPECT_EQ(why_not(SetControlPoints{{}, 1, 0.0}), "it names no point");
}

TEST(CheckAction, RefusesWhatIsNamedTwice) {
  EXPECT_EQ(why_not(PaintPoints{{4, 4}, 1}), "point 4 is named twice");
  EXPECT_EQ(why_not(RemoveControlPoints{{7, 1, 7}}), "point 7 is named twice");
  EXPECT_EQ(why_not(DefineLabels{{{2, {}}, {1, {}}, {2, {}}}}), "label 2 is named twice");
}

TEST(CheckAction, RefusesLabelsAndCostsThatAreNone) {
  EXPECT_NE(why_not(SetControlPoints{{1}, kNoLabel, 0.0}), "");
  EXPECT_NE(why_not(SetControlPoints{{1}, kMaxLabel + 1, 0.0}), "");
  EXPECT_NE(why_not(PaintPoints{{1}, kMaxLabel + 1}), "");
  EXPECT_NE(why_not(DefineLabels{{{kNoLabel, {}}}}), "");
  EXPECT_NE(why_not(DefineLabels{}), "");
  EXPECT_NE(why_not(DefineLabels{{{1, {"two\nlines", {}, "", 0}}}}), "");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double cost : {-0.1, kCheckedPath, 7.0, nan, -nan, HUGE_VAL}) {
    EXPECT_NE(why_not(SetControlPoints{{1}, 1, cost}), "") << cost;
  }
}

}  // namespace
}  // namespace saccade
