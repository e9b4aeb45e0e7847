// SPDX-License-Identifier: Apache-2.0
// Frontier points at the edges of surfaces, and ellipsoids around clusters and in images.
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "saccade/views/internal/projection_gain.hpp"
#include "saccade/views/internal/surface_edge_gain.hpp"
#include "support/written_map.hpp"

namespace saccade::of_shapes {
namespace {

using Eigen::Vector3d;

constexpr double kEdge_m{0.01};

/// A slab at z = 0, seen up to x = 0 from above; the space over it is empty, what is beyond unknown.
BaselineScene half_plane() {
  const TsdfSnapshot map = test::written_map(
      [](const Vector3d& p) {
        if (p.x() >= 0.0) return VoxelState::unknown;
        if (p.z() > 0.0) return VoxelState::empty;
        return p.z() > -0.02 ? VoxelState::occupied : VoxelState::unknown;
      },
      Box{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}});
  const Executor executor;
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  return read_baseline_scene({map, executor}, all, 0.05).value();
}

TEST(FrontierPoints, LieWhereTheSurfaceEndsBesideUnknownSpace) {
  const BaselineScene scene = half_plane();
  const std::vector<FrontierPoint> points = frontier_points(scene, Executor{});
  ASSERT_GT(points.size(), 25U);
  std::vector<int> rows;
  for (const FrontierPoint& point : points) {
    const Vector3d p = voxel_center(scene.volume.voxel(point.voxel), kEdge_m);
    EXPECT_GT(p.x(), -0.03);  // near the edge, neither within the plane nor at the border of the workspace
    EXPECT_LT(p.x(), 0.0);
    EXPECT_LT(std::abs(p.y()), 0.17);
    EXPECT_EQ(scene.volume[point.unknown], VoxelState::unknown);
    EXPECT_GT(point.facing.x(), 0.3F);  // on, and up
    EXPECT_GT(point.facing.z(), 0.3F);
    EXPECT_NEAR(static_cast<double>(point.facing.norm()), 1.0, 1e-5);
    rows.push_back(scene.volume.voxel(point.voxel).y);
  }
  std::sort(rows.begin(), rows.end());
  EXPECT_GE(std::unique(rows.begin(), rows.end()) - rows.begin(), 25);  // all along it
}

TEST(Ellipsoids, SurroundClustersOfPoints) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 100; ++i) {
    points.emplace_back(0.03 * std::cos(0.7 * i), 0.01 * std::sin(0.7 * i), 0.0);
    points.emplace_back(0.5 + 1e-4 * i, 0.0, 0.0);
  }
  for (Vector3d& p : points) p += Vector3d{0.05, 0.05, 0.05};
  const std::vector<Ellipsoid> ellipsoids = fitted_ellipsoids(points, 0.1, 0.006);
  ASSERT_EQ(ellipsoids.size(), 2U);
  EXPECT_LT((ellipsoids[0].center - Vector3d{0.05, 0.05, 0.05}).norm(), 0.002);
  EXPECT_NEAR(std::sqrt(ellipsoids[0].shape(0, 0)), kSpread * 0.03 / std::sqrt(2.0), 0.002);
  EXPECT_NEAR(std::sqrt(ellipsoids[0].shape(2, 2)), kSpread * 0.006 / std::sqrt(12.0), 1e-9);
  EXPECT_TRUE(fitted_ellipsoids({}, 0.1, 0.006).empty());
}

const PinholeCamera kCamera{201, 101, 100.0, 100.0, 100.0, 50.0, 0.1, 5.0};

/// Pixels whose line of sight meets the ellipsoid.
TEST(Ellipsoids, CoverThePixelsWhoseRaysMeetThem) {
  const Pose T_world_camera = look_at({0.3, -1.0, 0.4}, {0.0, 0.1, 0.0});
  Ellipsoid ellipsoid;
  ellipsoid.center = {0.1, 0.05, -0.05};
  ellipsoid.shape << 0.09, 0.02, 0.0, 0.02, 0.03, 0.005, 0.0, 0.005, 0.01;
  const auto ellipse = projected(ellipsoid, T_world_camera.inverse(Eigen::Isometry), kCamera);
  ASSERT_TRUE(ellipse);
  const Eigen::Matrix3d inverse = ellipsoid.shape.inverse();
  int covered = 0;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const Vector3d d = T_world_camera.linear() * kCamera.ray(u, v);
      const Vector3d o = T_world_camera.translation() - ellipsoid.center;
      const double a = d.dot(inverse * d);
      const double b = d.dot(inverse * o);
      const double discriminant = b * b - a * (o.dot(inverse * o) - 1.0);
      if (std::abs(discriminant) < 1e-6 * a) continue;
      const bool within = u >= ellipse->u_begin && u < ellipse->u_end && v >= ellipse->v_begin && v < ellipse->v_end;
      ASSERT_EQ(discriminant > 0.0, within && ellipse->contains(u, v)) << u << ' ' << v;
      covered += discriminant > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(covered, 500);
  EXPECT_LT(covered, kCamera.width * kCamera.height / 2);
}

/// A disc of 20 pixels' radius, a little larger; each ellipsoid before it halves what it covers.
TEST(FrontierPixels, CountLessBehindWhatIsNearer) {
  const auto ball = [](const Vector3d& center, double radius_m) {
    return Ellipsoid{center, radius_m * radius_m * Eigen::Matrix3d::Identity()};
  };
  const Pose pose = look_at({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  SceneEllipsoids scene;
  scene.frontier = {ball({0.0, 0.0, 0.0}, 0.2)};
  const double alone = frontier_pixels(scene, pose, kCamera);
  EXPECT_NEAR(alone, std::numbers::pi * 400.0 / 0.96, 40.0);
  scene.frontier.push_back(ball({0.0, 0.0, -0.1}, 0.1));  // within its outline
  EXPECT_EQ(frontier_pixels(scene, pose, kCamera), alone);
  scene.occupied = {ball({0.0, 0.0, -0.5}, 0.2)};  // behind
  EXPECT_EQ(frontier_pixels(scene, pose, kCamera), alone);
  const Ellipsoid before = ball({0.0, 0.0, 0.3}, 0.1);
  const double small = frontier_pixels({{before}, {}}, pose, kCamera);
  ASSERT_GT(small, 500.0);
  scene.occupied.push_back(before);
  EXPECT_EQ(frontier_pixels(scene, pose, kCamera), alone - 0.5 * small);
  scene.occupied.push_back(ball({0.0, 0.0, 0.4}, 0.3));  // before all of it
  EXPECT_EQ(frontier_pixels(scene, pose, kCamera), 0.5 * (alone - 0.5 * small));
}

}  // namespace
}  // namespace saccade::of_shapes
