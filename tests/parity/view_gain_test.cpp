// SPDX-License-Identifier: Apache-2.0
// evaluate_views equals brute force to the ray: random maps, regions, poses, counts, treatments of unknown, ranges,
// tilt and workspaces; every saving alone, none and all; every thread count.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>

#include "saccade/core/simd.hpp"
#include "saccade/views/internal/best_views.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/brute_force_gain.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kSeed{977};

class RandomCase {
 public:
  explicit RandomCase(std::uint32_t seed) : random_{seed} {
    map.config.voxel_size_m = real(0.02, 0.05);
    if (chance(2)) {
      const Eigen::Vector3d corner{real(-1.5, -0.2), real(-1.5, -0.2), real(-1.5, -0.2)};
      map.config.workspace = Box{corner, corner + Eigen::Vector3d{real(0.6, 3.0), real(0.6, 3.0), real(0.6, 3.0)}};
    }
    fill_map();
    region = random_region();
    if (!chance(4)) forget_region();
    config.sensor = {20 + whole(60),
                     15 + whole(60),
                     real(40.0, 150.0),
                     real(40.0, 150.0),
                     0.0,
                     0.0,
                     chance(3) ? 0.0 : real(0.0, 0.8),
                     real(1.0, 4.0)};
    config.sensor.fy = chance(2) ? config.sensor.fx : config.sensor.fy;
    config.sensor.cx = 0.5 * (config.sensor.width - 1) + (chance(3) ? real(-5.0, 5.0) : 0.0);
    config.sensor.cy = 0.5 * (config.sensor.height - 1);
    config.tilt_rad = chance(4) ? 0.0873 : 0.0;
    config.count = chance(2) ? GainCount::rays : GainCount::distinct_voxels;
    config.unknown_outside = chance(2) ? UnknownOutside::blocks : UnknownOutside::transparent;
    make_poses();
  }

  TsdfSnapshot map;
  Region region;
  GainConfig config;
  std::vector<Pose> poses;

 private:
  double real(double lo, double hi) { return std::uniform_real_distribution<double>{lo, hi}(random_); }
  int whole(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }
  bool chance(int one_in) { return whole(one_in) == 0; }
  Eigen::Vector3d point(double reach) { return {real(-reach, reach), real(-reach, reach), real(-reach, reach)}; }

  void fill_map() {
    const int clutter = chance(3) ? 40 : 400;  // one in this number of bricks is not plainly free
    for (int s = 0; s < 64; ++s) {
      if (chance(40)) continue;
      Sector& sector = map.grid.writable({s % 4 - 2, s / 4 % 4 - 2, s / 16 - 2});
      for (int i = 0; i < kSectorBricks; ++i) {
        BrickRef& brick = sector.bricks[static_cast<std::size_t>(i)];
        if (chance(clutter)) {
          fill_brick(brick);
        } else {
          brick = BrickRef::constant_free(static_cast<std::uint16_t>(1 + whole(5)));
        }
        sector.update_summary(i, map.config.free_weight);
      }
    }
  }

  void fill_brick(BrickRef& brick) {
    if (chance(6)) return;  // unknown
    if (chance(3)) {
      FreeBrick& free = brick.expand_to_free();
      for (int i = 0; i < kBrickVoxels; ++i)
        free.set_weight(i, static_cast<std::uint16_t>(chance(3) ? 0 : 1 + whole(5)));
      return;
    }
    DenseBrick& dense = brick.densify();
    const int occupied = 2 + whole(20);
    for (std::size_t i = 0; i < kBrickVoxels; ++i) {
      dense.w[i] = chance(20) ? std::uint16_t{0} : std::uint16_t{3};
      dense.v[i] = static_cast<std::int16_t>(dense.w[i] == 0 ? 0 : chance(occupied) ? -5 : 9000);
    }
    dense.update_masks();
  }

  Region random_region() {
    const Eigen::Vector3d center = point(0.4);
    switch (whole(5)) {
      case 0:
        return Box{center - Eigen::Vector3d::Constant(real(0.1, 0.4)),
                   center + point(0.05).cwiseAbs() * 6.0 + Eigen::Vector3d::Constant(0.03)};
      case 1: return Cylinder{center, center + Eigen::Vector3d{0.1, 0.1, 0.3}, real(0.1, 0.3)};
      default: return Sphere{center, real(0.1, 0.5)};
    }
  }

  void forget_region() {
    const IndexBox box = voxels_with_center_in(bounds(region), map.config.voxel_size_m);
    for (int z = box.lo.z - 1; z <= box.hi.z; ++z) {
      for (int y = box.lo.y - 1; y <= box.hi.y; ++y) {
        for (int x = box.lo.x - 1; x <= box.hi.x; ++x) forget({x, y, z});
      }
    }
  }
  void forget(const Index3& voxel) {
    if (!contains(region, voxel_center(voxel, map.config.voxel_size_m))) return;
    const Index3 brick = parent(voxel);
    if (map.grid.find(parent(brick)) == nullptr) return;
    Sector& sector = map.grid.writable(parent(brick));
    const int child = child_index(brick);
    BrickRef& ref = sector.bricks[static_cast<std::size_t>(child)];
    if (DenseBrick* const dense = ref.dense() != nullptr ? &ref.writable_dense() : nullptr) {
      dense->v[static_cast<std::size_t>(child_index(voxel))] = 0;
      dense->w[static_cast<std::size_t>(child_index(voxel))] = 0;
      dense->update_masks();
    } else {
      ref.expand_to_free().set_weight(child_index(voxel), 0);
      ref.canonicalize(map.config.free_weight);
    }
    sector.update_summary(child, map.config.free_weight);
  }

  void make_poses() {
    const Box box = bounds(region);
    const Eigen::Vector3d center = 0.5 * (box.min + box.max);
    for (int i = 0; i < 4; ++i) {
      Eigen::Vector3d from = center + point(1.0).normalized() * real(0.05, 1.6);
      if (chance(3)) from = (from / map.config.voxel_size_m).array().round() * map.config.voxel_size_m;
      const Eigen::Vector3d target = center + (chance(2) ? point(0.3) : Eigen::Vector3d::Zero());
      for (int roll = 0; roll < 3; ++roll) {
        poses.push_back(look_at(from, target, Eigen::Vector3d::UnitZ(), roll * 1.5707963267948966));
      }
    }
    Pose axis_parallel{Pose::Identity()};
    axis_parallel.translation() = center - Eigen::Vector3d{0.0, 0.0, 1.0};
    poses.push_back(axis_parallel);
  }

  std::mt19937 random_;
};

std::vector<GainSavings> all_savings() {
  std::vector<GainSavings> list{GainSavings{}, GainSavings::none()};
  for (bool GainSavings::*const one :
       {&GainSavings::region_rays, &GainSavings::region_exit, &GainSavings::empty_bricks, &GainSavings::blocked_camera,
        &GainSavings::shared_lattice, &GainSavings::exposed_voxels, &GainSavings::tiles, &GainSavings::packets,
        &GainSavings::footprints}) {
    GainSavings without;
    without.*one = false;
    list.push_back(without);
    GainSavings only = GainSavings::none();
    only.*one = true;
    list.push_back(only);
  }
  return list;
}

TEST(ViewGainParity, EqualsBruteForceToTheRay) {
  std::cout << "seed " << kSeed << '\n';
  constexpr int kMaps{test::scaled_cases(24)};
  const std::vector<GainSavings> savings = all_savings();
  const Executor executors[]{Executor::with_threads(1), Executor::with_threads(2), Executor::with_threads(7)};
  const std::vector<std::string> targets = simd_targets();
  std::size_t compared{0};
  std::uint64_t total_gain{0};
  std::uint64_t cast_with_tiles{0};
  std::uint64_t cast_without{0};
  int nonzero{0};
  for (int i = 0; i < kMaps; ++i) {
    RandomCase test{kSeed + static_cast<std::uint32_t>(i)};
    const test::BruteForceGain brute_force{test.map, test.region, test.config};
    std::vector<std::uint64_t> expected;
    for (const Pose& pose : test.poses) expected.push_back(brute_force(pose));
    for (std::size_t s = 0; s < savings.size(); ++s) {
      test.config.savings = savings[s];
      const Executor& executor = executors[(static_cast<std::size_t>(i) + s) % std::size(executors)];
      ASSERT_TRUE(use_simd_target(targets[(static_cast<std::size_t>(i) + s) % targets.size()]).ok());
      const auto result = evaluate_views(test.map, test.region, test.poses, test.config, executor);
      ASSERT_TRUE(result.ok()) << result.error().to_string();
      EXPECT_EQ(result->backend, executor.backend_name());
      ASSERT_EQ(result->gains, expected) << "map " << i << ", savings " << s;
      compared += expected.size();
      if (s == 0) cast_with_tiles += result->rays_cast;
      if (s == 1) cast_without += result->rays_cast;
    }
    for (const std::uint64_t gain : expected) {
      total_gain += gain;
      nonzero += gain > 0 ? 1 : 0;
    }
  }
  ASSERT_TRUE(use_simd_target("").ok());
  EXPECT_EQ(compared, std::size_t{kMaps} * savings.size() * 13);
  EXPECT_GT(nonzero, kMaps * 13 / 4);
  EXPECT_GT(total_gain, static_cast<std::uint64_t>(kMaps) * 800U);
  EXPECT_LT(cast_with_tiles * 2, cast_without) << "the savings save nothing";
  std::cout << compared << " gains compared, " << nonzero << " of " << kMaps * 13 << " not zero, rays cast "
            << cast_with_tiles << " of " << cast_without << '\n';
}

/// Cameras in the middle of voxels, turned along the lattice: rays through pixels of the diagonals cross two planes at
/// the same time, everywhere, so the order of the axes decides which voxels they visit.
TEST(ViewGainParity, RaysThroughEdgesOfVoxelsFollowTheOrderOfTheAxes) {
  constexpr int kMaps{std::max(4, test::scaled_cases(16))};  // the first alone gain nothing
  const std::vector<std::string> targets = simd_targets();
  std::uint64_t total{0};
  for (int i = 0; i < kMaps; ++i) {
    RandomCase test{kSeed + 2000 + static_cast<std::uint32_t>(i)};
    test.config.sensor = {65, 65, 32.0, 32.0, 32.0, 32.0, 0.0, 4.0};
    test.config.tilt_rad = 0.0;
    test.config.count = GainCount::rays;
    const double e = test.map.config.voxel_size_m;
    const auto middle = [e](double x) { return (std::floor(x / e) + 0.5) * e; };
    for (std::size_t k = 0; k < test.poses.size(); ++k) {
      Pose& T = test.poses[k];
      T.translation() = T.translation().unaryExpr(middle).eval();
      const int axis = static_cast<int>(k) % 3;
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      T.linear().setZero();
      T.linear()((axis + 1) % 3, 0) = sign;
      T.linear()((axis + 2) % 3, 1) = 1.0;
      T.linear()(axis, 2) = sign;
    }
    const test::BruteForceGain brute_force{test.map, test.region, test.config};
    std::vector<std::uint64_t> expected;
    for (const Pose& pose : test.poses) expected.push_back(brute_force(pose));
    for (const std::string& target : targets) {
      ASSERT_TRUE(use_simd_target(target).ok());
      const auto result = evaluate_views(test.map, test.region, test.poses, test.config, Executor{});
      ASSERT_TRUE(result.ok()) << result.error().to_string();
      ASSERT_EQ(result->gains, expected) << "map " << i << " on " << target;
    }
    for (const std::uint64_t gain : expected) total += gain;
  }
  ASSERT_TRUE(use_simd_target("").ok());
  EXPECT_GT(total, static_cast<std::uint64_t>(kMaps) * 100U);
}

TEST(ViewGainParity, TheBestViewsAreTheFirstOfAllWithoutEvaluatingAll) {
  constexpr int kMaps{test::scaled_cases(60)};
  std::size_t evaluated{0};
  std::size_t poses{0};
  for (int i = 0; i < kMaps; ++i) {
    const RandomCase test{kSeed + 1000 + static_cast<std::uint32_t>(i)};
    const auto all = evaluate_views(test.map, test.region, test.poses, test.config, Executor{});
    ASSERT_TRUE(all.ok());
    const std::vector<OrderedView> expected = order_views(all->gains, test.poses);
    for (const std::size_t count : {std::size_t{1}, std::size_t{3}, test.poses.size() + 5}) {
      const auto best = best_views(test.map, test.region, test.poses, count, test.config, Executor{});
      const auto again = best_views(test.map, test.region, test.poses, count, test.config, Executor::with_threads(7));
      ASSERT_TRUE(best.ok() && again.ok());
      ASSERT_EQ(best->views.size(), std::min(count, expected.size()));
      for (std::size_t k = 0; k < best->views.size(); ++k) {
        ASSERT_EQ(best->views[k].index, expected[k].index) << "map " << i << ", place " << k;
        ASSERT_EQ(best->views[k].gain, expected[k].gain);
        ASSERT_EQ(again->views[k].index, expected[k].index);
      }
      EXPECT_EQ(best->poses_evaluated, again->poses_evaluated);
      if (count == 1 && test.config.count == GainCount::rays) {
        evaluated += best->poses_evaluated;
        poses += test.poses.size();
      }
    }
  }
  EXPECT_LT(evaluated * 10, poses * 9) << "of " << poses;
  EXPECT_FALSE(best_views({}, Sphere{{0.0, 0.0, 0.0}, 0.1}, {}, 0, {}, Executor{}).ok());
}

/// Free space with one forgotten ball and a wall behind it: here tiles decide nearly all rays.
TEST(ViewGainParity, TilesDecideMostRaysOfAClearSceneExactly) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  auto map = TsdfMap::create(config);
  ASSERT_TRUE(map.ok());
  ASSERT_TRUE(map->free(Box{Eigen::Vector3d::Constant(-0.7), Eigen::Vector3d::Constant(0.7)}).ok());
  const Region region{Sphere{{0.013, 0.004, -0.006}, 0.2}};
  ASSERT_TRUE(map->forget(region).ok());
  const TsdfSnapshot snapshot = map->snapshot();
  ViewSphereConfig sphere;
  sphere.radii_m = {0.6};
  sphere.latitude_step_rad = 0.7853981633974483;
  sphere.longitude_step_rad = 2.0943951023931953;
  const auto candidates = view_sphere({0.0, 0.0, 0.0}, sphere);
  ASSERT_TRUE(candidates.ok());
  const std::vector<Pose> poses = poses_of(*candidates);
  GainConfig gain;
  gain.sensor = {160, 120, 131.25, 131.25, 79.5, 59.5, 0.3, 6.0};
  gain.savings.packets = false;  // with packets, tiles leave more to the rays
  const auto result = evaluate_views(snapshot, region, poses, gain, Executor::with_threads(2));
  ASSERT_TRUE(result.ok());
  std::uint64_t total{0};
  int compared{0};
  for (std::size_t i = 0; i < poses.size(); i += 18) {
    ASSERT_EQ(result->gains[i], test::BruteForceGain(snapshot, region, gain)(poses[i])) << "pose " << i;
    ++compared;
  }
  for (const std::uint64_t n : result->gains) total += n;
  EXPECT_EQ(compared, 4);
  EXPECT_GT(total, 72U * 4000U);
  EXPECT_LT(result->rays_cast * 25, total) << "tiles and shared lattices decide too few rays";
}

}  // namespace
}  // namespace saccade
