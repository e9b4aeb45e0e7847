// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "saccade/map/voxels_inside.hpp"

namespace saccade {
namespace {

TEST(VoxelsInside, AgreesWithContainsForEveryVoxel) {
  constexpr double kVoxelM{0.01};
  std::mt19937 random{7};
  std::uniform_real_distribution<double> place{-0.3, 0.3};
  std::uniform_real_distribution<double> size{0.02, 0.3};
  std::uniform_int_distribution<int> brick{-4, 3};
  const auto point = [&] { return Eigen::Vector3d{place(random), place(random), place(random)}; };
  const auto on_lattice = [&] { return Eigen::Vector3d{(point() / kVoxelM).array().round() * kVoxelM}; };
  const auto on_centers = [&] { return Eigen::Vector3d{on_lattice().array() + 0.5 * kVoxelM}; };
  std::array<int, 3> met{};  // by Overlap
  int on_border{0};          // voxels whose distance rounding decides
  for (int i = 0; i < 3000; ++i) {
    Region region;
    switch (i % 4) {
      case 0: region = i % 8 == 0 ? Sphere{point(), size(random)} : Sphere{on_centers(), 0.15}; break;
      case 1: region = Cylinder{point(), point(), size(random)}; break;
      case 2: region = Cylinder{{0.0, 0.0, 0.005}, {0.0, 0.0, 0.005 + 16 * kVoxelM}, size(random)}; break;
      default: {
        const Eigen::Vector3d low = on_lattice() + Eigen::Vector3d::Constant(0.5 * kVoxelM);
        region = Box{low, low + Eigen::Vector3d{size(random), 0.16, size(random)}};
      }
    }
    const Index3 lo = Index3{brick(random), brick(random), brick(random)} * kBrickEdge;
    const Mask512 inside = voxels_inside(region, lo, kVoxelM);
    for (int k = 0; k < kBrickVoxels; ++k) {
      const Eigen::Vector3d p = voxel_center(lo + child_offset(k), kVoxelM);
      ASSERT_EQ(inside.test(k), contains(region, p)) << "region " << i;
      const auto* sphere = std::get_if<Sphere>(&region);
      if (sphere != nullptr && std::abs((p - sphere->center).norm() - sphere->radius_m) < 1e-12) ++on_border;
    }
    const Index3 last = lo + Index3{7, 7, 7};
    const Overlap judged = overlap(region, {voxel_center(lo, kVoxelM), voxel_center(last, kVoxelM)});
    ++met[static_cast<std::size_t>(judged)];
  }
  for (const int count : met) EXPECT_GT(count, 50);
  EXPECT_GT(on_border, 50);
}

TEST(VoxelsInside, ABoxOfVoxels) {
  std::mt19937 random{11};
  std::uniform_int_distribution<int> place{-16, 14};
  std::uniform_int_distribution<int> size{-1, 24};
  int some{0};
  for (int i = 0; i < 3000; ++i) {
    const auto index = [&](auto& along) { return Index3{along(random), along(random), along(random)}; };
    const Index3 first = index(place);
    const IndexBox box{first, first + index(size)};
    const Index3 lo{8 * (i % 3) - 8, 8 * (i / 3 % 3) - 8, 8 * (i / 9 % 3) - 8};
    const Mask512 inside = voxels_inside(box, lo);
    for (int k = 0; k < kBrickVoxels; ++k) ASSERT_EQ(inside.test(k), box.contains(lo + child_offset(k))) << "box " << i;
    some += inside.any() && !inside.all() ? 1 : 0;
  }
  EXPECT_GT(some, 300);
}

}  // namespace
}  // namespace saccade
