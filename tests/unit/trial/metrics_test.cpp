// SPDX-License-Identifier: Apache-2.0
// The figures are held to a naive computation from what `saccade scene export` and `explore` hand out: true mesh,
// surface points, map and reconstructed mesh.
#include "saccade/trial/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "saccade/scene/simulated_camera.hpp"
#include "support/brute_force_distance.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// A block and a cup on a slab.
Scene small_scene() {
  Scene scene;
  scene.name = "small";
  scene.workspace = Box{{-0.2, -0.2, -0.03}, {0.2, 0.2, 0.2}};
  scene.max_deviation_m = 1e-4;
  SceneObject slab;
  slab.name = "slab";
  slab.shape = BoxShape{{0.5, 0.5, 0.02}};
  slab.T_world_object.translation().z() = -0.02;
  slab.support = true;
  SceneObject block;
  block.name = "block";
  block.shape = BoxShape{{0.08, 0.06, 0.101}};
  block.T_world_object.translation() = Vector3d{-0.08, 0.031, 0.0};
  SceneObject cup;
  cup.name = "cup";
  cup.shape = RevolutionShape{{{0.03, 0.0}, {0.035, 0.061}}, 0.006};
  cup.T_world_object.translation() = Vector3d{0.08, -0.02, 0.0};
  scene.objects = {slab, block, cup};
  return scene;
}

constexpr double kSpacing_m{test::kSanitized ? 0.012 : 0.006};

const GroundTruth& truth() {
  static const GroundTruth made = *GroundTruth::build(*RayScene::build(small_scene()), kSpacing_m, Executor{});
  return made;
}

TriangleMesh joined(bool supports) {
  TriangleMesh all;
  for (const ObjectMesh& object : truth().scene().meshes()) {
    if (object.support != supports) continue;
    const auto offset = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), object.mesh.vertices.begin(), object.mesh.vertices.end());
    for (const auto& [a, b, c] : object.mesh.triangles) all.triangles.push_back({a + offset, b + offset, c + offset});
  }
  return all;
}

TsdfMap empty_map() {
  TsdfConfig config;
  config.voxel_size_m = 0.008;
  return *TsdfMap::create(config);
}

/// The map after some noisy views from one side.
TsdfMap seen_from_one_side(int views) {
  TsdfMap map = empty_map();
  SimulatedCameraConfig config;
  config.camera = PinholeCamera{160, 120, 150.0, 150.0, 79.5, 59.5, 0.2, 2.0};
  SimulatedCamera camera = *SimulatedCamera::create(truth().scene(), config);
  for (int i = 0; i < views; ++i) {
    const Pose T_world_camera = look_at({0.3 * i - 0.2, -0.5, 0.35}, {0.0, 0.0, 0.03});
    const Frame frame = camera.capture(T_world_camera);
    EXPECT_TRUE(map.integrate(camera.camera(), frame.depth, T_world_camera, Executor{}));
  }
  return map;
}

/// Straight from the definitions in docs/reference/metrics.md, without any search structure.
Metrics naive(const TsdfSnapshot& map, const TriangleMesh& mesh) {
  const TriangleMesh objects = joined(false);
  const TriangleMesh supports = joined(true);
  const Box& workspace = truth().scene().scene().workspace;
  const double e = map.config.voxel_size_m;
  Metrics metrics;
  std::vector<double> missing;
  for (const Eigen::Vector3f& p : truth().observable_points()) {
    missing.push_back(test::brute_force_distance_m(mesh, p.cast<double>()));
  }
  std::vector<double> wrong;
  for (const Eigen::Vector3f& point : sample_surfaces({{"", mesh, false}}, kSpacing_m, workspace).points) {
    const Vector3d p = point.cast<double>();
    const double to_supports = test::brute_force_distance_m(supports, p);
    if (!contains(workspace, p) || to_supports <= e) continue;
    wrong.push_back(std::min(to_supports, test::brute_force_distance_m(objects, p)));
  }
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  const auto share = [](const std::vector<double>& v, double limit) {
    double count = 0.0;
    for (const double d : v) count += d <= limit ? 1.0 : 0.0;
    return count / static_cast<double>(v.size());
  };
  metrics.coverage = share(missing, e);
  metrics.accuracy_m = mean(wrong);
  metrics.chamfer_m = 0.5 * (mean(wrong) + mean(missing));
  metrics.f_score = 2.0 * share(wrong, 0.005) * share(missing, 0.005) / (share(wrong, 0.005) + share(missing, 0.005));

  // Solids, as the scene was written down.
  const auto solid = [](const Vector3d& p) {
    const bool slab = std::fabs(p.x()) < 0.25 && std::fabs(p.y()) < 0.25 && p.z() > -0.02 && p.z() < 0.0;
    const bool block =
        std::fabs(p.x() + 0.08) < 0.04 && std::fabs(p.y() - 0.031) < 0.03 && p.z() > 0.0 && p.z() < 0.101;
    const double outer = 0.03 + 0.005 * p.z() / 0.061;
    const double radius = std::hypot(p.x() - 0.08, p.y() + 0.02);
    const bool cup = p.z() > 0.0 && p.z() < 0.061 && radius < outer && (radius > outer - 0.006 || p.z() < 0.006);
    return slab || block || cup;
  };
  for (int z = -4; z <= 25; ++z) {
    for (int y = -26; y <= 25; ++y) {
      for (int x = -26; x <= 25; ++x) {
        const Vector3d p = voxel_center({x, y, z}, e);
        if (map.grid.state({x, y, z}) != VoxelState::unknown || !contains(workspace, p) || solid(p)) continue;
        metrics.unknown_near_objects += test::brute_force_distance_m(objects, p) <= 0.03 ? 1 : 0;
      }
    }
  }
  return metrics;
}

TEST(Metrics, EqualANaiveComputation) {
  if (test::kSanitized) GTEST_SKIP() << "takes long under sanitizers; the tests above measure, too";
  for (const int views : {1, 3}) {
    const TsdfMap map = seen_from_one_side(views);
    const TriangleMesh mesh = extract_mesh(map.content(), Executor{});
    const Metrics expected = naive(map.content(), mesh);
    const Metrics measured = measure(truth(), map.content(), mesh, Executor::with_threads(3));
    EXPECT_NEAR(measured.coverage, expected.coverage, 1e-9);
    EXPECT_NEAR(*measured.accuracy_m, *expected.accuracy_m, 1e-9);
    EXPECT_NEAR(*measured.chamfer_m, *expected.chamfer_m, 1e-9);
    EXPECT_NEAR(*measured.f_score, *expected.f_score, 1e-9);
    // The cup is a polygon of flat sides: a voxel right at its wall may differ.
    EXPECT_NEAR(static_cast<double>(measured.unknown_near_objects), static_cast<double>(expected.unknown_near_objects),
                0.01 * static_cast<double>(expected.unknown_near_objects));
    EXPECT_GT(expected.unknown_near_objects, 300U);
    EXPECT_GT(measured.coverage, 0.2);
    EXPECT_LT(measured.coverage, 0.9);
  }
}

TEST(Metrics, ThePerfectMeshIsPerfect) {
  TriangleMesh mesh = joined(false);
  const Metrics metrics = measure(truth(), empty_map().content(), mesh, Executor{});
  EXPECT_EQ(metrics.coverage, 1.0);
  EXPECT_NEAR(*metrics.accuracy_m, 0.0, 1e-8);
  EXPECT_NEAR(*metrics.chamfer_m, 0.0, 1e-8);
  EXPECT_EQ(*metrics.f_score, 1.0);
  EXPECT_GT(metrics.unknown_near_objects, 1000U);  // the map is another matter

  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() += 0.02F;  // 2 cm too high: nothing flatters it
  const Metrics raised = measure(truth(), empty_map().content(), mesh, Executor{});
  EXPECT_LT(raised.coverage, 0.9);
  EXPECT_GT(*raised.accuracy_m, 0.002);
  EXPECT_LT(*raised.f_score, 0.9);
}

TEST(Metrics, TheTableAloneScoresNothing) {
  const Metrics metrics = measure(truth(), empty_map().content(), joined(true), Executor{});
  EXPECT_LT(metrics.coverage, 0.15);  // the foot of the objects is within a voxel of the table
  EXPECT_FALSE(metrics.accuracy_m);
  EXPECT_FALSE(metrics.f_score);
  const Metrics nothing = measure(truth(), empty_map().content(), TriangleMesh{}, Executor{});
  EXPECT_EQ(nothing.coverage, 0.0);
  EXPECT_FALSE(nothing.chamfer_m);
}

TEST(Metrics, SpaceThatWasSeenIsNoLongerUnknown) {
  const std::size_t before = unknown_near_objects(truth(), empty_map().content(), Executor{});
  const std::size_t one = unknown_near_objects(truth(), seen_from_one_side(1).content(), Executor{});
  const std::size_t three = unknown_near_objects(truth(), seen_from_one_side(3).content(), Executor{});
  EXPECT_LT(one, before);
  EXPECT_LT(three, one);
}

/// Counts voxel by voxel what unknown_near_objects and newly_known count by cubes.
TEST(Metrics, VoxelsNearObjectsAreThoseThatEachVoxelsDistanceTells) {
  const Box& workspace = truth().scene().scene().workspace;
  const TsdfSnapshot before = seen_from_one_side(1).content();
  const TsdfSnapshot after = seen_from_one_side(3).content();
  const double e = after.config.voxel_size_m;
  const auto unknown = [](const TsdfSnapshot& map, const Index3& voxel) {
    return map.grid.state(voxel) == VoxelState::unknown;
  };
  std::size_t near{0};
  ObservedGain gain;
  voxels_with_center_in(workspace, e).for_each([&](const Index3& voxel) {
    const Vector3d p = voxel_center(voxel, e);
    const double distance_m = truth().to_objects_m(p, 1.0);
    if (unknown(after, voxel)) {
      near += distance_m <= kNearObjects_m && !truth().inside_solid(p) ? 1 : 0;
    } else if (unknown(before, voxel)) {
      gain += {1, distance_m <= kAtObject_m ? std::size_t{1} : std::size_t{0}};
    }
  });
  EXPECT_EQ(unknown_near_objects(truth(), after, Executor::with_threads(3)), near);
  const ObservedGain found = newly_known(truth(), before, after, Executor::with_threads(3));
  EXPECT_EQ(found.voxels, gain.voxels);
  EXPECT_EQ(found.near_objects, gain.near_objects);
  EXPECT_GT(near, 100U);
  EXPECT_GT(gain.near_objects, 100U);
}

TEST(GroundTruth, NeedsSomethingToSee) {
  Scene bare = small_scene();
  bare.objects.resize(1);
  EXPECT_FALSE(GroundTruth::build(*RayScene::build(bare), kSpacing_m, Executor{}));
  EXPECT_FALSE(GroundTruth::build(truth().scene(), 0.0, Executor{}));
}

}  // namespace
}  // namespace saccade
