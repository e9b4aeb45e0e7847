// SPDX-License-Identifier: Apache-2.0
// Surface that is expected of a box on a table of which the top and one side were seen, on maps written by hand.
#include "saccade/views/expected_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "saccade/views/surface_gain.hpp"
#include "support/written_map.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using StateAt = std::function<VoxelState(const Vector3d& p)>;

constexpr double kEdge_m{0.01};

/// A workspace of 0.6 m × 0.6 m, from 0.1 m below the table to 0.4 m above.
TsdfSnapshot map_of(const StateAt& state_at) {
  TsdfSnapshot map;
  map.config.voxel_size_m = kEdge_m;
  map.config.workspace = Box{{-0.3, -0.3, -0.1}, {0.3, 0.3, 0.4}};
  parents(voxels_with_center_in(*map.config.workspace, kEdge_m)).for_each([&](const Index3& brick) {
    BrickRef ref;
    DenseBrick& dense = ref.densify();
    IndexBox::cube(brick * kBrickEdge, kBrickEdge).for_each([&](const Index3& voxel) {
      const VoxelState state = state_at(voxel_center(voxel, kEdge_m));
      const auto i = static_cast<std::size_t>(child_index(voxel));
      dense.w[i] = state == VoxelState::unknown ? 0 : 5;
      dense.v[i] = state == VoxelState::occupied ? -1000 : state == VoxelState::empty ? kTsdfOne : 0;
    });
    dense.update_masks();
    test::set_brick(map, brick, std::move(ref));
  });
  return map;
}

VoxelState table_at(const Vector3d& p) {
  if (p.z() > 0.0) return VoxelState::empty;
  return p.z() > -0.02 ? VoxelState::occupied : VoxelState::unknown;
}

/// A box of 10 cm whose top and side towards +x were seen.
VoxelState half_a_box(const Vector3d& p) {
  const bool inside = std::abs(p.x()) < 0.05 && std::abs(p.y()) < 0.05 && p.z() > 0.0 && p.z() < 0.1;
  if (!inside) return table_at(p);
  return p.z() > 0.09 || p.x() > 0.04 ? VoxelState::occupied : VoxelState::unknown;
}

ExpectedSurface surface_of(const TsdfSnapshot& map, const ExpectedSurfaceConfig& config = {}) {
  return expected_surface(map, config, {}).value();
}

/// Area of the points that face a direction within 30°.
double area_facing(const ExpectedSurface& surface, const Eigen::Vector3f& direction) {
  double area_cm2{0.0};
  for (const ExpectedPoint& point : surface.points) {
    if (point.normal.dot(direction) > 0.866F) area_cm2 += static_cast<double>(point.area_cm2);
  }
  return area_cm2;
}

double gain_from(const TsdfSnapshot& map, const Vector3d& camera_m) {
  SurfaceGain gain{{.sensor = {160, 120, 131.25, 131.25, 79.5, 59.5, 0.1, 2.0}}};
  const Executor executor;
  const Pose pose = look_at(camera_m, {0.0, 0.0, 0.05});
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  return gain.evaluate({map, executor}, all, std::span{&pose, 1}).value().front();
}

/// Unknown sides measure 9 cm × 9 cm; what lies at an edge faces two ways, or three.
TEST(ExpectedSurface, SidesThatWereNotSeenAreExpectedDownToTheTable) {
  const ExpectedSurface surface = surface_of(map_of(half_a_box));
  ASSERT_EQ(surface.supports.size(), 1U);
  EXPECT_NEAR(surface.supports.front().height_m, 0.0, 1e-9);
  EXPECT_NEAR(surface.supports.front().area_m2, 0.35, 0.02);
  EXPECT_NEAR(surface.seen_cm2, 200.0, 40.0);
  EXPECT_NEAR(area_facing(surface, {-1, 0, 0}), 72.0, 15.0);
  EXPECT_NEAR(area_facing(surface, {0, 1, 0}), 72.0, 15.0);
  EXPECT_NEAR(area_facing(surface, {0, -1, 0}), 72.0, 15.0);
  EXPECT_LT(area_facing(surface, {1, 0, 0}), 5.0) << "it was seen";
  EXPECT_LT(area_facing(surface, {0, 0, 1}), 5.0);
}

TEST(ExpectedSurface, ThereIsNoneWithoutAnObject) {
  const ExpectedSurface surface = surface_of(map_of(table_at));
  EXPECT_TRUE(surface.points.empty());
  EXPECT_EQ(surface.supports.size(), 1U);
  EXPECT_EQ(surface.seen_cm2, 0.0);
  EXPECT_TRUE(surface_of(map_of([](const Vector3d&) { return VoxelState::unknown; })).points.empty());
  EXPECT_TRUE(surface_of({}).points.empty()) << "no workspace, nothing known";
}

TEST(ExpectedSurface, ThingsOnAShelfStandOnTheirBoard) {
  // Two boards at 0 and 0.2 m; on each half a box of 10 cm.
  const TsdfSnapshot map = map_of([](const Vector3d& p) {
    const VoxelState below = half_a_box(p);
    if (p.z() < 0.18) return below;
    return p.z() < 0.2 ? VoxelState::occupied : half_a_box(p - Vector3d{0.0, 0.0, 0.2});
  });
  const ExpectedSurface surface = surface_of(map);
  ASSERT_EQ(surface.supports.size(), 2U);
  EXPECT_NEAR(area_facing(surface, {-1, 0, 0}), 144.0, 30.0);
  for (const ExpectedPoint& point : surface.points) {
    const bool upper = point.position_m.z() > 0.2F;
    EXPECT_NEAR(surface.supports[static_cast<std::size_t>(point.support)].height_m, upper ? 0.2 : 0.0, 1e-9);
  }
}

TEST(ExpectedSurface, BadConfigurationsAreRefused) {
  const auto refused = [](auto change) {
    ExpectedSurfaceConfig config;
    change(config);
    return expected_surface({}, config, {}).error().code == Errc::invalid_argument;
  };
  EXPECT_TRUE(refused([](auto& c) { c.min_support_m2 = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.reach_m = -1.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.decay_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.beside_share = 1.5; }));
  EXPECT_TRUE(refused([](auto& c) { c.spacing_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.through_m = -0.1; }));
}

TEST(SurfaceGain, IsTheAreaThatIsExpectedInThePicture) {
  const TsdfSnapshot map = map_of(half_a_box);
  EXPECT_NEAR(gain_from(map, {-0.6, 0.0, 0.1}), 90.0, 30.0);
  EXPECT_LT(gain_from(map, {0.6, 0.0, 0.1}), 10.0);
  const double two_sides = gain_from(map, {-0.45, 0.45, 0.1});
  EXPECT_NEAR(two_sides, 180.0, 50.0);
}

TEST(SurfaceGain, TheThreadCountChangesNoBit) {
  const TsdfSnapshot map = map_of(half_a_box);
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  std::vector<Pose> poses;
  for (int i = 0; i < 60; ++i)
    poses.push_back(look_at({0.6 * std::cos(i), 0.6 * std::sin(i), 0.01 * i}, {0.0, 0.0, 0.05}));
  std::vector<std::vector<double>> gains;
  for (const std::size_t threads : {1U, 2U, 5U}) {
    SurfaceGain gain{{}};
    const Executor executor = Executor::with_threads(threads);
    gains.push_back(gain.evaluate({map, executor}, all, poses).value());
  }
  EXPECT_GT(*std::max_element(gains[0].begin(), gains[0].end()), 50.0);
  EXPECT_EQ(gains[1], gains[0]);
  EXPECT_EQ(gains[2], gains[0]);
}

TEST(SurfaceGain, PosesThatAreNoneAreRefused) {
  SurfaceGain gain{{}};
  const Executor executor;
  const TsdfSnapshot map = map_of(half_a_box);
  std::array<Pose, 2> poses{Pose::Identity(), Pose::Identity()};
  poses[1].translation().x() = std::nan("");
  const auto refused = gain.evaluate({map, executor}, {}, poses);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().to_string().find("pose 1"), std::string::npos);
}

TEST(SurfaceGain, NothingIsSeenThroughATable) {
  const TsdfSnapshot map = map_of(half_a_box);
  EXPECT_EQ(gain_from(map, {-0.6, 0.0, -0.05}), 0.0);
  EXPECT_EQ(gain_from(map, {0.0, 0.0, -0.6}), 0.0);
}

TEST(SurfaceGain, UnknownSpaceInBetweenHides) {
  const TsdfSnapshot map = map_of([](const Vector3d& p) {
    return p.x() < -0.15 && p.x() > -0.25 && p.z() > 0.0 ? VoxelState::unknown : half_a_box(p);
  });
  EXPECT_LT(gain_from(map, {-0.6, 0.0, 0.1}), 25.0);
  EXPECT_NEAR(gain_from(map, {0.0, 0.6, 0.1}), 90.0, 30.0);
}

}  // namespace
}  // namespace saccade
