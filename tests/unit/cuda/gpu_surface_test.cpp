// SPDX-License-Identifier: Apache-2.0
// The expected surface by the kernels of the GPU, run on the host, against that of the CPU: to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <random>

#include "ordered_device.hpp"
#include "saccade/cuda/gpu_map.hpp"
#include "saccade/views/expected_surface.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/surface_gain.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_map.hpp"
#include "support/written_map.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr int kScenes{test::scaled_cases(8)};
constexpr int kRandomMaps{test::scaled_cases(12)};

Executor a_pair_of_threads() { return Executor::with_threads(2, test::kParallelBackend); }

/// Boxes on a table, of which some sides were seen; a cup, sometimes a wall, and holes in what was seen.
TsdfSnapshot random_table(std::uint32_t seed) {
  std::mt19937 random{seed};
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>{lo, hi}(random); };
  std::vector<Box> boxes;
  std::vector<Vector3d> seen_from;
  for (int i = 0; i < 3; ++i) {
    const Vector3d at{uniform(-0.2, 0.2), uniform(-0.2, 0.2), 0.0};
    const Vector3d size{uniform(0.03, 0.08), uniform(0.03, 0.08), uniform(0.05, 0.2)};
    boxes.push_back({at - Vector3d{size.x(), size.y(), 0.0}, at + size});
    seen_from.push_back(Vector3d{uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(0.0, 1.0)});
  }
  const double wall_x = seed % 3 == 0 ? 0.25 : 1.0;
  const double shadow_y = uniform(-0.3, 0.5);
  return test::written_map([&](const Vector3d& p) {
    if (p.x() > wall_x) return p.x() < wall_x + 0.02 ? VoxelState::occupied : VoxelState::unknown;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Box& box = boxes[i];
      const bool inside = (p - box.min).minCoeff() > 0.0 && (box.max - p).minCoeff() > 0.0;
      if (!inside) continue;
      const Vector3d from_middle = p - 0.5 * (box.min + box.max);
      if (i == 2 && from_middle.head<2>().norm() < 0.02 && p.z() > 0.03) return VoxelState::empty;  // hollow
      const bool at_side = p.x() + 0.012 > box.max.x() || p.z() + 0.012 > box.max.z() || p.y() - 0.012 < box.min.y();
      return at_side && from_middle.dot(seen_from[i]) > 0.0 ? VoxelState::occupied : VoxelState::unknown;
    }
    if (p.z() < 0.0) return p.z() > -0.02 ? VoxelState::occupied : VoxelState::unknown;
    return p.y() > shadow_y && p.z() < 0.1 ? VoxelState::unknown : VoxelState::empty;
  });
}

bool same_points(const ExpectedPoint& a, const ExpectedPoint& b) {
  return a.voxel == b.voxel && a.support == b.support && a.object == b.object && a.position_m == b.position_m &&
         a.normal == b.normal && a.area_cm2 == b.area_cm2;
}

void expect_equal(const ExpectedSurface& got, const ExpectedSurface& wanted) {
  ASSERT_EQ(got.volume->size(), wanted.volume->size());
  EXPECT_TRUE(got.volume->size() == 0 ||
              std::memcmp(got.volume->data(), wanted.volume->data(), wanted.volume->size()) == 0);
  EXPECT_EQ(got.seen_cm2, wanted.seen_cm2);
  EXPECT_EQ(got.supports.size(), wanted.supports.size());
  EXPECT_EQ(got.walls.size(), wanted.walls.size());
  EXPECT_EQ(got.objects.size(), wanted.objects.size());
  EXPECT_EQ(got.completed, wanted.completed);
  ASSERT_EQ(got.points.size(), wanted.points.size());
  std::size_t different{0};
  for (std::size_t i = 0; i < got.points.size(); ++i) different += same_points(got.points[i], wanted.points[i]) ? 0 : 1;
  EXPECT_EQ(different, 0U) << "of " << got.points.size();
}

TEST(GpuSurface, EqualsThatOfTheCpuOnTables) {
  std::size_t completed{0};
  std::size_t beside{0};
  for (std::uint32_t seed = 1; seed <= kScenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    GpuMap gpu = test::ordered_map({}, a_pair_of_threads(), seed - 1);
    const TsdfSnapshot map = random_table(seed);
    ExpectedSurfaceConfig config;
    if (seed % 4 == 0) config.reach_m = 0.03;
    if (seed % 5 == 0) config.spacing_m = 0.004;
    const ExpectedSurface wanted = expected_surface(map, config, {}).value();
    const ExpectedSurface got = expected_surface(map, config, a_pair_of_threads(), &gpu).value();
    EXPECT_NE(got.volume->ticket(), 0U) << "the device did the work";
    expect_equal(got, wanted);
    completed += wanted.completed;
    beside += wanted.points.size() - wanted.completed;
  }
  EXPECT_GT(completed, static_cast<std::size_t>(kScenes) * 50);
  EXPECT_GT(beside, static_cast<std::size_t>(kScenes) * 20);
}

TEST(GpuSurface, EqualsThatOfTheCpuOnRandomMaps) {
  std::size_t points{0};
  for (std::uint32_t seed = 1; seed <= kRandomMaps; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomMap random{seed};
    GpuMap gpu = test::ordered_map(random.snapshot().config, a_pair_of_threads(), seed - 1);
    for (int step = 0; step < 4; ++step) {
      random.step();
      TsdfSnapshot map = random.snapshot();
      if (seed % 2 == 0) {
        const Vector3d half = Vector3d::Constant(0.7 * random.run().extent());
        map.config.workspace = Box{-half, half};
      }
      if (map.grid.known_bounds().count() > 2e7) continue;
      ExpectedSurfaceConfig config;
      config.reach_m = 6.0 * map.config.voxel_size_m;
      config.decay_m = 3.0 * map.config.voxel_size_m;
      config.min_support_m2 = 400.0 * map.config.voxel_size_m * map.config.voxel_size_m;
      const ExpectedSurface wanted = expected_surface(map, config, {}).value();
      const ExpectedSurface got = expected_surface(map, config, {}, &gpu).value();
      EXPECT_TRUE(got.volume->ticket() != 0U || got.volume->size() == 0);
      expect_equal(got, wanted);
      points += wanted.points.size();
    }
  }
  EXPECT_GT(points, static_cast<std::size_t>(kRandomMaps) * 100);
}

TEST(GpuSurface, AnEmptyMapHasNone) {
  GpuMap gpu = GpuMap::create_emulated({}, {}).value();
  EXPECT_TRUE(expected_surface(TsdfSnapshot{}, {}, {}, &gpu).value().points.empty());
  const auto unknown = test::written_map([](const Vector3d&) { return VoxelState::unknown; });
  const ExpectedSurface surface = expected_surface(unknown, {}, {}, &gpu).value();
  EXPECT_NE(surface.volume->ticket(), 0U);
  EXPECT_TRUE(surface.points.empty());
}

/// A choice of views of a table: gains by lines of sight, with and without a device.
struct Choice {
  TsdfSnapshot map;
  Executor executor{a_pair_of_threads()};
  std::vector<CheckedView> checked{};
  std::vector<Pose> poses{};

  explicit Choice(std::uint32_t seed) : map{random_table(seed)} {
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> at{-1.0, 1.0};
    for (int i = 0; i < 40; ++i) {
      const Vector3d position = Vector3d{at(random), at(random), 0.6 + 0.4 * at(random)}.normalized() * 0.8;
      for (int roll = 0; roll < 2; ++roll)
        poses.push_back(look_at(position, {0.0, 0.0, 0.05}, Vector3d::UnitZ(), roll * 1.5));
    }
    if (seed % 2 == 0) checked = {{poses[0], 0.1}, {poses[5], 0.6}};
  }
  [[nodiscard]] RankedViews best(ViewDevice* device, double doubtful_share) const {
    SurfaceGainConfig config;
    config.sensor.min_range_m = 0.2;
    config.doubtful_share = doubtful_share;
    PlanningContext context{map, executor};
    context.checked = checked;
    context.device = device;
    RegionOfInterest region;
    region.bounds = Box{{-0.3, -0.3, -0.1}, {0.3, 0.3, 0.4}};
    return SurfaceGain{config}.best(context, region, poses, 5).value();
  }
};

void expect_equal(const RankedViews& got, const RankedViews& wanted) {
  EXPECT_EQ(got.complete, wanted.complete);
  EXPECT_EQ(got.evaluated, wanted.evaluated);
  EXPECT_EQ(got.least_gain, wanted.least_gain);
  ASSERT_EQ(got.views.size(), wanted.views.size());
  for (std::size_t i = 0; i < got.views.size(); ++i) {
    EXPECT_EQ(got.views[i].gain, wanted.views[i].gain);
    EXPECT_EQ(got.views[i].T_world_camera.matrix(), wanted.views[i].T_world_camera.matrix());
  }
}

TEST(GpuSurface, ViewsRankAndGainAsOnTheCpu) {
  int gained{0};
  GpuMap gpu = test::ordered_map({}, a_pair_of_threads(), 3);  // follows one map after the other
  for (std::uint32_t seed = 1; seed <= kScenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Choice choice{seed};
    for (const double doubtful_share : {0.0, 0.1}) {
      const std::uint64_t kernels = gpu.traffic().kernels;
      const RankedViews wanted = choice.best(nullptr, doubtful_share);
      expect_equal(choice.best(&gpu, doubtful_share), wanted);
      EXPECT_GT(gpu.traffic().kernels, kernels + 2) << "the device traced lines";
      gained += !wanted.views.empty() && wanted.views.front().gain > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(gained, kScenes);
}

TEST(GpuSurface, OnlyWhatChangedIsSent) {
  TsdfSnapshot map = random_table(1);
  GpuMap gpu = GpuMap::create_emulated(map.config, {}).value();
  ASSERT_TRUE(gpu.follow(map, {}).ok());
  const std::uint64_t first = gpu.traffic().bytes_sent;
  EXPECT_GT(first, std::uint64_t{80} * 2176);
  ASSERT_TRUE(gpu.follow(map, {}).ok());
  EXPECT_EQ(gpu.traffic().bytes_sent, first);
  test::set_brick(map, {0, 0, 0}, BrickRef::constant_free(3));
  test::set_brick(map, {1, 0, 0}, {});
  ASSERT_TRUE(gpu.follow(map, {}).ok());
  EXPECT_LT(gpu.traffic().bytes_sent - first, 100U);
  BrickRef dense = BrickRef::make_dense();
  dense.writable_dense().w[7] = 2;
  dense.writable_dense().v[7] = -5;
  dense.writable_dense().update_masks();
  test::set_brick(map, {0, 0, 0}, dense);
  const std::uint64_t second = gpu.traffic().bytes_sent;
  ASSERT_TRUE(gpu.follow(map, {}).ok());
  EXPECT_LT(gpu.traffic().bytes_sent - second, 2300U);
  expect_equal(expected_surface(map, {}, {}, &gpu).value(), expected_surface(map, {}, {}).value());
}

TEST(GpuSurface, AnOldTicketIsRefused) {
  const TsdfSnapshot map = random_table(2);
  GpuMap gpu = GpuMap::create_emulated(map.config, {}).value();
  const ExpectedSurface first = expected_surface(map, {}, {}, &gpu).value();
  const ExpectedSurface second = expected_surface(map, {}, {}, &gpu).value();
  const std::vector<LineOfSight> lines{{first.points.front().voxel, 0}};
  const std::vector<Vector3d> cameras_m{{0.0, 0.0, 0.8}};
  EXPECT_EQ(gpu.in_sight(first.volume->ticket(), lines, cameras_m, 0.1).error().code, Errc::invalid_argument);
  EXPECT_EQ(gpu.in_sight(0, lines, cameras_m, 0.1).error().code, Errc::invalid_argument);
  EXPECT_TRUE(gpu.in_sight(second.volume->ticket(), lines, cameras_m, 0.1).ok());
  EXPECT_TRUE(gpu.in_sight(second.volume->ticket(), {}, {}, 0.1).value().empty());
}

/// The CPU does the work that a device with too little memory cannot.
TEST(GpuSurface, TheCpuGoesOnWhereMemoryIsShort) {
  const Choice choice{4};
  const ExpectedSurface wanted = expected_surface(choice.map, {}, {}).value();
  const RankedViews views = choice.best(nullptr, 0.1);
  int failed{0};
  int done{0};
  for (std::size_t memory = 1000; memory < 20'000'000; memory *= 3) {
    GpuMap gpu = GpuMap::create_emulated(choice.map.config, {}, memory).value();
    const ExpectedSurface got = expected_surface(choice.map, {}, {}, &gpu).value();
    const std::optional<Error> problem = gpu.take_problem();
    EXPECT_TRUE(got.volume->ticket() != 0 || problem.has_value()) << "it is told why";
    EXPECT_TRUE(!problem.has_value() || problem->code == Errc::unavailable);
    EXPECT_FALSE(gpu.take_problem().has_value());
    expect_equal(got, wanted);
    expect_equal(choice.best(&gpu, 0.1), views);
    (got.volume->ticket() == 0 ? failed : done) += 1;
  }
  EXPECT_GT(failed, 2);
  EXPECT_GT(done, 0);
}

}  // namespace
}  // namespace saccade
