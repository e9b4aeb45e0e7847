// SPDX-License-Identifier: Apache-2.0
// Boundaries held to eq. (4.16) word by word; their matching to the least assignment of all.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>

#include "saccade/segment/internal/boundary.hpp"
#include "saccade/segment/internal/boundary_matching.hpp"
#include "saccade/segment/internal/least_assignment.hpp"
#include "support/effort.hpp"
#include "support/naive_surfels.hpp"

namespace saccade::test {
namespace {

/// In a flat box, on a lattice in every second case, where many distances are equal.
std::vector<Eigen::Vector3f> random_places(std::mt19937& random, bool on_lattice, std::size_t count, double size_m) {
  std::vector<Eigen::Vector3f> places;
  std::uniform_real_distribution<double> along{-size_m, size_m};
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p{along(random), along(random), 0.1 * along(random)};
    if (on_lattice) p = (p / 0.0078125).array().round() * 0.0078125;
    places.push_back(p.cast<float>());
  }
  return places;
}

TEST(BoundaryProperty, IsThatOfTheEquationForEveryThreadCount) {
  std::mt19937 random{416};
  const int cases = scaled_cases(120);
  std::size_t compared{0}, near{0};
  for (int i = 0; i < cases; ++i) {
    const std::vector<Eigen::Vector3f> places = random_places(random, i % 2 == 0, 300, 0.02 + 0.05 * (i % 3));
    std::vector<std::uint32_t> labels, points;
    const double slant = std::uniform_real_distribution<double>{-1.0, 1.0}(random);
    for (std::uint32_t p = 0; p < places.size(); ++p) {  // regions, and a few strays
      const auto side = static_cast<double>(places[p].x()) + slant * static_cast<double>(places[p].y());
      labels.push_back(random() % 20 == 0 ? static_cast<std::uint32_t>(random() % 3) : (side > 0.0 ? 1U : kUnlabelled));
      if (random() % 10 != 0) points.push_back(p);
    }
    for (const double reach_m : {0.02, 0.0078125}) {
      const std::set<std::uint32_t> expected = naive_boundary(places, points, labels, reach_m);
      for (const std::size_t threads : {1U, 3U}) {
        const Executor executor = Executor::with_threads(threads);
        const BoundaryFinder finder = BoundaryFinder::create(places, points, reach_m, executor).value();
        const std::vector<std::uint32_t> found = finder.boundary(labels, executor);
        ASSERT_EQ(std::set<std::uint32_t>(found.begin(), found.end()), expected) << "case " << i;
        ASSERT_EQ(found.size(), expected.size());
        compared += 1;
        near += found.size();
      }
    }
  }
  EXPECT_EQ(compared, static_cast<std::size_t>(cases) * 4);
  EXPECT_GT(near, 20 * compared);
}

/// Returns the optimal assignment by brute force: as many pairs within the tolerance as possible, with the smallest sum
/// of distances.
std::pair<std::size_t, double> least_of_all(const std::vector<Eigen::Vector3f>& places,
                                            const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b,
                                            double tolerance_m) {
  constexpr double kTooFar{1e3};
  Eigen::MatrixXd costs(static_cast<Eigen::Index>(a.size()), static_cast<Eigen::Index>(b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      const double distance_m = (places[a[i]].cast<double>() - places[b[k]].cast<double>()).norm();
      costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          distance_m <= tolerance_m ? distance_m : kTooFar;
    }
  }
  const std::vector<std::size_t> column_of = least_assignment(costs);
  std::pair<std::size_t, double> found{0, 0.0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double cost = costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(column_of[i]));
    if (cost >= kTooFar) continue;
    found.first += 1;
    found.second += cost;
  }
  return found;
}

TEST(BoundaryProperty, MatchingIsTheLeastWhereExactAndHasAsManyPairsElsewhere) {
  std::mt19937 random{100};
  const int cases = scaled_cases(200);
  std::size_t pairs{0}, large{0};
  double least_m{0.0}, nearest_first_m{0.0}, worst{1.0};
  for (int i = 0; i < cases; ++i) {
    const std::size_t of_a = 40 + random() % 40;
    const std::size_t of_b = of_a + random() % 40;
    const std::vector<Eigen::Vector3f> places =
        random_places(random, i % 3 == 0, of_a + of_b, i % 2 == 0 ? 0.05 : 0.15);
    std::vector<std::uint32_t> a, b;
    for (std::uint32_t p = 0; p < of_a + of_b; ++p) (p < of_a ? a : b).push_back(p);
    const auto [count, sum_m] = least_of_all(places, a, b, 0.02);
    const BoundaryMatching exact = match_boundaries(places, a, b, {0.02, 4096}).value();
    ASSERT_EQ(exact.exact_clusters, exact.clusters);
    ASSERT_EQ(exact.pairs.size(), count) << "case " << i;
    ASSERT_NEAR(exact.distance_m, sum_m, 1e-9) << "case " << i;
    const BoundaryMatching turned = match_boundaries(places, b, a, {0.02, 4096}).value();
    ASSERT_EQ(turned.pairs.size(), count);
    ASSERT_NEAR(turned.distance_m, sum_m, 1e-9);
    const BoundaryMatching quick = match_boundaries(places, a, b, {0.02, 0}).value();
    ASSERT_EQ(quick.pairs.size(), count) << "case " << i;
    ASSERT_EQ(quick.exact_clusters, 0U);
    ASSERT_GE(quick.distance_m, sum_m - 1e-9);
    std::set<std::uint32_t> met;
    for (const auto& [of_first, of_second] : quick.pairs) {
      ASSERT_LE((places[of_first] - places[of_second]).norm(), 0.02F * 1.00001F);
      ASSERT_TRUE(met.insert(of_first).second && met.insert(of_second).second) << "taken twice";
      ASSERT_TRUE(of_first < of_a && of_second >= of_a);
    }
    const BoundaryMatching mixed = match_boundaries(places, a, b, {0.02, 20}).value();
    ASSERT_EQ(mixed.pairs.size(), count);
    ASSERT_LE(mixed.distance_m, quick.distance_m + 1e-9);
    large += mixed.clusters - mixed.exact_clusters;
    pairs += count;
    least_m += sum_m;
    nearest_first_m += quick.distance_m;
    worst = std::max(worst, quick.distance_m / sum_m);
  }
  RecordProperty("sum_over_least", std::to_string(nearest_first_m / least_m));
  std::cout << "nearest first: " << nearest_first_m / least_m << " times the least sum, at worst " << worst << '\n';
  EXPECT_GT(pairs, 20U * static_cast<std::size_t>(cases));
  EXPECT_GT(large, static_cast<std::size_t>(cases) / 4);
  EXPECT_LT(nearest_first_m, 1.2 * least_m);
  EXPECT_LT(worst, 1.6);
}

}  // namespace
}  // namespace saccade::test
