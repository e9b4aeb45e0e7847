// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/solids.hpp"

#include <gtest/gtest.h>

#include <random>

#include "saccade/scene/scene.hpp"
#include "support/brute_force_distance.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

TEST(MeshDistance, EqualsASearchThroughAllTriangles) {
  const TriangleMesh mesh = *tessellate(RevolutionShape{{{0.05, 0.0}, {0.06, 0.05}, {0.04, 0.12}}, 0.004}, 1e-3);
  const MeshDistance distance = *MeshDistance::build(mesh);
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> across{-0.2, 0.2};
  int beyond = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d p{across(random), across(random), across(random)};
    const double exact = test::brute_force_distance_m(mesh, p);
    EXPECT_NEAR(distance.distance_m(p, 1.0), exact, 1e-12);
    beyond += exact > 0.05 ? 1 : 0;
    EXPECT_NEAR(distance.distance_m(p, 0.05), std::min(exact, 0.05), 1e-12);
  }
  EXPECT_GT(beyond, 50);
}

TEST(MeshDistance, GivesTheSameDistancesForManyPoints) {
  const TriangleMesh mesh = *tessellate(RevolutionShape{{{0.05, 0.0}, {0.06, 0.05}, {0.04, 0.12}}, 0.004}, 1e-3);
  const MeshDistance distance = *MeshDistance::build(mesh);
  std::mt19937_64 random{5};
  std::uniform_real_distribution<float> across{-0.2F, 0.2F};
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 40; ++i) {  // jumps, then small steps; every seventh point on a vertex
    points.emplace_back(across(random), across(random), across(random));
    for (int k = 0; k < 20; ++k) {
      points.emplace_back(points.back() + 0.02F * Eigen::Vector3f{across(random), across(random), across(random)});
      if (k % 7 == 0) points.push_back(mesh.vertices[random() % mesh.vertices.size()]);
    }
  }
  for (const double beyond_m : {1.0, 0.05}) {
    const std::vector<double> together = distance.distances_m(points, beyond_m, Executor::with_threads(2));
    ASSERT_EQ(together.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(together[i], distance.distance_m(points[i].cast<double>(), beyond_m));
    }
  }
  EXPECT_TRUE(distance.distances_m({}, 1.0, Executor::with_threads(2)).empty());
}

TEST(MeshDistance, RefusesWhatIsNoMesh) {
  EXPECT_FALSE(MeshDistance::build(TriangleMesh{}));
  TriangleMesh dangling;
  dangling.vertices.resize(2, Eigen::Vector3f::Zero());
  dangling.triangles = {{0, 1, 2}};
  EXPECT_FALSE(MeshDistance::build(dangling));
}

}  // namespace
}  // namespace saccade
