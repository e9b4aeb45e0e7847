// SPDX-License-Identifier: Apache-2.0
// The surface of maps whose signed distance is known.
#include "saccade/segment/surface_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "analytic_map.hpp"

namespace saccade {
namespace {

constexpr double kVoxel_m{0.005};

TsdfConfig config_of_maps() {
  TsdfConfig config;
  config.voxel_size_m = kVoxel_m;
  return config;
}

TsdfSnapshot sphere_map(bool colored = false) {
  return test::map_of(
      config_of_maps(), {{-32, -32, -32}, {32, 32, 32}},
      [](const Eigen::Vector3d& p) {
        return test::sphere_sdf(p, {0.003, -0.002, 0.001}, 0.1);
      },
      colored);
}

TEST(SurfacePoints, LieOnASphereWithItsNormals) {
  const PointCloud cloud = surface_points(sphere_map(), {});
  const double area_vox = 4.0 * std::acos(-1.0) * 0.1 * 0.1 / (kVoxel_m * kVoxel_m);
  ASSERT_GT(static_cast<double>(cloud.positions_m.size()), area_vox);
  ASSERT_LT(static_cast<double>(cloud.positions_m.size()), 2.0 * area_vox);
  ASSERT_EQ(cloud.normals.size(), cloud.positions_m.size());
  EXPECT_TRUE(cloud.colors.empty());
  for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
    const Eigen::Vector3d radial = cloud.positions_m[i].cast<double>() - Eigen::Vector3d{0.003, -0.002, 0.001};
    ASSERT_NEAR(radial.norm(), 0.1, 0.05 * kVoxel_m);
    ASSERT_NEAR(cloud.normals[i].norm(), 1.0F, 1e-5F);
    ASSERT_GT(cloud.normals[i].cast<double>().dot(radial.normalized()),
              std::cos(0.5 * kVoxel_m / 0.1 + 0.01));  // half a cell aside
  }
}

TEST(SurfacePoints, OfAPlaneLieInItOnePerVoxel) {
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d{0.0, 0.0, 1.0}, Eigen::Vector3d{1.0, 2.0, -3.0}.normalized()}) {
    const TsdfSnapshot map = test::map_of(config_of_maps(), {{-24, -24, -24}, {24, 24, 24}},
                                          [&](const Eigen::Vector3d& p) { return normal.dot(p) - 0.0013; });
    const PointCloud cloud = surface_points(map, {});
    ASSERT_GT(cloud.positions_m.size(), 2000U);
    if (normal.z() == 1.0) {
      EXPECT_EQ(cloud.positions_m.size(), 47U * 47U);
    }
    for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
      ASSERT_NEAR(normal.dot(cloud.positions_m[i].cast<double>()), 0.0013, 1e-3 * kVoxel_m);
      ASSERT_LT((cloud.normals[i].cast<double>() - normal).norm(), 2e-3);
    }
  }
}

/// Eq. 3.4 voxel by voxel.
TEST(SurfacePoints, NormalsAreTheMeanGradientOfTheCorners) {
  TsdfMap forgetting{sphere_map()};
  ASSERT_TRUE(forgetting.forget(Sphere{{0.1, 0.0, 0.0}, 0.03}).ok());
  const TsdfSnapshot map = forgetting.snapshot();
  const auto v = [&](const Index3& i) { return static_cast<double>(map.grid.voxel(i).v); };
  const auto known = [&](const Index3& i) { return map.grid.voxel(i).w > 0; };
  const SectorTable table{map.grid};
  SurfaceExtraction extraction{table, kVoxel_m, 1};
  std::size_t compared{0};
  std::size_t one_sided{0};
  for (int brick = 0; brick < 8 * 8 * 8; ++brick) {
    for (const SurfaceExtraction::Point& point :
         extraction.points_of(Index3{brick % 8 - 4, brick / 8 % 8 - 4, brick / 64 - 4})) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int corner = 0; corner < 8; ++corner) {
        const Index3 here = point.cell + Index3{corner & 1, (corner >> 1) & 1, corner >> 2};
        ASSERT_TRUE(known(here));
        for (int axis = 0; axis < 3; ++axis) {
          const Index3 step{axis == 0, axis == 1, axis == 2};
          const bool lower = known(here - step);
          const bool upper = known(here + step);
          ASSERT_TRUE(lower || upper);
          one_sided += lower && upper ? 0 : 1;
          const double difference = (upper ? v(here + step) : v(here)) - (lower ? v(here - step) : v(here));
          sum[axis] += difference / (lower && upper ? 2.0 : 1.0);
        }
      }
      ASSERT_LT((point.normal.cast<double>() - sum.normalized()).norm(), 1e-6);
      ++compared;
    }
  }
  EXPECT_EQ(compared, surface_points(map, {}).positions_m.size());
  EXPECT_GT(compared, 5000U);
  EXPECT_GT(one_sided, 0U) << "voxels beside unknown ones are compared, too";
}

TEST(SurfacePoints, UnknownIsNeverASurface) {
  // Only the voxels outside of the sphere are known, then only those inside, then all but a half.
  for (const int kept : {0, 1, 2}) {
    TsdfSnapshot map = sphere_map();
    TsdfMap forgetting{map};
    const auto sdf = [](const Eigen::Vector3d& p) { return test::sphere_sdf(p, {0.003, -0.002, 0.001}, 0.1); };
    for (const Index3& key : map.grid.sorted_sectors()) {
      Sector& sector = map.grid.writable(key);
      for (int child = 0; child < kSectorBricks; ++child) {
        const Index3 brick = key * kSectorEdge + child_offset(child);
        DenseBrick& dense = sector.bricks[static_cast<std::size_t>(child)].densify();
        for (int i = 0; i < kBrickVoxels; ++i) {
          const Eigen::Vector3d p = voxel_center(brick * kBrickEdge + child_offset(i), kVoxel_m);
          const bool keep = kept == 0 ? sdf(p) > 0.0 : kept == 1 ? sdf(p) <= 0.0 : p.x() < 0.0;
          if (keep) continue;
          dense.v[static_cast<std::size_t>(i)] = 0;
          dense.w[static_cast<std::size_t>(i)] = 0;
        }
        dense.update_masks();
        sector.bricks[static_cast<std::size_t>(child)].canonicalize(map.config.free_weight);
        sector.update_summary(child, map.config.free_weight);
      }
    }
    const PointCloud cloud = surface_points(map, {});
    if (kept < 2) {
      EXPECT_TRUE(cloud.positions_m.empty()) << kept;
      continue;
    }
    EXPECT_GT(cloud.positions_m.size(), 3000U);
    for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
      ASSERT_LT(cloud.positions_m[i].x(), 0.0F);
      const Eigen::Vector3d radial = cloud.positions_m[i].cast<double>() - Eigen::Vector3d{0.003, -0.002, 0.001};
      ASSERT_GT(cloud.normals[i].cast<double>().dot(radial.normalized()), std::cos(0.05));  // one-sided next to it
    }
  }
}

TEST(SurfacePoints, VoxelsSeenTooRarelyCountAsUnknown) {
  EXPECT_FALSE(surface_points(sphere_map(), {}, 10).positions_m.empty());  // free voxels farther off have less
  EXPECT_TRUE(surface_points(sphere_map(), {}, 11).positions_m.empty());
}

TEST(SurfacePoints, HaveColoursWhereTheMapHas) {
  const PointCloud cloud = surface_points(sphere_map(true), {});
  ASSERT_EQ(cloud.colors.size(), cloud.positions_m.size());
  for (const Eigen::Vector3f& color : cloud.colors) {
    ASSERT_LT((255.0F * color - Eigen::Vector3f{200.0F, 100.0F, 50.0F}).norm(), 1e-3F);
  }
}

TEST(SurfacePoints, OfNothingAreNone) {
  TsdfSnapshot map;
  EXPECT_TRUE(surface_points(map, {}).positions_m.empty());
  map = test::map_of(config_of_maps(), {{0, 0, 0}, {16, 16, 16}}, [](const Eigen::Vector3d&) { return 1.0; });
  EXPECT_TRUE(surface_points(map, {}).positions_m.empty());
}

TEST(SurfacePoints, ThreadsChangeNothing) {
  const TsdfSnapshot map = sphere_map(true);
  const PointCloud one = surface_points(map, {});
  for (const std::size_t threads : {2U, 4U}) {
    const PointCloud many = surface_points(map, Executor::with_threads(threads));
    EXPECT_EQ(many.positions_m, one.positions_m);
    EXPECT_EQ(many.normals, one.normals);
    EXPECT_EQ(many.colors, one.colors);
  }
}

}  // namespace
}  // namespace saccade
