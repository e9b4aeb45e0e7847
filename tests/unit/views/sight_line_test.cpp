// SPDX-License-Identifier: Apache-2.0
// Rays to unknown voxels: several at a time meet what they meet one by one, on every instruction set.
#include "saccade/views/internal/sight_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "saccade/core/seeded_random.hpp"
#include "saccade/core/simd.hpp"
#include "support/half_seen_box.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

const std::array<Region, 4> kRegions{Box{Vector3d::Constant(-10.0), Vector3d::Constant(10.0)},
                                     Box{{-0.03, -0.04, -0.1}, {0.04, 0.05, 0.07}}, Sphere{{0.0, 0.01, 0.04}, 0.06},
                                     Cylinder{{-0.05, 0.0, 0.02}, {0.05, 0.01, 0.06}, 0.04}};

StateVolume half_seen_states() {
  const TsdfSnapshot map = test::half_seen_box();
  return StateVolume::read(map, voxels_with_center_in(*map.config.workspace, map.config.voxel_size_m), {}).value();
}

/// Rays through the map, some of them along axes, from outside and from within.
std::vector<SightRay> rays() {
  SeededRandom random{7};
  const auto point = [&](double reach_m) {
    return Vector3d{random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m),
                    random.uniform(-reach_m, reach_m)};
  };
  std::vector<SightRay> rays;
  for (int i = 0; i < 3000; ++i) {
    SightRay ray{point(i % 3 == 0 ? 0.2 : 0.8), point(0.2)};
    if (i % 7 == 0) ray.to_m.x() = ray.from_m.x();
    if (i % 14 == 0) ray.to_m.y() = ray.from_m.y();
    ray.to_m += 0.5 * (ray.to_m - ray.from_m);
    rays.push_back(ray);
  }
  return rays;
}

Box box_around(const Region& region, double margin_m) {
  Box box = bounds(region);
  box.min.array() -= margin_m;
  box.max.array() += margin_m;
  return box;
}

TEST(SightClasses, FollowStatesAndRegion) {
  const StateVolume states = half_seen_states();
  for (const Region& region : kRegions) {
    for (const UnknownOutside outside : {UnknownOutside::blocks, UnknownOutside::transparent}) {
      const SightClasses classes{states, region, outside, {}};
      std::array<std::size_t, 4> count{};
      states.box().for_each([&](const Index3& voxel) {
        const Index3 at = voxel - states.box().lo;
        const auto place = static_cast<std::size_t>(at.x + at.y * classes.strides()[1] + at.z * classes.strides()[2]);
        const VoxelState state = states[states.index(voxel)];
        const SightClass of_unknown = contains(region, voxel_center(voxel, states.voxel_size_m())) ? SightClass::promise
                                      : outside == UnknownOutside::blocks                          ? SightClass::blocks
                                                                                                   : SightClass::passes;
        ASSERT_EQ(classes.voxel(place), voxel);
        ASSERT_EQ(classes.at(place), state == VoxelState::unknown    ? of_unknown
                                     : state == VoxelState::occupied ? SightClass::surface
                                                                     : SightClass::passes);
        ++count[static_cast<std::size_t>(classes.at(place))];
      });
      EXPECT_GT(count[static_cast<std::size_t>(SightClass::promise)], 0U);
      EXPECT_GT(count[static_cast<std::size_t>(SightClass::surface)], 0U);
    }
  }
}

TEST(SightLine, MeetsTheSameSeveralAtATime) {
  const StateVolume states = half_seen_states();
  const std::vector<SightRay> all = rays();
  for (const Region& region : kRegions) {
    for (const UnknownOutside outside : {UnknownOutside::blocks, UnknownOutside::transparent}) {
      const SightClasses classes{states, region, outside, {}};
      const Box around = box_around(region, states.voxel_size_m());
      std::vector<std::optional<MetVoxel>> one_by_one;
      for (const SightRay& ray : all) one_by_one.push_back(met_voxel(classes, around, ray));
      const auto count = [&](bool returns) {
        return std::count_if(one_by_one.begin(), one_by_one.end(),
                             [&](const auto& met) { return met && met->returns == returns; });
      };
      EXPECT_GT(count(true), 10);
      EXPECT_GT(count(false), 3);
      for (const std::string& target : simd_targets()) {
        ASSERT_TRUE(use_simd_target(target).ok());
        const std::vector<std::optional<MetVoxel>> met = met_voxels(classes, around, all);
        EXPECT_TRUE(met == one_by_one) << target;
      }
      ASSERT_TRUE(use_simd_target("").ok());
    }
  }
}

TEST(SightLine, MeetsTheFirstPromise) {
  const StateVolume states = half_seen_states();
  const SightClasses classes{states, kRegions[0], UnknownOutside::blocks, {}};
  const Box around = box_around(kRegions[0], states.voxel_size_m());
  const auto met = [&](const Vector3d& from_m, const Vector3d& to_m) {
    return met_voxel(classes, around, {from_m, to_m});
  };
  EXPECT_FALSE(met({0.003, 0.003, 0.3}, {0.003, 0.003, -0.15})) << "the box's top is known";
  const std::optional<MetVoxel> side = met({-0.2, 0.003, 0.043}, {0.2, 0.003, 0.043});
  ASSERT_TRUE(side) << "its side towards -x is not";
  EXPECT_NEAR(-0.2 + side->share * 0.4, -0.05, states.voxel_size_m());
  EXPECT_TRUE(side->returns) << "its side towards +x lies behind";
  const std::optional<MetVoxel> below = met({-0.2, 0.003, 0.043}, {0.0, 0.003, 0.043});
  ASSERT_TRUE(below);
  EXPECT_FALSE(below->returns) << "the ray ends within the box";
}

}  // namespace
}  // namespace saccade
