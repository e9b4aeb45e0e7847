// SPDX-License-Identifier: Apache-2.0
// The hierarchical walk visits the voxels of the voxel-by-voxel walk, one for one, with the same crossing times.
#include "saccade/map/ray_walk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <random>
#include <vector>

#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kRaysSeed{20240611};

struct Visit {
  Index3 voxel;
  RayEvent enter;
};
bool same_bits(const Visit& a, const Visit& b) {
  return a.voxel == b.voxel && std::memcmp(&a.enter.t, &b.enter.t, sizeof(float)) == 0 && a.enter.axis == b.enter.axis;
}

/// The definition, written independently of LatticeWalk: the axis whose next plane is crossed first, ties x < y < z.
std::vector<Visit> plain_walk(const LatticeRay& ray, const RayEvent& limit) {
  std::vector<Visit> visits{{ray.origin, kRayStart}};
  Index3 p{0, 0, 0};
  for (;;) {
    std::int32_t* const position[3]{&p.x, &p.y, &p.z};
    int first{-1};
    float t_first{std::numeric_limits<float>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
      if (ray.d[axis] == 0.0F) continue;
      const std::int32_t plane = ray.d[axis] > 0.0F ? *position[axis] + 1 : *position[axis];
      const float t = (static_cast<float>(plane) - ray.o[axis]) * (1.0F / ray.d[axis]);
      if (t < t_first) {
        t_first = t;
        first = axis;
      }
    }
    const RayEvent event{t_first, first};
    if (first < 0 || !before(event, limit)) return visits;
    *position[first] += ray.d[first] > 0.0F ? 1 : -1;
    visits.push_back({ray.origin + p, event});
  }
}

class RandomRays {
 public:
  explicit RandomRays(std::uint32_t seed) : random_{seed} {}

  LatticeRay next() {
    const LatticePoint from{origin()};
    for (;;) {
      float d[3];
      const int kind = static_cast<int>(random_() % 5);
      for (float& component : d) component = direction(kind);
      if (d[0] != 0.0F || d[1] != 0.0F || d[2] != 0.0F) return make_lattice_ray(from, d[0], d[1], d[2]);
    }
  }
  float depth() { return std::uniform_real_distribution<float>{0.01F, 6.0F}(random_); }
  std::uint32_t bits() { return static_cast<std::uint32_t>(random_()); }

 private:
  LatticePoint origin() {
    std::uniform_real_distribution<double> anywhere{-70.0, 70.0};
    double p[3];
    const int kind = static_cast<int>(random_() % 4);
    for (double& x : p) {
      x = anywhere(random_);
      if (kind == 1) x = std::round(x);              // a corner of voxels
      if (kind == 2) x = std::round(x / 8.0) * 8.0;  // a corner of bricks
      if (kind == 3) x = std::floor(x) + 0.5;        // a centre
    }
    return lattice_point(p[0], p[1], p[2]);
  }
  float direction(int kind) {
    switch (kind) {
      case 0: return static_cast<float>(static_cast<int>(random_() % 3) - 1) * 16.0F;  // axes and exact diagonals
      case 1: return static_cast<float>(static_cast<int>(random_() % 9) - 4) * 8.0F;   // lattice slopes
      case 2: return random_() % 4 == 0 ? 0.0F : any(-40.0F, 40.0F);                   // in a plane of the lattice
      case 3: return any(-1e-3F, 1e-3F) * static_cast<float>(random_() % 2 == 0 ? 1 : 40000);  // nearly parallel
      default: return any(-60.0F, 60.0F);
    }
  }
  float any(float lo, float hi) { return std::uniform_real_distribution<float>{lo, hi}(random_); }

  std::mt19937 random_;
};

template <int kLevel>
void collect(const LatticeRay& ray, const RaySpan& span, std::vector<Visit>& visits) {
  if constexpr (kLevel == kVoxelLevel) {
    walk_cells<kVoxelLevel>(ray, span, [&](const Index3& voxel, const RaySpan& in_voxel) {
      visits.push_back({voxel, in_voxel.enter});
      return false;
    });
  } else {
    walk_cells<kLevel>(ray, span, [&](const Index3&, const RaySpan& in_cell) {
      collect<kLevel - 3>(ray, in_cell, visits);
      return false;
    });
  }
}

TEST(RayWalk, HierarchyVisitsTheVoxelsOfThePlainWalk) {
  std::cout << "seed " << kRaysSeed << '\n';
  constexpr int kRays{test::scaled_cases(20000)};
  RandomRays rays{kRaysSeed};
  std::size_t compared{0};
  int ties{0};
  for (int i = 0; i < kRays; ++i) {
    const LatticeRay ray = rays.next();
    const RaySpan span{kRayStart, after_depth(rays.depth())};
    const std::vector<Visit> plain = plain_walk(ray, span.exit);
    std::vector<Visit> nested;
    collect<kSectorLevel>(ray, span, nested);
    ASSERT_EQ(nested.size(), plain.size()) << "ray " << i;
    for (std::size_t k = 0; k < plain.size(); ++k) {
      ASSERT_TRUE(same_bits(nested[k], plain[k])) << "ray " << i << ", voxel " << k;
      if (k > 0 && plain[k].enter.t == plain[k - 1].enter.t) ++ties;
      const RayEvent entered = entry_event(ray, plain[k].voxel);
      ASSERT_TRUE(entered.t == plain[k].enter.t && entered.axis == plain[k].enter.axis) << "ray " << i;
    }
    compared += plain.size();
  }
  EXPECT_GT(compared, 50U * kRays);
  EXPECT_GT(ties, kRays / 2);
}

TEST(RayWalk, ClipCutsThePlainWalk) {
  std::cout << "seed " << kRaysSeed + 1 << '\n';
  constexpr int kRays{test::scaled_cases(20000)};
  RandomRays rays{kRaysSeed + 1};
  int met{0};
  for (int i = 0; i < kRays; ++i) {
    const LatticeRay ray = rays.next();
    const RayEvent limit = after_depth(rays.depth());
    IndexBox box;
    box.lo = ray.origin + Index3{static_cast<int>(rays.bits() % 81) - 50, static_cast<int>(rays.bits() % 81) - 50,
                                 static_cast<int>(rays.bits() % 81) - 50};
    box.hi = box.lo + Index3{1 + static_cast<int>(rays.bits() % 40), 1 + static_cast<int>(rays.bits() % 40),
                             1 + static_cast<int>(rays.bits() % 40)};
    std::vector<Visit> expected;
    for (const Visit& visit : plain_walk(ray, limit)) {
      if (box.contains(visit.voxel)) expected.push_back(visit);
    }
    std::vector<Visit> clipped;
    collect<kBrickLevel>(ray, clip(ray, box).until(limit), clipped);
    ASSERT_EQ(clipped.size(), expected.size()) << "ray " << i;
    for (std::size_t k = 0; k < expected.size(); ++k) ASSERT_TRUE(same_bits(clipped[k], expected[k])) << "ray " << i;
    met += expected.empty() ? 0 : 1;
  }
  EXPECT_GT(met, kRays / 20);
}

/// Sectors around the origin, some absent, with a mix of the four kinds of brick.
TsdfGrid random_grid(std::mt19937& random) {
  TsdfGrid grid;
  for (int s = 0; s < 27; ++s) {
    if (random() % 4 == 0) continue;
    Sector& sector = grid.writable({s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1});
    for (int i = 0; i < kSectorBricks; ++i) {
      BrickRef& brick = sector.bricks[static_cast<std::size_t>(i)];
      const unsigned kind = random() % 64;
      if (kind >= 4) brick = BrickRef::constant_free(static_cast<std::uint16_t>(1 + random() % 5));
      if (kind == 1) {
        FreeBrick& free = brick.expand_to_free();
        free = FreeBrick::constant(3);
        for (int n = 0; n < 4; ++n) free.set_weight(static_cast<int>(random() % kBrickVoxels), 0);
      }
      if (kind == 2 || kind == 3) {
        DenseBrick& dense = brick.densify();
        for (std::size_t v = 0; v < kBrickVoxels; ++v) {
          const bool known = random() % 8 != 0;
          dense.w[v] = known ? std::uint16_t{4} : std::uint16_t{0};
          dense.v[v] = known ? static_cast<std::int16_t>(random() % 8 == 0 ? -100 : 20000) : std::int16_t{0};
        }
        dense.update_masks();
      }
      sector.update_summary(i, 5);
    }
  }
  return grid;
}

TEST(FirstVoxel, IsThatOfThePlainWalkInRandomMaps) {
  std::cout << "seed " << kRaysSeed + 2 << '\n';
  std::mt19937 random{kRaysSeed + 2};
  RandomRays rays{kRaysSeed + 3};
  int compared{0};
  int hits{0};
  for (int map = 0; map < 10; ++map) {
    const TsdfGrid grid = random_grid(random);
    const SectorTable table{grid};
    for (int i = 0; i < 1000; ++i) {
      const LatticeRay ray = rays.next();
      const RaySpan span{kRayStart, after_depth(rays.depth())};
      const StopAt stop{.unknown = random() % 2 == 0, .occupied = true};
      std::optional<Visit> expected;
      for (const Visit& visit : plain_walk(ray, span.exit)) {
        const VoxelState state = grid.state(visit.voxel);
        if (state == VoxelState::empty || (state == VoxelState::unknown && !stop.unknown)) continue;
        expected = visit;
        break;
      }
      const std::optional<VoxelHit> hit = first_voxel(ray, span, table, stop);
      ASSERT_EQ(hit.has_value(), expected.has_value()) << "map " << map << " ray " << i;
      ++compared;
      if (!hit) continue;
      ++hits;
      ASSERT_EQ(hit->voxel, expected->voxel);
      ASSERT_EQ(hit->t, expected->enter.t);
      ASSERT_EQ(hit->state, grid.state(expected->voxel));
    }
  }
  EXPECT_EQ(compared, 10000);
  EXPECT_GT(hits, 3000);
}

}  // namespace
}  // namespace saccade
