// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/annotation_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace saccade {
namespace {

using Labels = std::vector<std::uint32_t>;

constexpr std::uint32_t kEdge{21};

/// kEdge² points on a square lattice, a centimetre apart; 8 neighbours each inside.
PointCloud square_lattice() {
  PointCloud cloud;
  for (std::uint32_t y = 0; y < kEdge; ++y) {
    for (std::uint32_t x = 0; x < kEdge; ++x) {
      cloud.positions_m.emplace_back(0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y), 0.0F);
    }
  }
  return cloud;
}

std::uint32_t lattice_point(std::uint32_t x, std::uint32_t y) { return y * kEdge + x; }

Neighbourhood eight_nearest(const PointCloud& cloud, double max_path = 1.0) {
  NeighbourhoodConfig config;
  config.neighbours = 8;
  config.position_weight_per_m = 1.0;
  config.max_path = max_path;
  return Neighbourhood::build(cloud, config, Executor{}).value();
}

void fill_labels(Labels& labels, std::uint32_t left, std::uint32_t top, std::uint32_t right, std::uint32_t bottom,
                 std::uint32_t label) {
  for (std::uint32_t y = top; y < bottom; ++y) {
    for (std::uint32_t x = left; x < right; ++x) labels[lattice_point(x, y)] = label;
  }
}

TEST(AnnotationScore, IsCountedByHand) {
  const Labels truth{1, 1, 1, 2, 2, 7, 0, 0};
  const Labels given{1, 1, 2, 2, 0, 5, 7, 0};
  const AnnotationScore score = score_annotation(given, truth).value();
  EXPECT_EQ(score.points, 6U);
  EXPECT_EQ(score.wrong, 3U);
  ASSERT_EQ(score.objects.size(), 3U);
  EXPECT_EQ(score.objects[1].label, 2U);
  EXPECT_EQ(score.objects[1].points, 2U);
  EXPECT_EQ(score.objects[1].labelled, 2U);
  EXPECT_EQ(score.objects[1].shared, 1U);
  EXPECT_DOUBLE_EQ(score.objects[0].iou(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.objects[1].iou(), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.objects[2].iou(), 0.0);  // what has no truth counts for nothing
  EXPECT_DOUBLE_EQ(score.mean_iou, 1.0 / 3.0);
}

TEST(AnnotationScore, NoLabelMayStandForTheBackground) {
  const Labels truth{1, 1, 2, 2};
  const Labels given{0, 1, 0, 2};
  EXPECT_EQ(score_annotation(given, truth).value().wrong, 2U);
  const AnnotationScore score = score_annotation(given, truth, 1).value();
  EXPECT_EQ(score.wrong, 1U);
  EXPECT_DOUBLE_EQ(score.objects[0].iou(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.objects[1].iou(), 0.5);
}

TEST(AnnotationScore, NothingIsRightAndUnlikeNumbersAreRefused) {
  EXPECT_DOUBLE_EQ(score_annotation(Labels{}, Labels{}).value().mean_iou, 1.0);
  EXPECT_EQ(score_annotation(Labels{3}, Labels{0}).value().points, 0U);
  EXPECT_EQ(score_annotation(Labels{1}, Labels{}).error().code, Errc::size_mismatch);
  const Neighbourhood graph = eight_nearest(square_lattice());
  EXPECT_EQ(error_regions(graph, Labels{1}, Labels{1}).error().code, Errc::size_mismatch);
}

TEST(ErrorRegions, HangTogetherAndShareATruth) {
  Labels truth(kEdge * kEdge, 1);
  fill_labels(truth, 5, 0, 10, kEdge, 2);
  Labels given = truth;
  fill_labels(given, 2, 3, 7, 6, 9);      // 9 points of label 1 beside 6 of label 2
  fill_labels(given, 15, 15, 17, 17, 0);  // 4 of label 1
  const std::vector<ErrorRegion> regions = error_regions(eight_nearest(square_lattice()), given, truth).value();
  ASSERT_EQ(regions.size(), 3U);
  EXPECT_EQ(regions[0].truth, 1U);
  EXPECT_EQ(regions[0].points, Labels({lattice_point(2, 3), lattice_point(3, 3), lattice_point(4, 3),
                                       lattice_point(2, 4), lattice_point(3, 4), lattice_point(4, 4),
                                       lattice_point(2, 5), lattice_point(3, 5), lattice_point(4, 5)}));
  EXPECT_EQ(regions[1].truth, 2U);
  EXPECT_EQ(regions[1].points.size(), 6U);
  EXPECT_EQ(regions[2].points,
            Labels({lattice_point(15, 15), lattice_point(16, 15), lattice_point(15, 16), lattice_point(16, 16)}));
  EXPECT_EQ(error_regions(eight_nearest(square_lattice()), given, truth, 1).value().size(), 2U);
}

TEST(ErrorRegions, EdgesThatNoPathGoesAlongConnectNothing) {
  const Labels truth(kEdge * kEdge, 1);
  const Labels none(kEdge * kEdge, 0);
  EXPECT_EQ(error_regions(eight_nearest(square_lattice()), none, truth).value().size(), 1U);
  EXPECT_EQ(error_regions(eight_nearest(square_lattice(), 0.009), none, truth).value().size(), none.size());
}

TEST(RegionCentre, IsFarthestFromOtherPointsAndFromWhereTheCloudEnds) {
  const PointCloud cloud = square_lattice();
  const Neighbourhood graph = eight_nearest(cloud);
  const auto ends = cloud_ends(graph, cloud.positions_m, {});
  const Labels truth(kEdge * kEdge, 1);
  const auto centre_of = [&](const Labels& given) {
    return region_centre(graph, ends, error_regions(graph, given, truth).value().front());
  };
  Labels given = truth;
  fill_labels(given, 4, 5, 11, 12, 0);
  EXPECT_EQ(centre_of(given), lattice_point(7, 8));
  fill_labels(given, 0, 0, kEdge, kEdge, 0);
  EXPECT_EQ(centre_of(given), lattice_point(10, 10));
  given = truth;
  fill_labels(given, 0, 8, 9, 13, 0);                 // against the left border
  EXPECT_EQ(centre_of(given), lattice_point(3, 10));  // two columns are an end
  given = truth;
  given[lattice_point(3, 3)] = 0;
  EXPECT_EQ(centre_of(given), lattice_point(3, 3));
}

TEST(RegionCentre, OfASurfaceWithoutAnEndIsItsFirstPoint) {
  PointCloud sphere;
  constexpr int kPoints{500};
  for (int i = 0; i < kPoints; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kPoints;
    const double turn = 2.399963 * i;
    const double r = std::sqrt(1.0 - z * z);
    sphere.positions_m.push_back(Eigen::Vector3d{r * std::cos(turn), r * std::sin(turn), z}.cast<float>());
  }
  const Neighbourhood graph = eight_nearest(sphere);
  const Labels truth(kPoints, 4);
  const auto regions = error_regions(graph, Labels(kPoints, 0), truth).value();
  ASSERT_EQ(regions.size(), 1U);
  EXPECT_EQ(region_centre(graph, cloud_ends(graph, sphere.positions_m, sphere.positions_m), regions[0]), 0U);
}

TEST(CloudEnds, OfALatticeAreNowhereInsideAndMayBeLeftOut) {
  const PointCloud cloud = square_lattice();
  const Neighbourhood graph = eight_nearest(cloud);
  const auto ends = cloud_ends(graph, cloud.positions_m, std::vector<Eigen::Vector3f>(441, Eigen::Vector3f::UnitZ()));
  for (std::uint32_t y = 0; y < kEdge; ++y) {
    for (std::uint32_t x = 0; x < kEdge; ++x) {
      const std::uint32_t beside = std::min(std::min(x, kEdge - 1 - x), std::min(y, kEdge - 1 - y));
      if (beside == 0 || beside >= 3) {
        EXPECT_EQ(ends[lattice_point(x, y)], beside == 0 ? 1 : 0) << x << " " << y;
      }
    }
  }
  Labels given(kEdge * kEdge, 1);
  fill_labels(given, 0, 3, 9, 18, 0);
  const auto regions = error_regions(graph, given, Labels(kEdge * kEdge, 1)).value();
  EXPECT_LE(region_centre(graph, {}, regions.front()) % kEdge, 3U);
  EXPECT_GE(region_centre(graph, ends, regions.front()) % kEdge, 4U);
}

TEST(CloudEnds, AreFoundAtTheBorderOfScatteredPointsAndNotInside) {
  PointCloud cloud;
  std::mt19937 rng{3};
  std::uniform_real_distribution<float> place{0.0F, 1.0F};
  for (int i = 0; i < 20'000; ++i) cloud.positions_m.emplace_back(place(rng), place(rng), 0.0F);
  NeighbourhoodConfig config;
  const Neighbourhood graph = Neighbourhood::build(cloud, config, Executor{}).value();
  const auto ends = cloud_ends(graph, cloud.positions_m, {});
  constexpr double kSpacing{0.007};
  double at_border{0.0}, border{0.0}, at_inside{0.0}, inside{0.0};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Eigen::Vector3f& p = cloud.positions_m[i];
    const double beside = std::min(std::min(p.x(), 1.0F - p.x()), std::min(p.y(), 1.0F - p.y()));
    at_border += beside < 0.3 * kSpacing ? ends[i] : 0.0;
    at_inside += beside > 3.0 * kSpacing ? ends[i] : 0.0;
    border += beside < 0.3 * kSpacing ? 1.0 : 0.0;
    inside += beside > 3.0 * kSpacing ? 1.0 : 0.0;
  }
  EXPECT_GT(at_border / border, 0.97);
  EXPECT_LT(at_inside / inside, 0.03);
}

}  // namespace
}  // namespace saccade
