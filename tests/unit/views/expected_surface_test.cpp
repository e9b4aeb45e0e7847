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

#include "support/written_map.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kEdge_m{0.01};

/// A workspace of 0.6 m × 0.6 m, from 0.1 m below the table to 0.4 m above.
TsdfSnapshot map_of(const test::StateAt& state_at) { return test::written_map(state_at); }

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

/// Unknown sides measure 9 cm × 9 cm; what lies at an edge faces two ways, or three. A share of 0.8 counts.
TEST(ExpectedSurface, SidesThatWereNotSeenAreExpectedDownToTheTable) {
  const ExpectedSurface surface = surface_of(map_of(half_a_box));
  ASSERT_EQ(surface.supports.size(), 1U);
  EXPECT_NEAR(surface.supports.front().height_m, 0.0, 1e-9);
  EXPECT_NEAR(surface.supports.front().area_m2, 0.35, 0.02);
  EXPECT_NEAR(surface.seen_cm2, 200.0, 40.0);
  EXPECT_NEAR(area_facing(surface, {-1, 0, 0}), 58.0, 12.0);
  EXPECT_NEAR(area_facing(surface, {0, 1, 0}), 58.0, 12.0);
  EXPECT_NEAR(area_facing(surface, {0, -1, 0}), 58.0, 12.0);
  EXPECT_LT(area_facing(surface, {1, 0, 0}), 5.0) << "it was seen";
  EXPECT_LT(area_facing(surface, {0, 0, 1}), 5.0);
}

TEST(ExpectedSurface, ATableWhoseTopIsTheFloorOfTheWorkspaceIsASupport) {
  TsdfSnapshot map = map_of(half_a_box);
  const ExpectedSurface whole = surface_of(map);
  map.config.workspace->min.z() = 0.0;
  const ExpectedSurface surface = surface_of(map);
  ASSERT_EQ(surface.supports.size(), 1U);
  EXPECT_NEAR(surface.supports.front().height_m, 0.0, 1e-9);
  EXPECT_NEAR(area_facing(surface, {-1, 0, 0}), area_facing(whole, {-1, 0, 0}), 1.0);
  EXPECT_LT(area_facing(surface, {0, 0, -1}), 5.0) << "nothing is looked for from below";
  for (const ExpectedPoint& point : surface.points) EXPECT_GT(point.position_m.z(), 0.0F);
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
  EXPECT_NEAR(area_facing(surface, {-1, 0, 0}), 115.0, 24.0);
  for (const ExpectedPoint& point : surface.points) {
    const bool upper = point.position_m.z() > 0.2F;
    EXPECT_NEAR(surface.supports[static_cast<std::size_t>(point.support)].height_m, upper ? 0.2 : 0.0, 1e-9);
  }
}

TEST(ExpectedSurface, ATableMayBeInclined) {
  const double slope = std::tan(8.0 * 3.14159265358979 / 180.0);
  const TsdfSnapshot map = map_of([&](const Vector3d& p) {
    const double z = p.z() - slope * p.x();
    const bool inside = std::abs(p.x()) < 0.05 && std::abs(p.y()) < 0.05 && z > 0.0 && z < 0.1;
    if (!inside) return z > 0.0 ? VoxelState::empty : z > -0.025 ? VoxelState::occupied : VoxelState::unknown;
    return z > 0.09 || p.x() > 0.04 ? VoxelState::occupied : VoxelState::unknown;
  });
  const ExpectedSurface surface = surface_of(map);
  ASSERT_EQ(surface.supports.size(), 1U);
  const Support& table = surface.supports.front();
  EXPECT_NEAR(table.slope.x(), slope, 0.01);
  EXPECT_NEAR(table.slope.y(), 0.0, 0.01);
  for (const double x : {-0.25, 0.0, 0.25}) EXPECT_NEAR(table.height_at({x, 0.1}), slope * x, 0.004) << x;
  EXPECT_EQ(surface.objects.size(), 1U) << "the table's ends are none";
  EXPECT_NEAR(area_facing(surface, {-1, 0, 0}), 58.0, 15.0);
  EXPECT_NEAR(area_facing(surface, {0, 1, 0}), 58.0, 15.0);
  const ExpectedPoint& point = surface.points.front();
  EXPECT_FALSE(surface.is_visible(point, {-0.6, 0.0, -0.1})) << "from below";
}

TEST(ExpectedSurface, APlaneThroughThreeBoxesIsNoSupport) {
  const TsdfSnapshot map = map_of([](const Vector3d& p) {
    for (const Vector3d& foot : {Vector3d{-0.18, -0.18, 0.0}, Vector3d{0.18, -0.18, 0.0}, Vector3d{0.0, 0.18, 0.0}}) {
      const Vector3d q = p - foot;
      if (q.cwiseAbs().head<2>().maxCoeff() > 0.09 || p.z() < 0.0 || p.z() > 0.1) continue;
      return p.z() > 0.09 || q.x() > 0.08 ? VoxelState::occupied : VoxelState::unknown;
    }
    return table_at(p);
  });
  const ExpectedSurface surface = surface_of(map);
  EXPECT_EQ(surface.supports.size(), 1U) << "their tops measure 0.097 m2";
  EXPECT_EQ(surface.objects.size(), 3U);
}

TEST(ExpectedSurface, WithoutASupportAThingEndsAtItsLowestVoxel) {
  const ExpectedSurface surface = surface_of(map_of([](const Vector3d& p) {
    const Vector3d q = p - Vector3d{0.0, 0.0, 0.1};
    return q.z() > 0.0 ? half_a_box(q) : VoxelState::empty;
  }));
  EXPECT_TRUE(surface.supports.empty());
  EXPECT_NEAR(area_facing(surface, {-1, 0, 0}), 58.0, 15.0);
  for (const ExpectedPoint& point : surface.points) {
    EXPECT_EQ(point.support, -1);
    EXPECT_GT(point.position_m.z(), 0.09F);
  }
}

/// A mug of 12 cm across, 10 cm high, its wall 2 cm thick, seen into from above, but its wall towards −x was not seen.
TEST(ExpectedSurface, InsideAnOpenVesselThereIsNone) {
  const TsdfSnapshot map = map_of([](const Vector3d& p) {
    const double r = p.head<2>().norm();
    if (r > 0.06 || p.z() < 0.0 || p.z() > 0.1) return table_at(p);
    if (r < 0.04 && p.z() > 0.015) return VoxelState::empty;
    return p.z() > 0.09 || p.x() > 0.0 || (r < 0.04 && p.z() > 0.005) ? VoxelState::occupied : VoxelState::unknown;
  });
  const ExpectedSurface surface = surface_of(map);
  double inwards_cm2{0.0};
  double outwards_cm2{0.0};
  for (const ExpectedPoint& point : surface.points) {
    EXPECT_GT(point.position_m.head<2>().norm(), 0.03F);
    const float out = point.normal.head<2>().dot(point.position_m.head<2>());
    (out > 0.0F ? outwards_cm2 : inwards_cm2) += static_cast<double>(point.area_cm2);
  }
  EXPECT_NEAR(outwards_cm2, 0.8 * 3.14159 * 6.0 * 9.0, 30.0) << "half of the outer wall";
  EXPECT_LT(inwards_cm2, 0.8 * 3.14159 * 4.0 * 9.0) << "no more than the unseen inner wall";
}

/// A ball of 12 cm across: the hull of its footprint is a cylinder. What is empty below its seen half is expected to be
/// empty below the other, too.
TEST(ExpectedSurface, ThingsAreAsEmptyOnTheirOtherSide) {
  const auto ball = [](bool both_sides, const Vector3d& p) {
    const double r = (p - Vector3d{0.0, 0.0, 0.06}).norm();
    if (r < 0.06) return r > 0.05 && (p.x() > 0.0 || p.z() > 0.06) ? VoxelState::occupied : VoxelState::unknown;
    const bool under = p.z() > 0.0 && p.z() < 0.06 && p.head<2>().norm() < 0.06;
    return under && p.x() < 0.0 && !both_sides ? VoxelState::unknown : table_at(p);
  };
  const auto outside_cm2 = [](const ExpectedSurface& surface) {
    double cm2{0.0};
    for (std::size_t i = 0; i < surface.completed; ++i) {
      const ExpectedPoint& point = surface.points[i];
      if ((point.position_m - Eigen::Vector3f{0.0F, 0.0F, 0.06F}).norm() > 0.07F)
        cm2 += static_cast<double>(point.area_cm2);
    }
    return cm2;
  };
  const ExpectedSurface surface = surface_of(map_of([&](const Vector3d& p) { return ball(false, p); }));
  ASSERT_EQ(surface.objects.size(), 1U);
  EXPECT_LT(outside_cm2(surface), 12.0);
  EXPECT_GT(area_facing(surface, Eigen::Vector3f{-1.0F, 0.0F, -1.0F}.normalized()), 10.0);
}

TEST(ExpectedSurface, PointsKnowTheirObject) {
  const TsdfSnapshot map = map_of([](const Vector3d& p) {
    return p.y() > 0.0 ? half_a_box(p - Vector3d{0.0, 0.15, 0.0}) : half_a_box(p + Vector3d{0.0, 0.15, 0.0});
  });
  const ExpectedSurface surface = surface_of(map);
  ASSERT_EQ(surface.objects.size(), 2U);
  std::array<int, 2> points{};
  for (const ExpectedPoint& point : surface.points) {
    ASSERT_TRUE(point.object == 0 || point.object == 1);
    const Box& box = surface.objects[static_cast<std::size_t>(point.object)];
    EXPECT_EQ(box.min.y() > 0.0, point.position_m.y() > 0.0F);
    ++points[static_cast<std::size_t>(point.object)];
  }
  EXPECT_GT(points[0], 20);
  EXPECT_GT(points[1], 20);
  const std::int32_t at_left = surface.object_near({0.0, -0.22, 0.05}, 0.05);
  ASSERT_GE(at_left, 0);
  EXPECT_LT(surface.objects[static_cast<std::size_t>(at_left)].max.y(), 0.0);
  EXPECT_EQ(surface.object_near({0.0, -0.28, 0.05}, 0.05), -1);
}

TEST(ExpectedSurface, TheThreadCountChangesNoBit) {
  const TsdfSnapshot map = map_of(half_a_box);
  const ExpectedSurface one = surface_of(map);
  for (const std::size_t threads : {2U, 5U}) {
    const ExpectedSurface other = expected_surface(map, {}, Executor::with_threads(threads)).value();
    EXPECT_EQ(other.seen_cm2, one.seen_cm2);
    ASSERT_EQ(other.points.size(), one.points.size());
    ASSERT_GT(one.points.size(), 50U);
    for (std::size_t i = 0; i < one.points.size(); ++i) {
      EXPECT_EQ(other.points[i].voxel, one.points[i].voxel);
      EXPECT_EQ(other.points[i].normal, one.points[i].normal);
      EXPECT_EQ(other.points[i].area_cm2, one.points[i].area_cm2);
      EXPECT_EQ(other.points[i].object, one.points[i].object);
    }
  }
}

/// A wall at x = −0.1 m, seen from its front alone, with a box of 10 cm on the table that touches it, of which the top
/// and the front were seen.
VoxelState box_at_a_wall(const Vector3d& p) {
  if (p.x() < -0.1) return p.x() > -0.13 && p.z() > 0.0 ? VoxelState::occupied : VoxelState::unknown;
  return half_a_box(p + Vector3d{0.05, 0.0, 0.0});
}

TEST(ExpectedSurface, ThingsReachToAWallAndNothingIsBehindIt) {
  const ExpectedSurface surface = surface_of(map_of(box_at_a_wall));
  ASSERT_EQ(surface.walls.size(), 1U);
  const Wall& wall = surface.walls.front();
  EXPECT_NEAR(wall.normal.x(), 1.0, 1e-3);
  EXPECT_NEAR(wall.offset_m, -0.1, 1e-3);
  ASSERT_EQ(surface.objects.size(), 1U) << "the box alone";
  EXPECT_NEAR(surface.objects.front().max.z(), 0.1, 1e-6);
  EXPECT_NEAR(area_facing(surface, {0, 1, 0}), 58.0, 15.0) << "its sides reach to the wall";
  EXPECT_NEAR(area_facing(surface, {0, -1, 0}), 58.0, 15.0);
  EXPECT_LT(area_facing(surface, {-1, 0, 0}), 5.0);
  for (const ExpectedPoint& point : surface.points) EXPECT_GT(point.position_m.x(), -0.1F);
}

TEST(ExpectedSurface, AWallAloneIsNoObject) {
  const ExpectedSurface surface = surface_of(map_of([](const Vector3d& p) {
    if (p.x() > -0.1) return VoxelState::empty;
    return p.x() > -0.13 ? VoxelState::occupied : VoxelState::unknown;
  }));
  EXPECT_EQ(surface.walls.size(), 1U);
  EXPECT_TRUE(surface.supports.empty());
  EXPECT_TRUE(surface.objects.empty());
  EXPECT_TRUE(surface.points.empty());
}

TEST(ExpectedSurface, TheSideOfALargeBoxIsNoWall) {
  const ExpectedSurface surface = surface_of(map_of([](const Vector3d& p) {
    const bool inside = p.x() < 0.1 && p.x() > -0.05 && std::abs(p.y()) < 0.25 && p.z() > 0.0 && p.z() < 0.35;
    if (!inside) return table_at(p);
    return p.z() > 0.33 || p.x() > 0.08 ? VoxelState::occupied : VoxelState::unknown;
  }));
  EXPECT_TRUE(surface.walls.empty()) << "0.175 m2 were seen, but past them, too";
  EXPECT_GT(area_facing(surface, {-1, 0, 0}), 500.0);
}

/// A pot of 20 cm, its walls and the upper half of its inside known; `notch` opens its side towards +x down to there.
VoxelState half_a_pot(const Vector3d& p, bool notch) {
  const double to_axis = p.cwiseAbs().head<2>().maxCoeff();
  if (to_axis > 0.1 || p.z() < 0.0 || p.z() > 0.2) return table_at(p);
  if (notch && p.z() > 0.1 && p.x() > 0.08) return VoxelState::empty;
  if (to_axis > 0.08) return VoxelState::occupied;
  return p.z() > 0.1 ? VoxelState::empty : VoxelState::unknown;
}

TEST(ExpectedSurface, BehindTheOpeningOfACavityThereIsMoreThanTheOpening) {
  const auto facing_up = [](bool notch, double behind_opening) {
    const TsdfSnapshot map = map_of([&](const Vector3d& p) { return half_a_pot(p, notch); });
    return area_facing(surface_of(map, {.behind_opening = behind_opening}), {0, 0, 1});
  };
  const double opening_cm2 = 0.8 * 16.0 * 16.0;
  EXPECT_NEAR(facing_up(false, 1.0), opening_cm2, 0.05 * opening_cm2);
  EXPECT_NEAR(facing_up(false, 2.0), 2.0 * opening_cm2, 0.1 * opening_cm2);
  EXPECT_NEAR(facing_up(true, 2.0), opening_cm2, 0.05 * opening_cm2) << "open to one side, it is no cavity";
}

TEST(ExpectedSurface, IsWorkedOutOnceForAChoice) {
  const TsdfSnapshot map = map_of(half_a_box);
  const Executor executor;
  std::shared_ptr<const ExpectedSurface> shared;
  PlanningContext context{map, executor};
  const auto alone = expected_surface(context, {}).value();
  context.expected = &shared;
  const auto first = expected_surface(context, {}).value();
  EXPECT_NE(first, alone);
  EXPECT_EQ(first->points.size(), alone->points.size());
  EXPECT_EQ(expected_surface(context, {}).value(), first);
  const auto other = expected_surface(context, {.completed_share = 0.4}).value();
  EXPECT_NE(other, first) << "it was made with another configuration";
  EXPECT_NEAR(area_facing(*other, {-1, 0, 0}), 0.5 * area_facing(*first, {-1, 0, 0}), 1.0);
}

TEST(ExpectedSurface, BadConfigurationsAreRefused) {
  const auto refused = [](auto change) {
    ExpectedSurfaceConfig config;
    change(config);
    return expected_surface({}, config, {}).error().code == Errc::invalid_argument;
  };
  EXPECT_TRUE(refused([](auto& c) { c.min_support_m2 = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.min_wall_m2 = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.reach_m = -1.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.decay_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.beside_share = 1.5; }));
  EXPECT_TRUE(refused([](auto& c) { c.completed_share = -0.1; }));
  EXPECT_TRUE(refused([](auto& c) { c.behind_opening = 0.9; }));
  EXPECT_TRUE(refused([](auto& c) { c.spacing_m = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.through_m = -0.1; }));
}

}  // namespace
}  // namespace saccade
