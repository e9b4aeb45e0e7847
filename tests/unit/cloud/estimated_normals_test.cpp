// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_neighbours.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "saccade/cloud/internal/smallest_eigenvectors.hpp"
#include "saccade/core/simd.hpp"

namespace saccade {
namespace {

/// Normals by the definition: those around, each as often as it is reached, and Eigen's eigenvectors.
Eigen::Vector3d normal_by_definition(const NearestNeighbours& neighbours, std::size_t node, int rounds) {
  std::vector<std::size_t> around{node};
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::size_t> wider;
    for (const std::size_t n : around) {
      wider.push_back(n);
      for (const std::uint32_t other : neighbours.of(n)) wider.push_back(other);
    }
    around = std::move(wider);
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::size_t n : around)
    mean += neighbours.positions_m[n].cast<double>() / static_cast<double>(around.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::size_t n : around) {
    const Eigen::Vector3d d = neighbours.positions_m[n].cast<double>() - mean;
    covariance += d * d.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{covariance}.eigenvectors().col(0);
}

std::vector<Eigen::Vector3f> noisy_sheet(std::size_t count, float noise_m) {
  std::mt19937 random{3};
  std::uniform_real_distribution<float> side{0.0F, 1.0F};
  std::normal_distribution<float> noise{0.0F, noise_m};
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = side(random);
    const float y = side(random);
    points.emplace_back(x, y, 100.0F + 0.3F * x * y + noise(random));
  }
  return points;
}

TEST(EstimatedNormals, AreThoseOfTheirDefinition) {
  const NearestNeighbours neighbours = nearest_neighbours(noisy_sheet(800, 0.004F), 10, Executor{});
  for (const int rounds : {1, 2, 3}) {
    const std::vector<Eigen::Vector3f> normals = estimate_normals(neighbours, rounds, Executor::with_threads(2));
    ASSERT_EQ(normals.size(), 800U);
    for (std::size_t node = 0; node < normals.size(); ++node) {
      const Eigen::Vector3d expected = normal_by_definition(neighbours, node, rounds);
      EXPECT_NEAR(std::abs(normals[node].cast<double>().dot(expected)), 1.0, 1e-3) << "node " << node;
    }
  }
}

TEST(EstimatedNormals, OfALineArePerpendicularToIt) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 50; ++i) points.emplace_back(static_cast<float>(i), 2.0F * static_cast<float>(i), 0.0F);
  const NearestNeighbours neighbours = nearest_neighbours(points, 5, Executor{});
  for (const Eigen::Vector3f& normal : estimate_normals(neighbours, 1, Executor{})) {
    EXPECT_NEAR(normal.norm(), 1.0F, 1e-5F);
    EXPECT_NEAR(normal.dot(Eigen::Vector3f{1.0F, 2.0F, 0.0F}), 0.0F, 1e-3F);
  }
}

TEST(EstimatedNormals, AreZeroWherePointsCoincideOrAreAlone) {
  const std::vector<Eigen::Vector3f> same(20, Eigen::Vector3f{1.0F, 2.0F, 3.0F});
  for (const auto& points : {same, std::vector<Eigen::Vector3f>(same.begin(), same.begin() + 2)}) {
    const auto normals = estimate_normals(nearest_neighbours(points, 5, Executor{}), 2, Executor{});
    ASSERT_EQ(normals.size(), points.size());
    for (const Eigen::Vector3f& normal : normals) EXPECT_TRUE(normal.isZero(0.0F));
  }
}

TEST(EstimatedNormals, AreTheSameOnEveryInstructionSetAndForEveryThreadCount) {
  const NearestNeighbours neighbours = nearest_neighbours(noisy_sheet(5'003, 0.004F), 10, Executor{});
  const std::vector<Eigen::Vector3f> widest = estimate_normals(neighbours, 2, Executor::with_threads(3));
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target).ok());
    EXPECT_EQ(estimate_normals(neighbours, 2, Executor{}), widest) << target;
  }
  ASSERT_TRUE(use_simd_target("").ok());
}

TEST(LeastDirections, AreEigenvectorsOfLeastEigenvalues) {
  std::mt19937 random{5};
  std::normal_distribution<float> normal;
  for (int i = 0; i < 2000; ++i) {
    Covariances covariances{};
    std::array<Eigen::Matrix3d, Covariances::kCount> expected;
    for (std::size_t lane = 0; lane < Covariances::kCount; ++lane) {
      // Spreads from a millionth of the largest upwards; every fourth is flat, or a line.
      const float thin = i % 4 == 0 ? 0.0F : std::pow(10.0F, -3.0F * std::abs(normal(random)));
      const float middle = i % 4 == 0 && i % 8 == 0 ? 0.0F : 1.0F;
      Eigen::Matrix3f axes = Eigen::Matrix3f::Zero();
      for (Eigen::Index c = 0; c < 9; ++c) axes(c) = normal(random);
      axes = axes.householderQr().householderQ();
      const Eigen::Vector3f spread{thin, std::max(thin, middle), 2.0F};
      const Eigen::Matrix3f covariance = std::exp(normal(random)) * (axes * spread.asDiagonal() * axes.transpose());
      std::size_t entry{0};
      for (Eigen::Index row = 0; row < 3; ++row) {
        for (Eigen::Index column = row; column < 3; ++column) {
          covariances.entries[entry++][lane] = covariance(row, column);
          expected[lane](row, column) = expected[lane](column, row) = static_cast<double>(covariance(row, column));
        }
      }
    }
    const Directions directions = smallest_eigenvectors(covariances);
    for (std::size_t lane = 0; lane < Covariances::kCount; ++lane) {
      const Eigen::Vector3d found{directions.xyz[0][lane], directions.xyz[1][lane], directions.xyz[2][lane]};
      const double trace = expected[lane].trace();
      const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{expected[lane]}.eigenvalues()[0];
      EXPECT_NEAR(found.norm(), 1.0, 1e-6);
      EXPECT_NEAR(found.dot(expected[lane] * found) / trace, least / trace, 2e-6);
    }
  }
}

TEST(LeastDirections, OfWhatHasNoneAreZero) {
  Covariances covariances{};  // lane 0: zero
  for (const std::size_t diagonal : {0U, 3U, 5U}) covariances.entries[diagonal] = {0.0F, 0.0F, -1.0F, 1.0F, 1e30F};
  covariances.entries[1][3] = std::numeric_limits<float>::quiet_NaN();
  covariances.entries[4][4] = std::numeric_limits<float>::infinity();
  const Directions directions = smallest_eigenvectors(covariances);
  for (const auto& component : directions.xyz) {
    for (const float value : component) EXPECT_EQ(value, 0.0F);
  }
}

}  // namespace
}  // namespace saccade
