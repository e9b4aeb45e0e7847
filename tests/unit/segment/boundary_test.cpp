// SPDX-License-Identifier: Apache-2.0
// Boundaries, their matching and BCE, by hand.
#include "saccade/segment/internal/boundary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "saccade/segment/internal/boundary_matching.hpp"
#include "saccade/segment/internal/least_assignment.hpp"
#include "saccade/segment/overlap.hpp"

namespace saccade {
namespace {

using Points = std::vector<std::uint32_t>;
using Places = std::vector<Eigen::Vector3f>;

Places along_x(const std::vector<float>& places_m) {
  Places places;
  for (const float x : places_m) places.emplace_back(x, 0.0F, 0.0F);
  return places;
}

Points boundary_of(const Places& places_m, const Points& labels, double reach_m) {
  Points all(places_m.size());
  std::iota(all.begin(), all.end(), 0U);
  return BoundaryFinder::create(places_m, all, reach_m, Executor{}).value().boundary(labels, Executor{});
}

TEST(Boundary, IsTheNearestPointsWithAnotherLabel) {
  const Places row = along_x({0.0F, 0.25F, 0.5F, 0.75F, 1.0F, 1.25F});
  EXPECT_EQ(boundary_of(row, {4, 4, 4, 9, 9, 9}, 0.75), (Points{2, 3}));
  EXPECT_EQ(boundary_of(row, {4, 4, 4, 9, 9, 9}, 0.25), Points{});  // 0.25 is not closer than 0.25
  EXPECT_EQ(boundary_of(row, {4, 4, 4, 4, 4, 4}, 9.0), Points{});
  EXPECT_EQ(boundary_of(row, {4, 4, kUnlabelled, kUnlabelled, 4, 4}, 0.3), (Points{1, 2, 3, 4}));
}

TEST(Boundary, OfEquallyNearPointsItIsTheFirst) {
  const Places row = along_x({-0.5F, 0.0F, 0.5F});
  EXPECT_EQ(boundary_of(row, {1, 2, 1}, 0.6), (Points{0, 1}));
}

TEST(Boundary, OnlyPointsThatCountTakePart) {
  const Places row = along_x({0.0F, 0.25F, std::numeric_limits<float>::quiet_NaN(), 0.5F});
  const BoundaryFinder finder = BoundaryFinder::create(row, Points{0, 3}, 0.6, Executor{}).value();
  EXPECT_EQ(finder.boundary(Points{1, 2, 3, 4}, Executor{}), (Points{0, 3}));
  EXPECT_EQ(finder.boundary(Points{1, 2, 3, 1}, Executor{}), Points{});
  EXPECT_EQ(BoundaryFinder::create(row, Points{}, 0.6, Executor{}).value().boundary(Points(4, 1), Executor{}),
            Points{});
}

TEST(Boundary, RefusesWhatCannotBe) {
  for (const double reach_m : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(BoundaryFinder::create({}, {}, reach_m, Executor{}).error().code, Errc::invalid_argument) << reach_m;
    EXPECT_EQ(match_boundaries({}, {}, {}, {reach_m, 10}).error().code, Errc::invalid_argument) << reach_m;
  }
  EXPECT_EQ(match_boundaries({}, {}, {}, {0.02, 5000}).error().code, Errc::invalid_argument);
  EXPECT_NE(BoundaryFinder::create(along_x({1e9F}), Points{0}, 0.02, Executor{}).error().message.find("farther"),
            std::string::npos);
}

TEST(BoundaryMatching, MakesAsManyPairsAsCanBe) {
  // The nearest pair (1, 2) would leave 0 and 3 alone; there are two pairs.
  const Places row = along_x({0.0F, 1.0F, 0.75F, 1.75F});
  for (const std::size_t exact_cluster : {std::size_t{0}, std::size_t{256}}) {
    const BoundaryMatching matching = match_boundaries(row, Points{0, 1}, Points{2, 3}, {0.75, exact_cluster}).value();
    EXPECT_EQ(matching.pairs, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 2}, {1, 3}}));
    EXPECT_DOUBLE_EQ(matching.distance_m, 1.5);
    EXPECT_EQ(matching.clusters, 1U);
    EXPECT_EQ(matching.exact_clusters, exact_cluster > 0 ? 1U : 0U);
  }
}

TEST(BoundaryMatching, TheToleranceItselfIsNear) {
  const Places row = along_x({0.0F, 0.5F, 2.0F});
  EXPECT_EQ(match_boundaries(row, Points{0}, Points{1}, {0.5, 256}).value().pairs.size(), 1U);
  EXPECT_EQ(match_boundaries(row, Points{0}, Points{1}, {0.4999, 256}).value().pairs.size(), 0U);
  EXPECT_EQ(match_boundaries(row, Points{0}, Points{2}, {0.5, 256}).value().clusters, 0U);
  EXPECT_EQ(match_boundaries(row, Points{}, Points{2}, {0.5, 256}).value().pairs.size(), 0U);
  EXPECT_EQ(match_boundaries(row, Points{1, 2}, Points{1, 2}, {0.5, 256}).value().distance_m, 0.0);  // with themselves
}

TEST(BoundaryMatching, NearestFirstIsNotAlwaysLeast) {
  // 1 and 2 are the nearest; the least sum pairs 0 with 2 and 1 with 3: 0.75 + 0.5 against 0.25 + 1.5.
  const Places row = along_x({0.0F, 1.0F, 0.75F, 1.5F});
  EXPECT_DOUBLE_EQ(match_boundaries(row, Points{0, 1}, Points{2, 3}, {2.0, 0}).value().distance_m, 1.75);
  EXPECT_DOUBLE_EQ(match_boundaries(row, Points{0, 1}, Points{2, 3}, {2.0, 4}).value().distance_m, 1.25);
}

TEST(LeastAssignment, IsTheBestOfAllPermutations) {
  std::size_t compared{0};
  for (int seed = 0; seed < 300; ++seed) {
    std::srand(static_cast<unsigned>(seed));
    const Eigen::Index rows = 1 + seed % 5;
    const Eigen::Index columns = rows + seed % 3;
    const Eigen::MatrixXd costs = Eigen::MatrixXd::Random(rows, columns).cwiseAbs().array().pow(seed % 4);
    const auto sum_of = [&](const std::vector<std::size_t>& column_of) {
      double sum{0.0};
      for (Eigen::Index row = 0; row < rows; ++row) {
        sum += costs(row, static_cast<Eigen::Index>(column_of[static_cast<std::size_t>(row)]));
      }
      return sum;
    };
    std::vector<std::size_t> order(static_cast<std::size_t>(columns));
    std::iota(order.begin(), order.end(), std::size_t{0});
    double least = sum_of(order);
    while (std::next_permutation(order.begin(), order.end())) least = std::min(least, sum_of(order));
    const std::vector<std::size_t> found = least_assignment(costs);
    EXPECT_NEAR(sum_of(found), least, 1e-12) << seed;
    std::vector<std::size_t> taken = found;
    std::sort(taken.begin(), taken.end());
    EXPECT_EQ(std::adjacent_find(taken.begin(), taken.end()), taken.end()) << seed;
    compared += 1;
  }
  EXPECT_EQ(compared, 300U);
}

/// Martin's BCE: the mean over the points of the larger of |R₁ ∖ R₂| / |R₁| and |R₂ ∖ R₁| / |R₂|, with R the segments
/// that a point is in.
TEST(ConsistencyError, IsThatOfTheDefinition) {
  std::mt19937_64 random{5};
  for (int i = 0; i < 40; ++i) {
    std::vector<std::uint32_t> a(60);
    std::vector<std::uint32_t> b(60);
    for (std::size_t k = 0; k < a.size(); ++k) {
      a[k] = static_cast<std::uint32_t>(random() % 6);
      b[k] = random() % 3 == 0 ? static_cast<std::uint32_t>(random() % 9) : a[k];
    }
    double sum{0.0};
    for (std::size_t p = 0; p < a.size(); ++p) {
      double in_a{0.0};
      double in_b{0.0};
      double only_a{0.0};
      double only_b{0.0};
      for (std::size_t q = 0; q < a.size(); ++q) {
        in_a += a[q] == a[p] ? 1.0 : 0.0;
        in_b += b[q] == b[p] ? 1.0 : 0.0;
        only_a += a[q] == a[p] && b[q] != b[p] ? 1.0 : 0.0;
        only_b += b[q] == b[p] && a[q] != a[p] ? 1.0 : 0.0;
      }
      sum += std::max(only_a / in_a, only_b / in_b);
    }
    ASSERT_NEAR(consistency_error(a, b).value().bidirectional, sum / 60.0, 1e-12) << i;
  }
}

TEST(ConsistencyError, IsCountedByHand) {
  const auto bce = [](const Points& segments, const Points& truth) {
    return consistency_error(segments, truth).value().bidirectional;
  };
  EXPECT_DOUBLE_EQ(bce({7, 7, 3, 3}, {1, 1, 2, 2}), 0.0);
  EXPECT_DOUBLE_EQ(bce({1, 2, 3, 4}, {1, 1, 1, 1}), 0.75);  // all apart; LCE would be 0
  EXPECT_DOUBLE_EQ(bce({1, 1, 1, 1}, {1, 2, 3, 4}), 0.75);  // all one
  // Truth {0 1 2 3} {4 5}, segments {0 1 2} {3 4 5}: three points 1 − 3/4, one 1 − 1/4, two 1 − 2/3.
  EXPECT_DOUBLE_EQ(bce({5, 5, 5, 6, 6, 6}, {1, 1, 1, 1, 2, 2}), (3.0 * 0.25 + 0.75 + 2.0 / 3.0) / 6.0);
  EXPECT_DOUBLE_EQ(bce({5, 5, 5}, {1, 1, kUnlabelled}), 0.0);  // a point that is not labelled is none
  EXPECT_DOUBLE_EQ(bce({5, kUnlabelled, kUnlabelled}, {1, 2, 2}), 0.0);
  EXPECT_EQ(consistency_error(Points{1}, Points{kUnlabelled}).value().points, 0U);
  EXPECT_EQ(consistency_error(Points{1}, Points{}).error().code, Errc::size_mismatch);
}

}  // namespace
}  // namespace saccade
