// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/annotation.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "support/annotated_cloud.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kAnna{1};
constexpr std::uint64_t kBert{2};
constexpr int kAnnotatedSide{20};
constexpr std::uint32_t kNotFinite{kAnnotatedSide * kAnnotatedSide};

class AnnotationTest : public testing::Test {
 protected:
  Applied apply(std::uint64_t client, AnnotationChange change) {
    const AnnotationAction action{client, std::move(change)};
    const Status valid = annotation.validate(action);
    EXPECT_TRUE(valid) << valid.error().to_string();
    return annotation.apply(action);
  }
  std::string why_not(AnnotationChange change) {
    const Status valid = annotation.validate({kAnna, std::move(change)});
    return valid ? "" : valid.error().message;
  }
  [[nodiscard]] std::size_t count(std::uint32_t label) const {
    const auto found = annotation.counts().find(label);
    return found == annotation.counts().end() ? 0 : found->second;
  }
  [[nodiscard]] std::vector<std::uint32_t> now() const {
    return {annotation.labels().begin(), annotation.labels().end()};
  }

  Annotation annotation{test::graph_of(test::patchy_cloud(kAnnotatedSide))};
};

TEST_F(AnnotationTest, ControlPointsGrowTreesOfTheirLabel) {
  const Applied set = apply(kAnna, SetControlPoints{{105}, 7, 0.0});
  EXPECT_TRUE(set.done);
  EXPECT_EQ(set.sequence, 1U);
  EXPECT_EQ(annotation.label_of(105), 7U);
  EXPECT_GT(count(7), 20U);
  EXPECT_LT(count(7), 200U);
  EXPECT_EQ(set.points.size(), count(7));
  ASSERT_EQ(set.control_points.size(), 1U);
  EXPECT_EQ(set.control_points[0], 105U);
  const std::size_t before = count(7);
  apply(kBert, SetControlPoints{{107}, 3, 0.0});
  EXPECT_EQ(annotation.label_of(107), 3U);
  EXPECT_LT(count(7), before);
  EXPECT_EQ(annotation.label_of(kNotFinite), kNoLabel);
  EXPECT_EQ(annotation.control_points(), (std::vector<ControlPoint>{{105, 7, 0.0}, {107, 3, 0.0}}));
}

TEST_F(AnnotationTest, AControlPointTakesOnAnotherLabelAndStartCost) {
  apply(kAnna, SetControlPoints{{105}, 7, 0.0});
  const std::size_t all = count(7);
  const Applied relabelled = apply(kAnna, SetControlPoints{{105}, 8, 0.0});
  EXPECT_EQ(relabelled.points.size(), all);
  EXPECT_EQ(count(8), all);
  EXPECT_EQ(count(7), 0U);
  apply(kAnna, SetControlPoints{{105}, 8, 0.03});
  EXPECT_LT(count(8), all);
  EXPECT_GT(count(8), 0U);
  apply(kAnna, UndoAction{});
  EXPECT_EQ(count(8), all);
}

TEST_F(AnnotationTest, MovingKeepsLabelAndStartCost) {
  apply(kAnna, SetControlPoints{{105}, 7, 0.01});
  const Applied moved = apply(kAnna, MoveControlPoint{105, 290});
  EXPECT_EQ(annotation.control_points(), (std::vector<ControlPoint>{{290, 7, 0.01}}));
  EXPECT_EQ(std::vector(moved.control_points.begin(), moved.control_points.end()),
            (std::vector<std::uint32_t>{105, 290}));
  EXPECT_EQ(annotation.label_of(105), kNoLabel);
  EXPECT_EQ(annotation.label_of(290), 7U);
}

TEST_F(AnnotationTest, PaintLiesAboveTreesAndComesOff) {
  apply(kAnna, SetControlPoints{{105}, 7, 0.0});
  const std::vector<std::uint32_t> trees = now();
  const Applied painted = apply(kAnna, PaintPoints{{104, 105, 399}, 2});
  EXPECT_EQ(painted.points.size(), 3U);
  EXPECT_EQ(annotation.label_of(104), 2U);
  EXPECT_EQ(annotation.painted(399), 2U);
  EXPECT_EQ(count(2), 3U);
  apply(kBert, RemoveControlPoints{{105}});
  EXPECT_EQ(count(7), 0U);
  EXPECT_EQ(annotation.label_of(105), 2U);
  apply(kBert, UndoAction{});
  apply(kAnna, PaintPoints{{104, 105, 106, 399}, kNoLabel});
  EXPECT_EQ(now(), trees);
}

TEST_F(AnnotationTest, ClearTakesControlPointsAndPaintButNotNames) {
  apply(kAnna, SetControlPoints{{105, 300}, 7, 0.0});
  apply(kAnna, PaintPoints{{1, 2, 105}, 3});
  apply(kAnna, DefineLabels{{{7, {"cup", {9, 9, 200}, "", 0}}}});
  const std::vector<std::uint32_t> before = now();
  const std::size_t labelled = count(7) + count(3);
  const Applied cleared = apply(kBert, ClearAnnotation{});
  EXPECT_EQ(cleared.points.size(), labelled);  // each once, painted or not
  EXPECT_EQ(cleared.control_points.size(), 2U);
  EXPECT_TRUE(annotation.counts().empty());
  EXPECT_TRUE(annotation.control_points().empty());
  EXPECT_EQ(annotation.label_table().info(7).name, "cup");
  apply(kAnna, SetControlPoints{{20}, 1, 0.0});
  apply(kBert, UndoAction{});
  EXPECT_EQ(annotation.control_points().size(), 3U);
  apply(kAnna, UndoAction{});
  EXPECT_EQ(now(), before);
}

TEST_F(AnnotationTest, DefinitionsOfLabelsAreUndoneToo) {
  const LabelInfo cup{"cup", {1, 2, 3}, "tableware", 1};
  const LabelInfo mug{"mug", {1, 2, 3}, "tableware", 1};
  const Applied defined = apply(kAnna, DefineLabels{{{4, cup}, {9, {}}}});
  EXPECT_EQ(defined.labels.size(), 2U);
  EXPECT_EQ(apply(kBert, DefineLabels{{{4, mug}}}).labels.size(), 1U);
  EXPECT_EQ(apply(kAnna, UndoAction{}).labels.size(), 1U);  // 4 is Bert's by now
  EXPECT_EQ(annotation.label_table().info(4), mug);
  apply(kBert, UndoAction{});
  EXPECT_TRUE(annotation.label_table().defined().empty());
  apply(kAnna, RedoAction{});
  EXPECT_EQ(annotation.label_table().info(4), cup);
}

TEST_F(AnnotationTest, UndoIsPerClientAndWithoutLimit) {
  const std::vector<std::uint32_t> empty = now();
  apply(kAnna, SetControlPoints{{105}, 1, 0.0});
  apply(kBert, SetControlPoints{{300}, 2, 0.0});
  const std::vector<std::uint32_t> both = now();
  apply(kAnna, UndoAction{});
  EXPECT_EQ(annotation.control_points(), (std::vector<ControlPoint>{{300, 2, 0.0}}));
  apply(kAnna, RedoAction{});
  EXPECT_EQ(now(), both);
  for (std::uint32_t i = 0; i < 500; ++i) apply(kAnna, SetControlPoints{{i % 400}, 1 + i % 7, 0.0});
  for (std::uint32_t i = 0; i < 501; ++i) EXPECT_TRUE(apply(kAnna, UndoAction{}).done);
  EXPECT_FALSE(annotation.history().can_undo(kAnna));
  EXPECT_EQ(annotation.control_points().size(), 1U);
  apply(kBert, UndoAction{});
  EXPECT_EQ(now(), empty);
  for (std::uint32_t i = 0; i < 501; ++i) EXPECT_TRUE(apply(kAnna, RedoAction{}).done);
  EXPECT_EQ(annotation.control_points().size(), 400U);
}

TEST_F(AnnotationTest, NothingToUndoIsNoErrorAndDoesNotCount) {
  apply(kAnna, SetControlPoints{{105}, 1, 0.0});
  for (const AnnotationChange& change : {AnnotationChange{UndoAction{}}, AnnotationChange{RedoAction{}}}) {
    const Applied applied = apply(kBert, change);
    EXPECT_FALSE(applied.done);
    EXPECT_EQ(applied.sequence, 1U);
    EXPECT_TRUE(applied.points.empty());
  }
}

TEST_F(AnnotationTest, ANewActionEndsWhatItsClientCouldRedo) {
  apply(kAnna, SetControlPoints{{105}, 1, 0.0});
  apply(kBert, SetControlPoints{{300}, 1, 0.0});
  apply(kAnna, UndoAction{});
  apply(kBert, UndoAction{});
  apply(kAnna, PaintPoints{{3}, 1});
  EXPECT_FALSE(apply(kAnna, RedoAction{}).done);
  EXPECT_TRUE(apply(kBert, RedoAction{}).done);
}

TEST_F(AnnotationTest, AMoveMovesNothingOnceWhatItMovedIsUndone) {
  apply(kAnna, SetControlPoints{{105}, 5, 0.0});
  apply(kBert, MoveControlPoint{105, 110});
  apply(kBert, MoveControlPoint{110, 300});
  apply(kAnna, UndoAction{});
  EXPECT_TRUE(annotation.control_points().empty());
  apply(kAnna, RedoAction{});
  EXPECT_EQ(annotation.control_points(), (std::vector<ControlPoint>{{300, 5, 0.0}}));
  apply(kBert, UndoAction{});
  EXPECT_EQ(annotation.control_points(), (std::vector<ControlPoint>{{110, 5, 0.0}}));
}

TEST_F(AnnotationTest, RefusesWhatHasNothingToActOn) {
  EXPECT_EQ(why_not(RemoveControlPoints{{3}}), "there is no control point to remove");
  EXPECT_EQ(why_not(MoveControlPoint{3, 4}), "point 3 is not a control point, so it cannot be moved");
  apply(kAnna, SetControlPoints{{105}, 1, 0.0});
  EXPECT_EQ(why_not(RemoveControlPoints{{3, 105}}), "");
  EXPECT_NE(why_not(SetControlPoints{{kNotFinite}, 1, 0.0}).find("no neighbours"), std::string::npos);
  EXPECT_NE(why_not(PaintPoints{{1, kNotFinite}, 1}).find("no neighbours"), std::string::npos);
  EXPECT_NE(why_not(MoveControlPoint{105, kNotFinite}).find("no neighbours"), std::string::npos);
  EXPECT_NE(why_not(MoveControlPoint{kNotFinite, 105}), "");
  EXPECT_NE(why_not(PaintPoints{{kNotFinite + 1}, 1}), "");
}

TEST_F(AnnotationTest, RestoreExpectsAnEmptyAnnotation) {
  apply(kAnna, SetControlPoints{{105}, 1, 0.0});
  EXPECT_THROW(annotation.restore({}), ContractViolation);
}

}  // namespace
}  // namespace saccade
