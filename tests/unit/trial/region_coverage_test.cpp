// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "saccade/scene/solids.hpp"
#include "support/brute_force_distance.hpp"
#include "support/effort.hpp"
#include "support/placed_object.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using test::placed;

constexpr double kCovered_m{0.006};
constexpr double kPointSpacing_m{test::kSanitized ? 0.012 : 0.005};

/// A block and a tin, 30 cm apart on a table.
const RayScene& two_on_a_table() {
  static const RayScene made = [] {
    Scene scene;
    scene.name = "two";
    scene.workspace = Box{{-0.35, -0.2, -0.03}, {0.35, 0.2, 0.25}};
    SceneObject table = placed("table", BoxShape{{0.8, 0.6, 0.04}}, {0.0, 0.0, -0.04});
    table.support = true;
    scene.objects = {table, placed("block", BoxShape{{0.1, 0.08, 0.12}}, {-0.15, 0.0, 0.0}),
                     placed("tin", CylinderShape{0.04, 0.1}, {0.15, 0.0, 0.0})};
    return *RayScene::build(scene);
  }();
  return made;
}

const Sphere kAroundBlock{{-0.15, 0.0, 0.05}, 0.15};

const RegionSurface& around_block() {
  static const RegionSurface made =
      *observable_in(two_on_a_table(), kAroundBlock, kPointSpacing_m, Executor::with_threads(2));
  return made;
}

TriangleMesh only(const std::vector<std::size_t>& objects) {
  return joined_mesh(two_on_a_table().meshes(),
                     [&](std::size_t i) { return std::find(objects.begin(), objects.end(), i) != objects.end(); });
}

RegionCoverage coverage(const TriangleMesh& mesh) {
  return measure_coverage(around_block(), mesh, kCovered_m, Executor::with_threads(2));
}

TEST(RegionCoverage, PointsAreThoseOfTheTruthInTheRegion) {
  const GroundTruth truth = *GroundTruth::build(two_on_a_table(), kPointSpacing_m, Executor{});
  std::vector<Eigen::Vector3f> expected;
  for (const Eigen::Vector3f& p : truth.observable_points()) {
    if (contains(kAroundBlock, p.cast<double>())) expected.push_back(p);
  }
  EXPECT_EQ(around_block().of_objects, expected);
  EXPECT_LT(expected.size(), truth.observable_points().size());
  EXPECT_GT(expected.size(), test::kSanitized ? 100U : 1000U);
  EXPECT_GT(around_block().of_supports.size(), test::kSanitized ? 100U : 1000U);
  for (const Eigen::Vector3f& p : around_block().of_supports) {
    EXPECT_NEAR(p.z(), 0.0F, 1e-6F);                                               // the top, not the underside
    EXPECT_FALSE(std::abs(p.x() + 0.15F) < 0.0499F && std::abs(p.y()) < 0.0399F);  // nor what the block stands on
  }
}

TEST(RegionCoverage, CountsObjectsAloneAndWithTheTable) {
  EXPECT_EQ(coverage(only({0, 1, 2})).objects, 1.0);
  EXPECT_EQ(coverage(only({0, 1, 2})).surfaces, 1.0);

  const auto share = static_cast<double>(around_block().of_objects.size()) /
                     static_cast<double>(around_block().of_objects.size() + around_block().of_supports.size());
  const RegionCoverage block = coverage(only({1}));
  EXPECT_EQ(block.objects, 1.0);
  EXPECT_NEAR(*block.surfaces, share, 0.05);  // and the table within a voxel of its foot
  EXPECT_GT(*block.surfaces, share);

  const RegionCoverage table = coverage(only({0}));
  EXPECT_LT(*table.objects, 0.1);
  EXPECT_NEAR(*table.surfaces, 1.0 - share, 0.05);

  const RegionCoverage elsewhere = coverage(only({2}));
  EXPECT_EQ(elsewhere.objects, 0.0);
  EXPECT_EQ(elsewhere.surfaces, 0.0);
  EXPECT_EQ(coverage(TriangleMesh{}).objects, 0.0);
  EXPECT_EQ(coverage(TriangleMesh{}).surfaces, 0.0);
}

TEST(RegionCoverage, EqualsANaiveCount) {
  // Half of the block, moved by half a voxel: the other half lies beyond a voxel but for a margin.
  TriangleMesh mesh = only({1, 2});
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex += Eigen::Vector3f{0.003F, 0.0F, vertex.x() < -0.16F ? 0.02F : 0.0F};
  const auto naive = [&](const std::vector<Eigen::Vector3f>& points) {
    return std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3f& p) {
      return test::brute_force_distance_m(mesh, p.cast<double>()) <= kCovered_m;
    });
  };
  const auto objects = static_cast<double>(naive(around_block().of_objects));
  const auto all = objects + static_cast<double>(naive(around_block().of_supports));
  const auto points_of_objects = static_cast<double>(around_block().of_objects.size());
  const auto points = points_of_objects + static_cast<double>(around_block().of_supports.size());
  EXPECT_NEAR(*coverage(mesh).objects, objects / points_of_objects, 1e-12);
  EXPECT_NEAR(*coverage(mesh).surfaces, all / points, 1e-12);
  EXPECT_GT(*coverage(mesh).objects, 0.2);
  EXPECT_LT(*coverage(mesh).objects, 0.95);
}

TEST(RegionCoverage, NothingToSeeHasNoShare) {
  const Sphere in_the_air{{0.0, 0.0, 0.2}, 0.04};
  const RegionSurface nothing = *observable_in(two_on_a_table(), in_the_air, kPointSpacing_m, Executor{});
  const RegionCoverage none = measure_coverage(nothing, only({0, 1, 2}), kCovered_m, Executor{});
  EXPECT_FALSE(none.objects);
  EXPECT_FALSE(none.surfaces);

  const Sphere on_the_table{{0.0, 0.0, 0.0}, 0.05};
  const RegionSurface table = *observable_in(two_on_a_table(), on_the_table, kPointSpacing_m, Executor{});
  const RegionCoverage bare = measure_coverage(table, only({0, 1, 2}), kCovered_m, Executor{});
  EXPECT_FALSE(bare.objects);
  EXPECT_EQ(bare.surfaces, 1.0);
}

TEST(RegionCoverage, RefusesWhatCannotBeSampled) {
  EXPECT_FALSE(observable_in(two_on_a_table(), kAroundBlock, 0.0, Executor{}));
  EXPECT_FALSE(observable_in(two_on_a_table(), Sphere{{0.0, 0.0, 0.0}, -1.0}, kPointSpacing_m, Executor{}));
}

}  // namespace
}  // namespace saccade
