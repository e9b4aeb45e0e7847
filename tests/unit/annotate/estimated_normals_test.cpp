// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/estimated_normals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

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

}  // namespace
}  // namespace saccade
