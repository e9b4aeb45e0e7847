// SPDX-License-Identifier: Apache-2.0
// Grouping of contour voxels, eq. 3.7.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "saccade/views/contours.hpp"

namespace saccade {
namespace {

constexpr double kContourVoxel_m{0.005};
const Eigen::Vector3f kUp{0.0F, 0.0F, 1.0F};

Eigen::Vector3f tilted(double degrees) {
  const double rad = degrees * std::numbers::pi / 180.0;
  return Eigen::Vector3d{std::sin(rad), 0.0, std::cos(rad)}.cast<float>();
}

std::vector<ContourPoint> group(const std::vector<ContourVoxel>& voxels, const ContourConfig& config = {}) {
  return contour_points(voxels, kContourVoxel_m, config);
}

TEST(ContourPoints, AreMeansOfSimilarVoxels) {
  const auto points = group({{{0, 0, 0}, tilted(-10.0)}, {{2, 0, 0}, tilted(10.0)}, {{4, 4, 0}, kUp}});
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].voxels, 3U);
  EXPECT_LT((points[0].position_m - Eigen::Vector3d{2.5, 1.3333333333333333 + 0.5, 0.5} * kContourVoxel_m).norm(),
            1e-12);
  EXPECT_LT((points[0].normal - Eigen::Vector3d::UnitZ()).norm(), 1e-6);
}

TEST(ContourPoints, OppositeNormalsAreNotAlike) {
  const auto points = group({{{0, 0, 0}, kUp}, {{1, 0, 0}, -kUp}, {{2, 0, 0}, kUp}});
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].voxels, 2U);
  EXPECT_GT(points[0].normal.z(), 0.99);
  EXPECT_LT(points[1].normal.z(), -0.99);
}

TEST(ContourPoints, SimilarIsNearerThanBothThresholds) {
  EXPECT_EQ(group({{{0, 0, 0}, kUp}, {{5, 0, 0}, kUp}}).size(), 1U);  // 25 mm
  EXPECT_EQ(group({{{0, 0, 0}, kUp}, {{4, 4, 2}, kUp}}).size(), 2U);  // 30 mm
  EXPECT_EQ(group({{{-9, 0, 0}, kUp}, {{-4, 3, 1}, kUp}}).size(), 1U);
  EXPECT_EQ(group({{{0, 0, 0}, kUp}, {{1, 0, 0}, tilted(29.9)}}).size(), 1U);
  EXPECT_EQ(group({{{0, 0, 0}, kUp}, {{1, 0, 0}, tilted(30.1)}}).size(), 2U);
  ContourConfig config;
  config.group_distance_m = 0.002;  // less than a voxel
  config.group_angle_rad = 0.5;
  EXPECT_EQ(group({{{0, 0, 0}, kUp}, {{1, 0, 0}, kUp}}, config).size(), 2U);
  config.group_distance_m = 1e9;
  EXPECT_EQ(group({{{-100000, 0, 0}, kUp}, {{100000, 0, 0}, kUp}}, config).size(), 1U);
}

TEST(ContourPoints, DoNotRunAlongAnEdge) {
  std::vector<ContourVoxel> edge;
  for (int x = -100; x < 100; ++x) edge.push_back({{x, 0, 0}, kUp});
  const auto points = group(edge);
  EXPECT_EQ(points.size(), 34U);  // groups of six voxels: the first, and five within 30 mm
  for (const ContourPoint& point : points) EXPECT_LE(point.voxels, 6U);
}

/// Against the same words over all pairs.
TEST(ContourPoints, EqualGroupsFoundWithoutCells) {
  std::mt19937 random{3};
  std::uniform_int_distribution<int> place{-30, 30};
  std::normal_distribution<float> direction;
  std::size_t groups{0};
  for (int run = 0; run < 20; ++run) {
    ContourConfig config;
    config.group_distance_m = 0.004 * (run + 1);
    config.group_angle_rad = 0.1 + 0.07 * run;
    std::vector<ContourVoxel> voxels(400);
    for (ContourVoxel& voxel : voxels) {
      voxel.voxel = {place(random), place(random), place(random)};
      voxel.normal = Eigen::Vector3f{direction(random), direction(random), direction(random)}.normalized();
    }
    std::vector<bool> taken(voxels.size());
    std::vector<std::uint32_t> sizes;
    std::vector<Eigen::Vector3d> means;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      if (taken[i]) continue;
      std::uint32_t count{0};
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t k = i; k < voxels.size(); ++k) {
        const Index3 d = voxels[k].voxel - voxels[i].voxel;
        const double distance_m = kContourVoxel_m * Eigen::Vector3d(d.x, d.y, d.z).norm();
        const double cosine = voxels[i].normal.cast<double>().dot(voxels[k].normal.cast<double>());
        const bool similar = distance_m < config.group_distance_m && cosine > std::cos(config.group_angle_rad);
        if (taken[k] || !(similar || k == i)) continue;
        taken[k] = true;
        ++count;
        sum += voxel_center(voxels[k].voxel, kContourVoxel_m);
      }
      sizes.push_back(count);
      means.push_back(sum / count);
    }
    const auto points = group(voxels, config);
    ASSERT_EQ(points.size(), sizes.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(points[i].voxels, sizes[i]);
      ASSERT_LT((points[i].position_m - means[i]).norm(), 1e-12);
      ASSERT_NEAR(points[i].normal.norm(), 1.0, 1e-12);
    }
    groups += points.size();
  }
  EXPECT_GT(groups, 1000U);
  EXPECT_LT(groups, 7000U);  // some voxels were alike
}

TEST(ContourPoints, OfNothingAreNoneAndBadConfigurationsABrokenContract) {
  EXPECT_TRUE(group({}).empty());
  ContourConfig config;
  config.group_angle_rad = 0.0;
  EXPECT_THROW(static_cast<void>(group({}, config)), ContractViolation);
  EXPECT_THROW(static_cast<void>(contour_points({}, 0.0, {})), ContractViolation);
}

}  // namespace
}  // namespace saccade
