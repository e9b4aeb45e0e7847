// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "saccade/annotate/annotation.hpp"
#include "support/annotated_cloud.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kFirst{42};  // on the patchy cloud of 20 × 20 points

class LabelLockTest : public ::testing::Test {
 protected:
  LabelLockTest() {
    apply(SetControlPoints{{kFirst}, 1, 0.0});
    apply(LockLabel{1, true, points_of(1)});
    while (annotation_.label_of(second_) == 1) ++second_;  // its tree would take points of the first
  }
  void apply(AnnotationChange change, std::uint64_t client = 1) {
    const AnnotationAction action{client, std::move(change)};
    ASSERT_TRUE(annotation_.validate(action));
    annotation_.apply(action);
    actions_.push_back(action);
  }
  [[nodiscard]] bool is_refused(AnnotationChange change) const { return !annotation_.validate({1, std::move(change)}); }
  [[nodiscard]] std::vector<std::uint32_t> points_of(std::uint32_t label) const {
    std::vector<std::uint32_t> points;
    for (std::uint32_t point = 0; point < annotation_.labels().size(); ++point) {
      if (annotation_.label_of(point) == label) points.push_back(point);
    }
    return points;
  }

  PointCloud cloud_{test::patchy_cloud(20)};
  std::shared_ptr<const Neighbourhood> graph_{test::graph_of(cloud_)};
  Annotation annotation_{graph_};
  std::vector<AnnotationAction> actions_;
  std::uint32_t second_{kFirst};
};

TEST_F(LabelLockTest, ControlPointsOfOthersTakeNothing) {
  const std::vector<std::uint32_t> held = points_of(1);
  ASSERT_GT(held.size(), 10U);
  apply(SetControlPoints{{second_}, 2, 0.0}, 2);
  EXPECT_EQ(points_of(1), held);
  EXPECT_FALSE(points_of(2).empty());
  apply(ClearAnnotation{}, 2);
  EXPECT_EQ(points_of(1), held);
  EXPECT_TRUE(points_of(2).empty());
  apply(UndoAction{}, 2);
  apply(RemoveControlPoints{{kFirst}}, 2);
  EXPECT_EQ(points_of(1), held);
  apply(LockLabel{1, false, {}}, 2);
  EXPECT_TRUE(points_of(1).empty()) << "they follow their trees again";
  apply(UndoAction{}, 2);
  EXPECT_EQ(points_of(1), held);
}

TEST_F(LabelLockTest, NothingIsDoneWithItOrOnIt) {
  EXPECT_TRUE(is_refused(SetControlPoints{{second_}, 1, 0.0}));
  EXPECT_TRUE(is_refused(PaintPoints{{second_}, 1}));
  EXPECT_TRUE(is_refused(PaintPoints{{kFirst, 399}, 2}));
  EXPECT_TRUE(is_refused(PaintPoints{{kFirst}, kNoLabel}));
  EXPECT_TRUE(is_refused(SetControlPoints{{kFirst}, 2, 0.0}));
  EXPECT_TRUE(is_refused(MoveControlPoint{kFirst, 399}));
  EXPECT_FALSE(is_refused(PaintPoints{{399}, 2}));
  apply(UndoAction{});
  EXPECT_FALSE(is_refused(PaintPoints{{kFirst}, 2}));
}

TEST_F(LabelLockTest, TheStateDependsOnTheActionsAlone) {
  apply(SetControlPoints{{second_}, 2, 0.0}, 2);
  apply(LockLabel{2, true, points_of(2)}, 2);
  apply(UndoAction{}, 1);
  apply(LockLabel{1, true, points_of(1)}, 3);
  apply(RedoAction{}, 1);
  apply(SetControlPoints{{399}, 3, 0.0}, 2);
  Annotation again{graph_};
  again.restore(actions_);
  EXPECT_TRUE(std::equal(again.labels().begin(), again.labels().end(), annotation_.labels().begin()));
  EXPECT_TRUE(again.is_locked(1) && again.is_locked(2) && !again.is_locked(3));
}

}  // namespace
}  // namespace saccade
