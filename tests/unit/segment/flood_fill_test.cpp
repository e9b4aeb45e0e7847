// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/flood_fill.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "saccade/segment/internal/surfel_graph.hpp"

namespace saccade {
namespace {

using Labels = std::vector<std::uint32_t>;
constexpr float kNowhere{std::numeric_limits<float>::quiet_NaN()};

/// Surfels along x at these places, all of one radius, level and black.
PointCloud row(const std::vector<float>& places_m, float radius_m) {
  PointCloud cloud;
  for (const float x : places_m) {
    cloud.positions_m.emplace_back(x, 0.0F, 0.0F);
    cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
    cloud.colors.emplace_back(0.0F, 0.0F, 0.0F);
    cloud.radii_m.push_back(radius_m);
  }
  return cloud;
}

Labels labels_of(const PointCloud& cloud, const FloodFillConfig& config = {}) {
  return flood_fill(cloud, config, Executor{}).value().labels;
}

TEST(FloodFill, SurfelsTouchWhenTheyAreCloserThanTheirRadiiTogether) {
  EXPECT_EQ(labels_of(row({0.0F, 1.0F, 1.75F}, 0.5F)), (Labels{0, 1, 1}));  // 1 is not less than 0.5 + 0.5
  PointCloud unlike = row({0.0F, 1.0F, 3.0F}, 0.25F);
  unlike.radii_m[1] = 0.8125F;
  EXPECT_EQ(labels_of(unlike), (Labels{0, 0, 1}));
  unlike.radii_m[2] = 1.25F;
  EXPECT_EQ(labels_of(unlike), (Labels{0, 0, 0}));
}

TEST(FloodFill, ColoursAndNormalsAreWeighed) {
  PointCloud cloud = row({0.0F, 1.0F}, 1.0F);
  cloud.colors[1] = {0.25F, 0.0F, 0.0F};
  EXPECT_EQ(labels_of(cloud, {1.0, 0.5, 0.25}), (Labels{0, 1}));  // 0.25 is not less than 0.25
  EXPECT_EQ(labels_of(cloud, {1.0, 0.5, 0.26}), (Labels{0, 0}));
  EXPECT_EQ(labels_of(cloud, {2.0, 0.5, 0.4}), (Labels{0, 1}));
  cloud.normals[1] = {1.0F, 0.0F, 0.0F};
  EXPECT_EQ(labels_of(cloud, {1.0, 0.5, 0.75}), (Labels{0, 1}));  // 0.25 + 0.5 · 1
  EXPECT_EQ(labels_of(cloud, {1.0, 0.5, 0.76}), (Labels{0, 0}));
  cloud.normals[1] = {0.0F, 0.0F, -1.0F};  // away: 1 − N · N = 2
  EXPECT_EQ(labels_of(cloud, {1.0, 0.5, 1.25}), (Labels{0, 1}));
  EXPECT_EQ(labels_of(cloud, {1.0, 0.5, 1.26}), (Labels{0, 0}));
}

TEST(FloodFill, DefaultsAreTheThesis) {
  const FloodFillConfig config;
  EXPECT_EQ(config.color_weight, 1.0);
  EXPECT_EQ(config.normal_weight, 0.5);
}

TEST(FloodFill, WhatIsNotKnownDoesNotSeparate) {
  PointCloud cloud = row({0.0F, 1.0F, 2.0F}, 1.0F);
  cloud.normals[1] = {kNowhere, 0.0F, 0.0F};
  cloud.normals[2] = Eigen::Vector3f::Zero();
  EXPECT_EQ(labels_of(cloud), (Labels{0, 0, 0}));
  cloud.normals.clear();
  EXPECT_EQ(labels_of(cloud), (Labels{0, 0, 0}));
  cloud.colors.clear();
  EXPECT_EQ(labels_of(cloud), (Labels{0, 0, 0}));
  EXPECT_EQ(labels_of(cloud, {1.0, 0.5, 0.0}), (Labels{0, 1, 2}));  // nothing is less than 0
}

/// N₁ · N₂ of a normal that is zero is 0.
TEST(FloodFill, AsPrintedWhatIsNotKnownCountsAsZero) {
  PointCloud cloud = row({0.0F, 1.0F, 2.0F}, 1.0F);
  cloud.normals[1] = {kNowhere, 0.0F, 0.0F};
  cloud.normals[2] = Eigen::Vector3f::Zero();
  FloodFillConfig printed = FloodFillConfig::as_printed();
  EXPECT_EQ(labels_of(cloud, printed), (Labels{0, 1, 2}));
  printed.threshold = 0.51;  // 0.5 · (1 − 0)
  EXPECT_EQ(labels_of(cloud, printed), (Labels{0, 0, 0}));
  printed.threshold = 0.05;
  cloud.normals.clear();
  EXPECT_EQ(labels_of(cloud, printed), (Labels{0, 0, 0})) << "a cloud without normals is filled by colours";
}

TEST(FloodFill, PointsThatAreNoneHaveNoLabel) {
  PointCloud cloud = row({0.0F, kNowhere, 0.5F, 9.0F}, 0.5F);
  cloud.radii_m[1] = kNowhere;
  const SurfelComponents found = flood_fill(cloud, {}, Executor{}).value();
  EXPECT_EQ(found.labels, (Labels{0, kUnlabelled, 0, 1}));
  EXPECT_EQ(found.count, 2U);
  EXPECT_EQ(flood_fill(PointCloud{}, {}, Executor{}).value().count, 0U);
}

TEST(FloodFill, BadSurfelsAreErrors) {
  const auto error_of = [](const PointCloud& cloud) { return flood_fill(cloud, {}, Executor{}).error(); };
  PointCloud cloud = row({0.0F, 1.0F}, 0.5F);
  cloud.radii_m[1] = -1.0F;
  EXPECT_NE(error_of(cloud).to_string().find("point 1"), std::string::npos);
  cloud.radii_m[1] = kNowhere;
  EXPECT_EQ(error_of(cloud).code, Errc::invalid_argument);
  cloud.radii_m.pop_back();
  EXPECT_EQ(error_of(cloud).code, Errc::size_mismatch);
  cloud.radii_m.clear();
  EXPECT_NE(error_of(cloud).to_string().find("radii"), std::string::npos);
  EXPECT_NE(error_of(row({0.0F, 1e9F}, 0.001F)).to_string().find("farther"), std::string::npos);
  EXPECT_EQ(flood_fill(row({0.0F}, 1.0F), {1.0, -0.5, 0.1}, Executor{}).error().code, Errc::invalid_argument);
  const SurfelGraph graph = SurfelGraph::create(row({0.0F}, 1.0F)).value();
  EXPECT_EQ(flood_fill(graph, row({0.0F, 1.0F}, 1.0F), {}, Executor{}).error().code, Errc::size_mismatch);
}

TEST(SplitUnconnected, PartsThatDoNotTouchAreTwo) {
  const PointCloud cloud = row({0.0F, 0.5F, 1.0F, 1.5F, 9.0F, kNowhere}, 0.5F);
  const SurfelGraph graph = SurfelGraph::create(cloud).value();
  const auto split = [&](const Labels& labels) { return split_unconnected(graph, labels, Executor{}).value(); };
  const SurfelComponents parts = split({7, 7, kUnlabelled, 7, 7, 7});
  EXPECT_EQ(parts.labels, (Labels{0, 0, kUnlabelled, 1, 2, kUnlabelled}));  // 1.5 − 0.5 is not less than 1
  EXPECT_EQ(parts.count, 3U);
  EXPECT_EQ(split({7, 7, 3, 7, 7, 7}).labels, (Labels{0, 0, 1, 2, 3, kUnlabelled}));
  EXPECT_EQ(split(Labels(6, kUnlabelled)).count, 0U);
  EXPECT_EQ(split_unconnected(graph, Labels{1}, Executor{}).error().code, Errc::size_mismatch);
}

}  // namespace
}  // namespace saccade
