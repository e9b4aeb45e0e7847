// SPDX-License-Identifier: Apache-2.0
// best_views of a whole workspace is the order of the gains that brute force finds, for hundreds of poses that share
// centres and rolls: clutter seen from a few sides, its shadows unknown, and the workspace cut anywhere.
#include "saccade/views/internal/best_views.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <numbers>
#include <random>

#include "saccade/core/simd.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "support/brute_force_gain.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kSeed{4711};
constexpr int kCenters{63};
constexpr int kRolls{8};
constexpr std::size_t kPoses{kCenters * kRolls};

/// A table with boxes and balls on it, as some frames from one side show it; all else in the workspace is unknown.
class SeenTable {
 public:
  explicit SeenTable(std::uint32_t seed) : random_{seed} {
    TsdfConfig config;
    config.voxel_size_m = real(0.02, 0.035);
    config.truncation_vox = 2.0;
    config.workspace =
        Box{{real(-0.6, -0.4), real(-0.6, -0.4), -0.05}, {real(0.3, 0.6), real(0.3, 0.6), real(0.3, 0.5)}};
    region = *config.workspace;
    if (seed % 3 == 0) std::get<Box>(region).max.x() -= 0.25;  // else unknown voxels outside it block
    scene_.objects = {{"table", HalfSpace{}}};
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector3d at{real(-0.3, 0.3), real(-0.3, 0.3), 0.0};
      const Eigen::Vector3d half{real(0.02, 0.1), real(0.02, 0.1), real(0.05, 0.25)};
      scene_.objects.push_back({"box", Box{at - half, at + half}});
    }
    TsdfMap made = TsdfMap::create(config).value();
    const PinholeCamera camera{160, 120, 131.0, 131.0, 79.5, 59.5, 0.3, 3.0};
    for (int view = 0; view < 3; ++view) {
      const Pose pose =
          look_at({real(-1.2, -0.7), real(-0.8, 0.2), real(0.3, 0.9)}, {0.0, 0.0, 0.1}, Eigen::Vector3d::UnitZ(), 0.0);
      const RenderedFrame seen = render(scene_, camera, pose, {}).value();
      EXPECT_TRUE(made.integrate(camera, seen.depth, pose, {}).ok());
    }
    map = made.snapshot();
    for (int i = 0; i < kCenters; ++i) add_rolls();
    gain.sensor = {36, 30, real(22.0, 34.0), 0.0, 17.5, 14.5, i_of(3) == 0 ? 0.0 : 0.4, 3.0};
    gain.sensor.fy = i_of(2) == 0 ? gain.sensor.fx : 1.1 * gain.sensor.fx;
  }

  TsdfSnapshot map;
  Region region;
  std::vector<Pose> poses;
  GainConfig gain;

 private:
  double real(double lo, double hi) { return std::uniform_real_distribution<double>{lo, hi}(random_); }
  int i_of(unsigned below) { return static_cast<int>(random_() % below); }

  void add_rolls() {
    const Eigen::Vector3d target{real(-0.4, 0.4), real(-0.4, 0.4), real(0.0, 0.2)};
    const Eigen::Vector3d away = Eigen::Vector3d{real(-1.0, 1.0), real(-1.0, 1.0), real(-0.1, 1.0)}.normalized();
    for (int roll = 0; roll < kRolls; ++roll) {
      poses.push_back(look_at(target + 0.75 * away, target, Eigen::Vector3d::UnitZ(), roll * std::numbers::pi / 4.0));
    }
  }

  std::mt19937 random_;
  AnalyticScene scene_;
};

constexpr int kMaps{test::scaled_cases(5)};

void expect_the_first_of_brute_force(int maps) {
  std::cout << "seed " << kSeed << '\n';
  const std::vector<std::string> targets = simd_targets();
  std::size_t compared{0};
  std::size_t evaluated{0};
  std::size_t nonzero{0};
  for (int i = 0; i < maps; ++i) {
    const SeenTable test{kSeed + static_cast<std::uint32_t>(i)};
    ASSERT_EQ(test.poses.size(), kPoses);
    const test::BruteForceGain brute_force{test.map, test.region, test.gain};
    std::vector<std::uint64_t> gains;
    for (const Pose& pose : test.poses) gains.push_back(brute_force(pose));
    nonzero += kPoses - static_cast<std::size_t>(std::count(gains.begin(), gains.end(), std::uint64_t{0}));
    const std::vector<OrderedView> expected = order_views(gains, test.poses);
    ASSERT_TRUE(use_simd_target(targets[static_cast<std::size_t>(i) % targets.size()]).ok());
    for (const std::size_t count : {std::size_t{1}, std::size_t{20}, kPoses}) {
      const auto best = best_views(test.map, test.region, test.poses, count, test.gain, Executor{});
      const auto again = best_views(test.map, test.region, test.poses, count, test.gain, Executor::with_threads(5));
      ASSERT_TRUE(best.ok() && again.ok());
      ASSERT_EQ(best->views.size(), count);
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_EQ(best->views[k].index, expected[k].index) << "map " << i << ", place " << k;
        ASSERT_EQ(best->views[k].gain, expected[k].gain) << "map " << i << ", place " << k;
        ASSERT_EQ(again->views[k].index, expected[k].index);
        ++compared;
      }
      EXPECT_EQ(best->poses_evaluated, again->poses_evaluated);
      EXPECT_EQ(best->rays_cast, again->rays_cast);
      if (count == 1) evaluated += best->poses_evaluated;
    }
  }
  ASSERT_TRUE(use_simd_target("").ok());
  EXPECT_EQ(compared, maps * (kPoses + 21));
  EXPECT_GT(nonzero, maps * kPoses / 2);
  EXPECT_LT(evaluated, maps * kPoses / 8) << "bounds exclude too few poses";
  std::cout << compared << " places compared; " << evaluated << " of " << maps * kPoses
            << " poses evaluated to find the best\n";
}

TEST(BestViewsProperty, AreTheFirstOfBruteForceInTheWholeWorkspace) {
  expect_the_first_of_brute_force((kMaps + 1) / 2);
}
TEST(BestViewsPropertyEvidence, AreTheFirstOfBruteForceInTheWholeWorkspace) { expect_the_first_of_brute_force(kMaps); }

}  // namespace
}  // namespace saccade
