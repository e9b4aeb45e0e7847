// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/segmented_points.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "saccade/cloud/point_cloud.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

SegmentedPoints points_of(const std::vector<Vector3f>& positions_m, const std::vector<std::uint32_t>& labels,
                          std::size_t segments) {
  return SegmentedPoints::create(positions_m, labels, segments).value();
}

std::uint32_t by_looking_at_all(const SegmentedPoints& points, const Vector3d& place_m) {
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t segment = kUnlabelled;
  for (std::size_t i = 0; i < points.positions_m().size(); ++i) {
    const double squared = (points.positions_m()[i].cast<double>() - place_m).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    segment = points.segment_of()[i];
  }
  return segment == points.segments() ? kUnlabelled : segment;
}

TEST(NearestSegments, AreThoseOfTheNearestOfAllPoints) {
  std::mt19937 random{3};
  std::uniform_real_distribution<float> in_room{-0.3F, 0.3F};
  std::vector<Vector3f> positions_m;
  std::vector<std::uint32_t> labels;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    positions_m.emplace_back(in_room(random), in_room(random), 0.2F * in_room(random));
    labels.push_back(i % 8 == 7 ? kUnlabelled : i % 8);
  }
  const SegmentedPoints points = points_of(positions_m, labels, 7);
  std::vector<Vector3d> places_m;
  for (int i = 0; i < 500; ++i) places_m.emplace_back(in_room(random), in_room(random), in_room(random));
  places_m.emplace_back(5.0, 5.0, 5.0);
  const std::vector<std::uint32_t> nearest = nearest_segments(points, places_m, Executor{});
  ASSERT_EQ(nearest.size(), places_m.size());
  std::size_t unlabelled{0};
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    EXPECT_EQ(nearest[i], by_looking_at_all(points, places_m[i])) << i;
    unlabelled += nearest[i] == kUnlabelled ? 1 : 0;
  }
  EXPECT_GT(unlabelled, 10U);
  EXPECT_LT(unlabelled, 200U);
  EXPECT_EQ(nearest, nearest_segments(points, places_m, Executor::with_threads(3)));
}

TEST(NearestSegments, OfEquallyNearPointsTheFirstCounts) {
  const SegmentedPoints points = points_of({{0.0F, 0.01F, 0.0F}, {0.0F, -0.01F, 0.0F}}, {1, 0}, 2);
  EXPECT_EQ(nearest_segments(points, std::vector{Vector3d{0.0, 0.0, 0.0}}, Executor{}), std::vector{0U});
}

TEST(NearestSegments, ThereIsNoneWithoutPoints) {
  EXPECT_EQ(nearest_segments(points_of({}, {}, 0), std::vector{Vector3d{1.0, 2.0, 3.0}}, Executor{}),
            std::vector{kUnlabelled});
}

TEST(NearestSegments, APointAKilometreAwayIsStillTheNearest) {
  const SegmentedPoints points = points_of({{1.0e6F, 0.0F, 0.0F}}, {0}, 1);
  EXPECT_EQ(nearest_segments(points, std::vector{Vector3d{0.0, 0.0, 0.0}}, Executor{}), std::vector{0U});
}

}  // namespace
}  // namespace saccade
