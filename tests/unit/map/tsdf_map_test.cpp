// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_map.hpp"

#include <gtest/gtest.h>

#include <array>

namespace saccade {
namespace {

TEST(TsdfMap, RefusesFramesThatSeeTooManyVoxels) {
  struct Case {
    double focal_px;
    float depth_m;
  };
  constexpr std::array<Case, 4> kCases{{{1e-6, 1.0F}, {1e-30, 1.0F}, {10.0, 1e6F}, {10.0, 1e37F}}};
  TsdfMap map = TsdfMap::create({}).value();
  for (const auto& [focal_px, depth_m] : kCases) {
    const PinholeCamera camera{8, 6, focal_px, focal_px, 3.5, 2.5, 0.1, 1e38};
    const auto refused = map.integrate(camera, DepthImage{8, 6, depth_m}, Pose::Identity(), {});
    ASSERT_FALSE(refused.ok()) << focal_px << " " << depth_m;
    EXPECT_EQ(refused.error().code, Errc::invalid_argument);
    EXPECT_TRUE(map.content().grid.empty());
  }
  const PinholeCamera camera{8, 6, 10.0, 10.0, 3.5, 2.5, 0.1, 6.0};
  EXPECT_TRUE(map.integrate(camera, DepthImage{8, 6, 1.0F}, Pose::Identity(), {}).ok());
  EXPECT_FALSE(map.content().grid.empty());
}

/// Returns v of a voxel on a wall at 1 m after frames of the wall, and then frames that see nothing before 3 m.
double value_after(int frames_of_wall, int frames_past_it, std::uint8_t clearing_percent) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  config.clearing_percent = clearing_percent;
  TsdfMap map = TsdfMap::create(config).value();
  const PinholeCamera camera{40, 30, 60.0, 60.0, 19.5, 14.5, 0.1, 4.0};
  for (int i = 0; i < frames_of_wall; ++i) {
    EXPECT_TRUE(map.integrate(camera, DepthImage{40, 30, 1.0F}, Pose::Identity(), {}).ok());
  }
  for (int i = 0; i < frames_past_it; ++i) {
    EXPECT_TRUE(map.integrate(camera, DepthImage{40, 30, 3.0F}, Pose::Identity(), {}).ok());
  }
  return map.content().grid.voxel({0, 0, 100}).v / 32767.0;
}

TEST(TsdfMap, WhatPassesASurfaceByCountsAsMuchAsItIsSaidTo) {
  const double wall = value_after(9, 0, 100);
  ASSERT_NEAR(wall, -0.125, 0.01);  // half a voxel behind the wall, of a truncation of four
  EXPECT_NEAR(value_after(9, 1, 100), wall + (1.0 - wall) / 10.0, 1e-4) << "eq. 2.2";
  EXPECT_NEAR(value_after(9, 1, 50), wall + 0.5 * (1.0 - wall) / 10.0, 1e-4);
  EXPECT_NEAR(value_after(9, 1, 1), wall + 0.01 * (1.0 - wall) / 10.0, 1e-4);
  EXPECT_GT(value_after(9, 4, 50), 0.0) << "a wall that is gone goes from the map";
  EXPECT_EQ(value_after(0, 3, 50), 1.0) << "free space is learnt as before";
}

TEST(TsdfMap, UnknownVoxelsOfARegionAreCountedAsOneByOne) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  config.workspace = Box{{-0.2, -0.155, 0.3}, {0.2, 0.2, 1.213}};
  TsdfMap map = TsdfMap::create(config).value();
  const PinholeCamera camera{40, 30, 60.0, 60.0, 19.5, 14.5, 0.1, 4.0};
  ASSERT_TRUE(map.integrate(camera, DepthImage{40, 30, 1.0F}, Pose::Identity(), {}).ok());
  const std::array<Region, 3> regions{Sphere{{0.1, 0.0, 0.95}, 0.2}, Box{{-0.1, -0.1, 0.2}, {0.1, 0.1, 1.5}},
                                      Cylinder{{0.0, 0.0, 0.9}, {0.05, 0.1, 1.1}, 0.15}};
  for (const Region& region : regions) {
    std::size_t unknown{0};
    voxels_with_center_in(bounds(region), config.voxel_size_m).for_each([&](const Index3& voxel) {
      const Eigen::Vector3d p = voxel_center(voxel, config.voxel_size_m);
      if (!contains(region, p) || !contains(*config.workspace, p)) return;
      unknown += map.content().grid.state(voxel) == VoxelState::unknown ? 1 : 0;
    });
    EXPECT_EQ(count_unknown(map.content(), region), unknown) << region.index();
    EXPECT_GT(unknown, 100U);
  }
  EXPECT_EQ(count_unknown(map.content(), Box{}), 0U);
}

}  // namespace
}  // namespace saccade
