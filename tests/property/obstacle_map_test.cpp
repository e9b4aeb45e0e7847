// SPDX-License-Identifier: Apache-2.0
// Obstacle cells against a look at every voxel, distances and spheres against all boxes, and a map that is followed
// against one made anew, over random maps, cell sizes, fixtures, threads and instruction sets.
#include "saccade/arm/obstacle_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include "saccade/arm/internal/obstacle_field.hpp"
#include "saccade/core/simd.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_run.hpp"

namespace saccade {
namespace {

using test::RandomRun;

constexpr int kRuns{test::scaled_cases(36)};
constexpr int kSteps{5};
constexpr int kSpheresPerStep{800};

/// A random map in a random workspace, fixtures and cells.
class RandomObstacles {
 public:
  explicit RandomObstacles(std::uint32_t seed) : run_{seed} {
    TsdfConfig map = run_.config();
    const auto corner = [&](double lo, double hi) {
      return Eigen::Vector3d{Eigen::Vector3d::NullaryExpr([&] { return run_.uniform(lo, hi) * run_.extent(); })};
    };
    map.workspace = Box{corner(-1.0, -0.2), corner(0.1, 1.0)};
    config_.cell_size_m =
        map.voxel_size_m * (run_.integer(0, 3) == 0 ? run_.uniform(9.0, 30.0) : run_.uniform(2.0, 9.0));
    config_.unknown_is_obstacle = run_.integer(0, 2) != 0;
    config_.max_distance_m = run_.uniform(0.3, 12.0) * config_.cell_size_m;
    for (int i = run_.integer(0, 3); i > 0; --i) {
      const Eigen::Vector3d lo = corner(-1.5, 1.4);
      config_.fixtures.push_back({lo, lo + (corner(0.01, 0.5) * run_.uniform(0.1, 1.0)).eval()});
    }
    map_ = std::make_unique<TsdfMap>(TsdfMap::create(map).value());
  }

  [[nodiscard]] RandomRun& run() { return run_; }
  [[nodiscard]] const ObstacleConfig& config() const { return config_; }
  [[nodiscard]] TsdfSnapshot snapshot() const { return map_->snapshot(); }
  void step() {
    const int action = run_.integer(0, 9);
    if (action == 0) return;
    if (action <= 3) return free(run_.region());
    if (action <= 5) return forget(run_.region());
    const DepthImage depth = run_.depth();
    EXPECT_TRUE(map_->integrate(run_.camera(), depth, run_.pose(), {}).ok());
  }
  void free(const Region& region) { EXPECT_TRUE(map_->free(region).ok()); }
  void forget(const Region& region) { EXPECT_TRUE(map_->forget(region).ok()); }
  /// Multiples of 2⁻²⁰ m, which floats hold.
  [[nodiscard]] Eigen::Vector3d float_point(double reach) {
    constexpr double kStep_m{1.0 / (1 << 20)};
    return Eigen::Vector3d::NullaryExpr(
        [&] { return std::round(run_.uniform(-reach, reach) * run_.extent() / kStep_m) * kStep_m; });
  }

 private:
  RandomRun run_;
  ObstacleConfig config_;
  std::unique_ptr<TsdfMap> map_;
};

/// Every voxel of the cell is asked.
bool naive_obstacle(const TsdfSnapshot& map, const Index3& cell, int voxels_along, bool unknown_is_obstacle) {
  for (int z = 0; z < voxels_along; ++z) {
    for (int y = 0; y < voxels_along; ++y) {
      for (int x = 0; x < voxels_along; ++x) {
        const Index3 voxel = cell * voxels_along + Index3{x, y, z};
        if (!contains(*map.config.workspace, voxel_center(voxel, map.config.voxel_size_m))) continue;
        const VoxelState state = map.grid.state(voxel);
        if (state == VoxelState::occupied || (state == VoxelState::unknown && unknown_is_obstacle)) return true;
      }
    }
  }
  return false;
}

void expect_naive_cells(const TsdfSnapshot& map, const ObstacleMap& obstacles) {
  const ObstacleCells& cells = obstacles.cells();
  const int along = cells.voxels_along_cell();
  EXPECT_NEAR(cells.cell_edge_m(), obstacles.config().cell_size_m, 0.5001 * map.config.voxel_size_m);
  std::size_t count{0};
  std::size_t wrong{0};
  for (int z = cells.box().lo.z - 1; z <= cells.box().hi.z; ++z) {  // one more on each side
    for (int y = cells.box().lo.y - 1; y <= cells.box().hi.y; ++y) {
      for (int x = cells.box().lo.x - 1; x <= cells.box().hi.x; ++x) {
        const bool expected = naive_obstacle(map, {x, y, z}, along, obstacles.config().unknown_is_obstacle);
        count += expected ? 1U : 0U;
        wrong += expected != cells.is_obstacle({x, y, z}) ? 1U : 0U;
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(count, cells.obstacle_count());
}

double naive_distance(const std::vector<Box>& boxes, const Eigen::Vector3d& p) {
  double least = 1e300;
  for (const Box& box : boxes) {
    least = std::min(least, (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).squaredNorm());
  }
  return std::sqrt(least);
}

struct Tally {
  int spheres{0};
  int clear{0};
  int near_contact{0};
};

/// Random spheres, most of them within a few millimetres of contact, in float coordinates.
void expect_spheres(RandomObstacles& random, const ObstacleMap& obstacles, Tally& tally) {
  const std::vector<Box> boxes = obstacles.boxes();
  const ObstacleCells& cells = obstacles.cells();
  const double edge_m = cells.cell_edge_m();
  const Box workspace{cells.bounds_of(cells.box().lo).min, cells.bounds_of(cells.box().hi).min};
  std::vector<float> x, y, z, radius;
  std::vector<bool> touching;
  const auto slack_m = 1e-8;
  while (touching.size() < kSpheresPerStep) {
    const Eigen::Vector3d p = random.float_point(1.3);
    const double distance = naive_distance(boxes, p);
    const double most = obstacles.config().max_distance_m;
    EXPECT_NEAR(obstacles.distance_m(p), std::min(distance, most), slack_m);
    EXPECT_LE(obstacles.distance_bound_m(p), distance + slack_m);
    if (contains(workspace, p)) {
      EXPECT_GE(obstacles.distance_bound_m(p), std::min(distance, most) - (std::sqrt(3.0) + 0.5) * edge_m);
    }
    const double how = random.run().uniform(0.0, 1.0);
    const double off = how < 0.4 ? 1e-6 : how < 0.8 ? 0.1 * edge_m : 2.0 * edge_m;
    const auto r = static_cast<float>(std::clamp(distance + random.run().uniform(-off, off), 0.0, 30.0 * edge_m));
    if (std::abs(r - distance) < slack_m) continue;
    const bool touches = r > distance;
    EXPECT_EQ(obstacles.clear(p, r), !touches) << p.transpose() << ", radius " << r << ", distance " << distance;
    x.push_back(static_cast<float>(p.x()));
    y.push_back(static_cast<float>(p.y()));
    z.push_back(static_cast<float>(p.z()));
    radius.push_back(r);
    touching.push_back(touches);
    ++tally.spheres;
    tally.clear += touches ? 0 : 1;
    tally.near_contact += std::abs(r - distance) < 0.1 * edge_m ? 1 : 0;
  }
  std::vector<float> clearances(x.size());
  obstacles.clearance_bounds({x, y, z, radius}, clearances);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector3d p{x[i], y[i], z[i]};
    EXPECT_NEAR(clearances[i] + radius[i], obstacles.distance_bound_m(p), 2e-3 * edge_m);
    EXPECT_LE(clearances[i], obstacles.distance_m(p) - radius[i] + 1e-9);
  }
  // Lists of any length, and the first of each that touches.
  for (std::size_t begin = 0; begin < touching.size();) {
    const auto length = static_cast<std::size_t>(random.run().integer(0, 150));
    const std::size_t n = std::min(length, touching.size() - begin);
    const auto part = [&](const std::vector<float>& all) { return std::span{all}.subspan(begin, n); };
    std::size_t expected{0};
    while (expected < n && !touching[begin + expected]) ++expected;
    EXPECT_EQ(obstacles.first_touching({part(x), part(y), part(z), part(radius)}), expected);
    begin += std::min(expected + 1, n + 1);
  }
}

/// The distance of cells' centres from all boxes, as far as it is followed.
void expect_field(RandomObstacles& random, const ObstacleMap& obstacles) {
  const ObstacleField& field = obstacles.field();
  const ObstacleCells& cells = obstacles.cells();
  const std::vector<Box> boxes = obstacles.boxes();
  const double half_m = 0.5 * cells.cell_edge_m();
  for (int i = 0; i < 60; ++i) {
    const Index3 n = cells.size();
    const Index3 at{random.run().integer(0, n.x - 1), random.run().integer(0, n.y - 1),
                    random.run().integer(0, n.z - 1)};
    const Box bounds = cells.bounds_of(cells.box().lo + at);
    const double distance =
        std::min(naive_distance(boxes, 0.5 * (bounds.min + bounds.max)) / half_m, static_cast<double>(field.reach()));
    EXPECT_LE(field.distance(at), distance + 1e-4);
    EXPECT_GE(field.distance(at) * field.distance(at), distance * distance - 1.0 - 1e-4);
    if (obstacles.config().fixtures.empty()) {
      EXPECT_NEAR(field.distance(at), distance, 1e-4);
    }
  }
}

TEST(ObstacleMapProperty, CellsDistancesAndSpheresAreThoseOfAllVoxels) {
  std::cout << "seeds 1 to " << kRuns << "\n";
  const Executor executor = Executor::with_threads(3, test::kParallelBackend);
  Tally tally;
  std::size_t changed{0};
  int compared{0};
  for (std::uint32_t seed = 1; seed <= kRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomObstacles random{seed};
    ObstacleMap followed = ObstacleMap::create(random.snapshot(), random.config(), executor).value();
    for (int step = 0; step < kSteps; ++step, ++compared) {
      random.step();
      if (step == 2) random.step();
      const TsdfSnapshot map = random.snapshot();
      changed += followed.update(map, executor).value().cells;
      const ObstacleMap anew = ObstacleMap::create(map, random.config(), {}).value();
      ASSERT_TRUE(followed.cells() == anew.cells());
      ASSERT_TRUE(followed.field() == anew.field());
      ASSERT_EQ(followed.cells().obstacle_count(), anew.cells().obstacle_count());
      expect_naive_cells(map, followed);
      expect_field(random, followed);
      if (!followed.boxes().empty()) expect_spheres(random, followed, tally);
    }
  }
  EXPECT_EQ(compared, kRuns * kSteps);
  EXPECT_GT(changed, static_cast<std::size_t>(100 * kRuns));
  EXPECT_GT(tally.spheres, kRuns * kSteps * kSpheresPerStep * 2 / 3);
  EXPECT_GT(tally.clear, tally.spheres / 5);
  EXPECT_LT(tally.clear, tally.spheres * 4 / 5);
  EXPECT_GT(tally.near_contact, tally.spheres / 2);
  std::cout << tally.spheres << " spheres, " << tally.clear << " clear, " << tally.near_contact << " near contact\n";
}

TEST(ObstacleMapProperty, SameForEveryInstructionSet) {
  constexpr std::uint32_t kSeed{7};
  RandomObstacles random{kSeed};
  random.free(Sphere{{0.0, 0.0, 0.0}, 0.8 * random.run().extent()});
  for (int step = 0; step < kSteps; ++step) random.step();
  const TsdfSnapshot map = random.snapshot();
  const ObstacleMap expected = ObstacleMap::create(map, random.config(), {}).value();
  std::vector<float> x, y, z, radius;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p = random.float_point(1.2);
    x.push_back(static_cast<float>(p.x()));
    y.push_back(static_cast<float>(p.y()));
    z.push_back(static_cast<float>(p.z()));
    radius.push_back(static_cast<float>(random.run().uniform(0.0, 0.3) * random.run().extent()));
  }
  std::size_t targets{0};
  for (const std::string& target : simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(use_simd_target(target).ok());
    const ObstacleMap made = ObstacleMap::create(map, random.config(), {}).value();
    EXPECT_TRUE(made.field() == expected.field());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto one = [&](const std::vector<float>& all) { return std::span{all}.subspan(i, 1); };
      EXPECT_EQ(made.first_touching({one(x), one(y), one(z), one(radius)}) == 1,
                expected.clear({x[i], y[i], z[i]}, radius[i]));
    }
    ++targets;
  }
  ASSERT_TRUE(use_simd_target("").ok());
  EXPECT_GE(targets, 1U);
}

}  // namespace
}  // namespace saccade
