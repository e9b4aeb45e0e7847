// SPDX-License-Identifier: Apache-2.0
// Convexity between supervoxels that are placed by hand.
#include "saccade/segment/lccp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

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

/// Segments by the rule, one search of all edges after the other.
std::vector<std::uint32_t> join_small_by_search(const SupervoxelResult& from, std::vector<std::uint32_t> set_of,
                                                std::size_t fewest) {
  std::vector<bool> alone(set_of.size());
  for (;;) {
    std::vector<std::size_t> sizes(set_of.size(), 0);
    for (const std::uint32_t set : set_of) sizes[set] += 1;
    std::uint32_t least{kUnlabelled};
    for (std::uint32_t s = 0; s < set_of.size(); ++s) {
      if (sizes[s] == 0 || sizes[s] >= fewest || alone[s]) continue;
      if (least == kUnlabelled || sizes[s] < sizes[least]) least = s;
    }
    if (least == kUnlabelled) return set_of;
    std::uint32_t largest{kUnlabelled};
    for (const auto& [first, second] : from.edges) {
      if ((set_of[first] == least) == (set_of[second] == least)) continue;
      const std::uint32_t other = set_of[first] == least ? set_of[second] : set_of[first];
      if (largest == kUnlabelled || sizes[other] > sizes[largest] ||
          (sizes[other] == sizes[largest] && other < largest)) {
        largest = other;
      }
    }
    if (largest == kUnlabelled) alone[least] = true;
    const std::uint32_t gone = largest == kUnlabelled ? least : std::max(least, largest);
    const std::uint32_t kept = largest == kUnlabelled ? least : std::min(least, largest);
    for (std::uint32_t& set : set_of) set = set == gone ? kept : set;
  }
}

TEST(Lccp, SmallSegmentsOfRandomGraphsJoinByTheRule) {
  std::mt19937 random{1};
  std::size_t joined{0};
  for (int run = 0; run < 300; ++run) {
    const auto count = static_cast<std::uint32_t>(1 + random() % 60);
    SupervoxelResult made = graph(std::vector<Supervoxel>(count), {});
    std::vector<bool> convex;
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a + 1; b < count; ++b) {
        if (random() % count >= 2) continue;
        made.edges.emplace_back(a, b);
        convex.push_back(random() % 3 == 0);
      }
    }
    LccpConfig config;
    const LccpResult before = join_convex(made, convex, config);
    std::vector<std::uint32_t> first_of(before.segments, kUnlabelled);
    std::vector<std::uint32_t> set_of(count);
    for (std::uint32_t s = 0; s < count; ++s) {
      std::uint32_t& first = first_of[before.segment_of[s]];
      first = std::min(first, s);
      set_of[s] = first;
    }
    config.min_supervoxels = 2 + random() % 5;
    const std::vector<std::uint32_t> expected = join_small_by_search(made, set_of, config.min_supervoxels);
    const LccpResult found = join_convex(made, convex, config);
    for (std::uint32_t s = 0; s < count; ++s) {
      ASSERT_EQ(found.segment_of[s], found.segment_of[expected[s]]) << run;
      joined += expected[s] != set_of[s] ? 1 : 0;
    }
    ASSERT_EQ(found.segments, std::set(expected.begin(), expected.end()).size()) << run;
  }
  EXPECT_GT(joined, 1000U);
}

}  // namespace
}  // namespace saccade
