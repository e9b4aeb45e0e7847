// SPDX-License-Identifier: Apache-2.0
// A later click of a label takes what lies behind the border that a label leaked over, and nothing before it.
#include "saccade/annotate/click_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/annotated_cloud.hpp"
#include "support/naive_forest.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kSidePoints{450};
constexpr std::uint32_t kMiddlePoints{10};
constexpr std::uint32_t kLinePoints{2 * kSidePoints + kMiddlePoints};
constexpr std::uint32_t kLeftLabel{1};
constexpr std::uint32_t kRightLabel{2};
constexpr std::uint32_t kWrongPoint{kSidePoints + kMiddlePoints / 2};

/// Points 1 cm apart on a line: a long part, a short one behind a step of colour of 0.6, and a long one behind a step
/// of 0.4. Left and middle are one object, but paths from the right end to the middle are shorter.
PointCloud three_parts() {
  PointCloud cloud;
  for (std::uint32_t i = 0; i < kLinePoints; ++i) {
    cloud.positions_m.emplace_back(0.01F * static_cast<float>(i), 0.0F, 1.0F);
    cloud.colors.emplace_back(i < kSidePoints ? 0.0F : i < kSidePoints + kMiddlePoints ? 0.6F : 1.0F, 0.0F, 0.0F);
  }
  return cloud;
}

std::shared_ptr<const Neighbourhood> line_graph(bool strong_borders) {
  NeighbourhoodConfig config;
  config.neighbours = 2;
  config.position_weight_per_m = 1.0;
  config.normal_weight = 0.0;
  config.strong_borders = strong_borders;
  return std::make_shared<const Neighbourhood>(Neighbourhood::build(three_parts(), config, Executor{}).value());
}

/// Clicks at both ends, then into the middle, which has the right end's label.
Annotation annotated_line(bool strong_borders) {
  Annotation annotation{line_graph(strong_borders)};
  for (const SetControlPoints& click :
       {SetControlPoints{{0}, kLeftLabel, 0.0}, SetControlPoints{{kLinePoints - 1}, kRightLabel, 0.0},
        SetControlPoints{{kWrongPoint}, kLeftLabel, 0.0}}) {
    annotation.apply(guarded_click(annotation, {1, click}));
  }
  return annotation;
}

TEST(ClickStart, ALaterClickStopsAtTheBorderThatTheOtherLabelCrossed) {
  const Annotation annotation = annotated_line(true);
  EXPECT_EQ(annotation.counts().at(kLeftLabel), kSidePoints + kMiddlePoints);
  EXPECT_EQ(annotation.counts().at(kRightLabel), kSidePoints);
  EXPECT_GT(annotation.control_point(kWrongPoint).value().start_cost, 0.0);
}

TEST(ClickStart, AsPrintedTheSameClickLeaksOverIt) {
  const Annotation annotation = annotated_line(false);
  EXPECT_EQ(annotation.control_point(kWrongPoint).value().start_cost, 0.0);
  EXPECT_GT(annotation.counts().at(kLeftLabel), kSidePoints + kMiddlePoints + kSidePoints / 3);
}

TEST(ClickStart, StrongerBordersAloneDoNotStopIt) {
  ShortestPathForest forest{line_graph(true)};
  for (const std::uint32_t point : {0U, kLinePoints - 1, kWrongPoint}) forest.add({point, 0.0});
  EXPECT_EQ(forest.root_of(kSidePoints + kMiddlePoints), kWrongPoint);
}

TEST(ClickStart, LeavesOtherActionsAsTheyAre) {
  const Annotation annotation = annotated_line(true);
  for (const SetControlPoints& set :
       {SetControlPoints{{3}, 7, 0.0}, SetControlPoints{{3, 4}, kLeftLabel, 0.0},
        SetControlPoints{{3}, kRightLabel, 0.5}, SetControlPoints{{kLinePoints}, kLeftLabel, 0.0}}) {
    const AnnotationAction action{1, set};
    EXPECT_EQ(guarded_click(annotation, action), action);
  }
  const AnnotationAction undo{1, UndoAction{}};
  EXPECT_EQ(guarded_click(annotation, undo), undo);
}

TEST(ClickStart, OfAPointWithoutARootIsZero) {
  const ShortestPathForest forest{line_graph(true)};
  EXPECT_EQ(click_start(forest, 3), 0.0);
}

TEST(ClickStart, PointsAtTheSamePlaceDoNotEndTheWayBack) {
  PointCloud cloud = three_parts();
  const PointCloud once = cloud;
  for (const Eigen::Vector3f& p_m : once.positions_m) cloud.positions_m.push_back(p_m);
  for (const Eigen::Vector3f& color : once.colors) cloud.colors.push_back(color);
  NeighbourhoodConfig config;
  config.neighbours = 4;
  config.position_weight_per_m = 1.0;
  config.normal_weight = 0.0;
  ShortestPathForest forest{
      std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, config, Executor{}).value())};
  forest.add({kLinePoints - 1, 0.0});
  EXPECT_GT(click_start(forest, kWrongPoint), forest.path_length(kSidePoints + kMiddlePoints) - 0.05);
  EXPECT_LE(click_start(forest, kWrongPoint), forest.path_length(kSidePoints + kMiddlePoints));
}

/// Steps by steps as the incremental forest, whose start costs the clicks choose: each point has the root that the
/// definition gives it, with any number of threads.
TEST(ClickStart, GuardedClicksEqualTheDefinition) {
  constexpr int kClicks{40};
  NeighbourhoodConfig config;
  config.neighbours = 6;
  config.strong_borders = true;
  const PointCloud cloud = test::patchy_cloud(24);
  const auto graph = std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, config, Executor{}).value());
  Annotation annotation{graph};
  Annotation threaded{graph, Executor::with_threads(3)};
  std::mt19937 random{5};
  int guarded{0};
  for (int i = 0; i < kClicks; ++i) {
    const auto point = static_cast<std::uint32_t>(random() % (graph->size() - 1));
    const AnnotationAction action = guarded_click(annotation, {1, SetControlPoints{{point}, 1 + i % 3U, 0.0}});
    ASSERT_EQ(guarded_click(threaded, {1, SetControlPoints{{point}, 1 + i % 3U, 0.0}}), action);
    guarded += std::get<SetControlPoints>(action.change).start_cost > 0.0 ? 1 : 0;
    annotation.apply(action);
    threaded.apply(action);
    std::vector<Root> roots;
    for (const ControlPoint& control : annotation.control_points())
      roots.push_back({control.point, control.start_cost});
    const test::NaiveForest naive = test::naive_forest(*graph, roots);
    for (std::uint32_t p = 0; p < graph->size(); ++p) {
      const auto root = annotation.forest().root_of(p);
      ASSERT_EQ(root.has_value(), naive[p].has_value());
      if (root) {
        ASSERT_EQ(*root, naive[p]->second);
      }
      ASSERT_EQ(annotation.label_of(p), threaded.label_of(p));
    }
  }
  EXPECT_GT(guarded, kClicks / 2);
}

}  // namespace
}  // namespace saccade
