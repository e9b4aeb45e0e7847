// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/annotation_margin.hpp"

#include <gtest/gtest.h>

namespace saccade {
namespace {

/// 21 points in a row, a centimetre apart, each joined to the next ones.
std::shared_ptr<const Neighbourhood> row_of_points(double max_path) {
  PointCloud cloud;
  for (int i = 0; i < 21; ++i) cloud.positions_m.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
  NeighbourhoodConfig config;
  config.neighbours = 2;
  config.position_weight_per_m = 1.0;
  config.normal_weight = 0.0;
  config.max_path = max_path;
  return std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, config, Executor{}).value());
}

TEST(AnnotationMargin, IsNoneHalfwayAndFullAtControlPoints) {
  Annotation annotation{row_of_points(1.0)};
  annotation.apply({1, SetControlPoints{{0}, 1, 0.0}});
  annotation.apply({1, SetControlPoints{{20}, 2, 0.0}});
  annotation.apply({1, PaintPoints{{9}, 3}});
  const std::vector<float> margins = label_margins(annotation);
  EXPECT_EQ(margins[0], 1.0F);
  EXPECT_EQ(margins[20], 1.0F);
  EXPECT_EQ(margins[9], 1.0F);
  EXPECT_NEAR(margins[10], 0.0F, 1e-5F);
  EXPECT_NEAR(margins[5], 1.0F - 5.0F / 15.0F, 1e-5F);
  EXPECT_NEAR(margins[18], 1.0F - 2.0F / 18.0F, 1e-5F);
}

TEST(AnnotationMargin, EndsWhereLabelsEnd) {
  Annotation annotation{row_of_points(0.1)};
  annotation.apply({1, SetControlPoints{{0}, 1, 0.0}});
  const std::vector<float> margins = label_margins(annotation);
  EXPECT_NEAR(margins[5], 0.5F, 1e-5F);
  EXPECT_NEAR(margins[9], 0.1F, 1e-5F);
  EXPECT_EQ(margins[15], 0.0F);
}

TEST(NextBestClick, IsInTheMiddleOfWhatHasNoLabel) {
  Annotation annotation{row_of_points(0.055)};
  annotation.apply({1, SetControlPoints{{3}, 1, 0.0}});
  const std::optional<BestClick> click = next_best_click(annotation, label_margins(annotation), {});
  ASSERT_TRUE(click);
  EXPECT_EQ(click->label, kNoLabel);
  EXPECT_GE(click->point, 12U);
  EXPECT_GT(click->gain, 3.0);
}

TEST(NextBestClick, IsNoneWhereAllIsPainted) {
  Annotation annotation{row_of_points(1.0)};
  std::vector<std::uint32_t> all;
  for (std::uint32_t point = 0; point < 21; ++point) all.push_back(point);
  annotation.apply({1, PaintPoints{all, 2}});
  EXPECT_FALSE(next_best_click(annotation, label_margins(annotation), {}));
}

}  // namespace
}  // namespace saccade
