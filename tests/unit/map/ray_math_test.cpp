// SPDX-License-Identifier: Apache-2.0
// Hand-made rays: crossings, ties, clipping, negative coordinates.
#include "saccade/map/ray_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "saccade/map/ray_walk.hpp"

namespace saccade {
namespace {

std::vector<Index3> visited(const LatticeRay& ray, const RaySpan& span) {
  std::vector<Index3> voxels;
  walk_cells<kVoxelLevel>(ray, span, [&](const Index3& voxel, const RaySpan&) {
    voxels.push_back(voxel);
    return false;
  });
  return voxels;
}

TEST(LatticePoint, FloorsTowardsMinusInfinityAndSnaps) {
  const LatticePoint p = lattice_point(-0.25, 3.0, 2.9999999999);
  EXPECT_EQ(p.voxel, (Index3{-1, 3, 3}));
  EXPECT_EQ(p.fraction[0], 0.75F);
  EXPECT_EQ(p.fraction[1], 0.0F);
  EXPECT_EQ(p.fraction[2], 0.0F);
  EXPECT_EQ(p, lattice_point(-0.25 + 1e-7, 3.0 - 1e-7, 3.0));
}

TEST(LatticeRay, DiagonalThroughCornersGoesThroughXThenYThenZ) {
  const LatticeRay ray = make_lattice_ray(lattice_point(0.5, 0.5, 0.5), 1.0F, 1.0F, 1.0F);
  const std::vector<Index3> expected{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {2, 2, 2}};
  EXPECT_EQ(visited(ray, {kRayStart, after_depth(1.5F)}), expected);
}

TEST(LatticeRay, NegativeDirectionFromAPlaneLeavesAtOnce) {
  const LatticeRay ray = make_lattice_ray(lattice_point(-8.0, 0.5, 0.5), -2.0F, 0.0F, 0.0F);
  const std::vector<Index3> expected{{-8, 0, 0}, {-9, 0, 0}, {-10, 0, 0}};
  EXPECT_EQ(visited(ray, {kRayStart, after_depth(0.5F)}), expected);
  EXPECT_EQ(entry_event(ray, {-9, 0, 0}).t, 0.0F);
  EXPECT_EQ(entry_event(ray, {-10, 0, 0}).t, 0.5F);
}

TEST(LatticeRay, EndOfDepthIsInclusive) {
  const LatticeRay ray = make_lattice_ray(lattice_point(0.0, 0.0, 0.0), 1.0F, 0.0F, 0.0F);
  EXPECT_EQ(visited(ray, {kRayStart, after_depth(2.0F)}).size(), 3U);
  EXPECT_EQ(visited(ray, {kRayStart, after_depth(std::nextafter(2.0F, 0.0F))}).size(), 2U);
}

TEST(LatticeRay, ClipFindsEntryAndExitOfABox) {
  const LatticeRay ray = make_lattice_ray(lattice_point(0.5, 0.5, 0.5), 1.0F, 0.0F, 0.0F);
  const RaySpan span = clip(ray, {{3, 0, 0}, {6, 1, 1}});
  EXPECT_EQ(visited(ray, span), (std::vector<Index3>{{3, 0, 0}, {4, 0, 0}, {5, 0, 0}}));
  EXPECT_EQ(span.enter.t, 2.5F);
  EXPECT_TRUE(clip(ray, {{3, 1, 0}, {6, 2, 1}}).empty()) << "beside a ray that never gets there";
  EXPECT_TRUE(clip(ray, {{-6, 0, 0}, {0, 1, 1}}).empty()) << "behind the origin";
  EXPECT_EQ(visited(ray, clip(ray, {{-6, 0, 0}, {2, 1, 1}})), (std::vector<Index3>{{0, 0, 0}, {1, 0, 0}}));
}

TEST(FirstVoxel, AbsentSectorsAreUnknownAndMasksDecide) {
  TsdfGrid grid;
  Sector& sector = grid.writable({0, 0, 0});
  for (BrickRef& brick : sector.bricks) brick = BrickRef::constant_free(5);
  DenseBrick& dense = sector.bricks[2].densify();  // voxels x in [16, 24)
  dense.v[static_cast<std::size_t>(child_index({19, 4, 4}))] = -100;
  dense.update_masks();
  for (int i = 0; i < kSectorBricks; ++i) sector.update_summary(i, 5);
  const SectorTable table{grid};

  const LatticeRay ray = make_lattice_ray(lattice_point(0.5, 4.5, 4.5), 10.0F, 0.0F, 0.0F);
  const RaySpan span{kRayStart, after_depth(10.0F)};
  const auto occupied = first_voxel(ray, span, table);
  ASSERT_TRUE(occupied.has_value());
  EXPECT_EQ(occupied->voxel, (Index3{19, 4, 4}));
  EXPECT_EQ(occupied->state, VoxelState::occupied);
  EXPECT_EQ(occupied->t, (19.0F - 0.5F) * (1.0F / 10.0F));

  const auto unknown = first_voxel(ray, span, table, {.unknown = true, .occupied = false});
  ASSERT_TRUE(unknown.has_value());
  EXPECT_EQ(unknown->voxel, (Index3{64, 4, 4}));
  const LatticeRay beside = make_lattice_ray(lattice_point(0.5, 4.5, 12.5), 10.0F, 0.0F, 0.0F);
  EXPECT_FALSE(first_voxel(beside, span, table, {.unknown = false, .occupied = true}).has_value());
}

}  // namespace
}  // namespace saccade
