// SPDX-License-Identifier: Apache-2.0
// Convexity between supervoxels that are placed by hand.
#include "saccade/segment/lccp.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

Supervoxel patch(const Eigen::Vector3f& centroid_m, const Eigen::Vector3f& normal) {
  return {centroid_m, normal.normalized(), Eigen::Vector3f::Zero(), 1, 1};
}

/// One point per supervoxel.
SupervoxelResult graph(std::vector<Supervoxel> patches, std::vector<std::pair<std::uint32_t, std::uint32_t>> edges) {
  SupervoxelResult made;
  for (std::uint32_t i = 0; i < patches.size(); ++i) made.labels.push_back(i);
  made.supervoxels = std::move(patches);
  made.edges = std::move(edges);
  made.voxel_size_m = 0.01;
  return made;
}

/// Two patches, one on either side of an edge along y, each turned by half the angle; negative: concave.
SupervoxelResult roof(double angle_deg) {
  const auto half = static_cast<float>(angle_deg * std::numbers::pi / 360.0);
  const float slope = std::sin(half);
  return graph({patch({-0.02F * std::cos(half), 0.0F, -0.02F * slope}, {-slope, 0.0F, std::cos(half)}),
                patch({0.02F * std::cos(half), 0.0F, -0.02F * slope}, {slope, 0.0F, std::cos(half)})},
               {{0, 1}});
}

TEST(Lccp, ConvexAndFlatJoinConcaveBeyondTheToleranceDivides) {
  for (const double angle_deg : {0.0, 5.0, 45.0, 90.0, -9.0}) {
    EXPECT_EQ(segment_by_convexity(roof(angle_deg)).value().segments, 1U) << angle_deg;
  }
  for (const double angle_deg : {-11.0, -45.0, -90.0}) {
    const LccpResult found = segment_by_convexity(roof(angle_deg)).value();
    EXPECT_EQ(found.segments, 2U) << angle_deg;
    EXPECT_FALSE(found.convex[0]);
  }
}

TEST(Lccp, PatchesThatTouchAtACornerOnlyAreKeptApartBySanity) {
  // Normals lean along x, centroids lie along y, which is where the planes meet.
  const SupervoxelResult corner =
      graph({patch({0.0F, 0.0F, 0.0F}, {-0.5F, 0.0F, 1.0F}), patch({0.0F, 0.03F, 0.0F}, {0.5F, 0.0F, 1.0F})}, {{0, 1}});
  EXPECT_EQ(segment_by_convexity(corner).value().segments, 2U);
  LccpConfig without;
  without.sanity = false;
  EXPECT_EQ(segment_by_convexity(corner, without).value().segments, 1U);
}

TEST(Lccp, ExtendedConvexityNeedsACommonNeighbour) {
  const SupervoxelResult row = graph(
      {patch({0.0F, 0.0F, 0.0F}, Eigen::Vector3f::UnitZ()), patch({0.03F, 0.0F, 0.0F}, Eigen::Vector3f::UnitZ()),
       patch({0.015F, 0.02F, 0.0F}, Eigen::Vector3f::UnitZ()), patch({0.06F, 0.0F, 0.0F}, Eigen::Vector3f::UnitZ())},
      {{0, 1}, {0, 2}, {1, 2}, {1, 3}});
  LccpConfig extended;
  extended.extended_convexity = true;
  EXPECT_EQ(segment_by_convexity(row).value().segments, 1U);
  const LccpResult found = segment_by_convexity(row, extended).value();
  EXPECT_EQ(found.segment_of, (std::vector<std::uint32_t>{0, 0, 0, 1}));
  EXPECT_EQ(found.convex, (std::vector<bool>{true, true, true, false}));
}

TEST(Lccp, SmallSegmentsJoinTheLargestOneThatTheyTouch) {
  // A step up to one patch between three on the left and one on the right; one stands alone.
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const SupervoxelResult row =
      graph({patch({0.0F, 0.0F, 0.0F}, up), patch({0.03F, 0.0F, 0.0F}, up), patch({0.06F, 0.0F, 0.0F}, up),
             patch({0.09F, 0.0F, 0.02F}, up), patch({0.12F, 0.0F, 0.0F}, up), patch({0.5F, 0.0F, 0.0F}, up)},
            {{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  EXPECT_EQ(segment_by_convexity(row).value().segments, 4U);
  LccpConfig config;
  config.min_supervoxels = 2;
  EXPECT_EQ(segment_by_convexity(row, config).value().segment_of, (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace saccade
