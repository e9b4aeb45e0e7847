// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_places.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace saccade {
namespace {

constexpr std::size_t kSide{20};

/// A grid of a centimetre, each place as often as `copies` says.
std::vector<Eigen::Vector3f> grid(std::size_t copies) {
  std::vector<Eigen::Vector3f> positions_m;
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    const Eigen::Vector3f p{0.01F * static_cast<float>(i % kSide), 0.01F * static_cast<float>(i / kSide), 1.0F};
    for (std::size_t copy = 0; copy < copies; ++copy) positions_m.push_back(p);
  }
  return positions_m;
}

TEST(NearestPlaces, AreNearestNeighboursWhereNoPlaceIsCrowded) {
  for (const std::size_t copies : {1U, 3U}) {
    const std::vector<Eigen::Vector3f> positions_m = grid(copies);
    const NearestNeighbours plain = nearest_neighbours(positions_m, 10, Executor{});
    const NearestPlaces places = nearest_places(positions_m, 10, Executor::with_threads(2));
    EXPECT_TRUE(places.copies.empty());
    EXPECT_EQ(places.neighbours.nodes, plain.nodes);
    EXPECT_TRUE(std::equal(plain.order.begin(), plain.order.end(), places.neighbours.order.begin()));
  }
}

TEST(NearestPlaces, OnePointStandsForACrowdedPlace) {
  for (const std::size_t copies : {6U, 12U}) {
    const NearestPlaces places = nearest_places(grid(copies), 10, Executor::with_threads(2));
    const NearestNeighbours once = nearest_neighbours(grid(1), 10, Executor{});
    ASSERT_EQ(places.neighbours.order.size(), kSide * kSide);
    EXPECT_EQ(places.neighbours.nodes, once.nodes);
    ASSERT_EQ(places.copies.size(), (copies - 1) * kSide * kSide);
    for (std::size_t i = 0; i < places.copies.size(); ++i) {
      const std::size_t place = i / (copies - 1);
      EXPECT_EQ(places.copies[i].original, place * copies);
      EXPECT_EQ(places.copies[i].point, place * copies + 1 + i % (copies - 1));
    }
  }
}

TEST(NearestPlaces, PointsThatAreNoneAreNoCopies) {
  std::vector<Eigen::Vector3f> positions_m(9, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_TRUE(nearest_places(positions_m, 10, Executor{}).copies.empty());
  positions_m.resize(12, Eigen::Vector3f::Ones());
  const NearestPlaces places = nearest_places(positions_m, 10, Executor{});
  ASSERT_EQ(places.copies.size(), 2U);
  EXPECT_EQ(places.copies[1].point, 11U);
  EXPECT_EQ(places.copies[1].original, 9U);
  EXPECT_EQ(places.neighbours.count, 0U);
}

TEST(NearestPlaces, ThoseThatWereNotMeasuredStayAmongThemselves) {
  std::vector<Eigen::Vector3f> positions_m = grid(1);
  positions_m.resize(positions_m.size() + 50, Eigen::Vector3f::Zero());
  const NearestPlaces places = nearest_places(positions_m, 10, Executor{});
  EXPECT_TRUE(places.copies.empty());
  EXPECT_EQ(places.neighbours.nodes, nearest_neighbours(positions_m, 10, Executor{}).nodes);
}

}  // namespace
}  // namespace saccade
