// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_neighbours.hpp"

#include <gtest/gtest.h>

#include <map>

namespace saccade {
namespace {

/// By point.
std::map<std::uint32_t, float> radii_of(const std::vector<Eigen::Vector3f>& places_m, std::size_t k) {
  const NearestNeighbours near = nearest_neighbours(places_m, k, Executor{});
  const std::vector<float> radii_m = estimate_radii(near);
  std::map<std::uint32_t, float> by_point;
  for (std::size_t n = 0; n < radii_m.size(); ++n) by_point[near.order[n]] = radii_m[n];
  return by_point;
}

TEST(EstimatedRadii, AreOfTheFourthNearestAndBounded) {
  std::vector<Eigen::Vector3f> grid;
  for (int i = 0; i < 9; ++i) {
    for (int k = 0; k < 9; ++k) grid.emplace_back(0.5F * static_cast<float>(i), 0.5F * static_cast<float>(k), 0.0F);
  }
  grid.emplace_back(100.0F, 0.0F, 0.0F);
  const auto radii_m = radii_of(grid, 10);
  EXPECT_FLOAT_EQ(radii_m.at(4 * 9 + 4), 0.70710678F);
  EXPECT_FLOAT_EQ(radii_m.at(0), 1.4142136F);              // at a corner the fourth nearest is 1 away
  EXPECT_FLOAT_EQ(radii_m.at(81), 4.0F * 0.70710678F);     // a stray
  EXPECT_FLOAT_EQ(radii_of(grid, 2).at(40), 0.70710678F);  // the second nearest is as near
}

TEST(EstimatedRadii, OfFewPoints) {
  EXPECT_TRUE(radii_of({}, 10).empty());
  EXPECT_EQ(radii_of({{1.0F, 2.0F, 3.0F}}, 10).at(0), 0.0F);
  EXPECT_FLOAT_EQ(radii_of({{0.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}}, 10).at(1), 2.8284271F);
}

}  // namespace
}  // namespace saccade
