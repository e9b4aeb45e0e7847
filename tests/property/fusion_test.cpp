// SPDX-License-Identifier: Apache-2.0
// Bricks, masks and summaries against the dense reference, over random frames, poses, voxel sizes, forgets and threads.

#include <gtest/gtest.h>

#include "saccade/core/simd.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "support/dense_reference.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_run.hpp"

namespace saccade {
namespace {

using test::kHalfEdge;
using test::RandomRun;

constexpr int kFusionRuns{test::scaled_cases(40)};
constexpr int kTargetRuns{test::scaled_cases(10)};
constexpr int kFusionSteps{6};

/// Every voxel of the reference, and the masks and summaries above it. Counts what was compared.
struct Comparison {
  std::size_t voxels{0};
  std::size_t known{0};
  std::size_t occupied{0};
};

void compare(test::DenseReference& reference, const TsdfGrid& grid, Comparison& total) {
  std::size_t differing{0};
  reference.for_each([&](const Index3& index, const Voxel& expected, const Rgb8& color) {
    const Voxel actual = grid.voxel(index);
    const Index3 brick = parent(index);
    const Sector* sector = grid.find(parent(brick));
    const int b = child_index(brick);
    const BrickRef ref = sector != nullptr ? sector->bricks[static_cast<std::size_t>(b)] : BrickRef{};
    const int i = child_index(index);
    const VoxelState state = state_of(expected);
    const bool unknown = state == VoxelState::unknown;
    const bool occupied = state == VoxelState::occupied;
    bool same = actual == expected && ref.unknown_mask().test(i) == unknown && ref.occupied_mask().test(i) == occupied;
    same = same && (((ref.nonempty_word(i >> 6) >> (i & 63)) & 1U) != 0) == (unknown || occupied);
    if (sector != nullptr) {
      same = same && (!unknown || sector->has_unknown.test(b)) && (!occupied || sector->has_occupied.test(b));
    } else {
      same = same && unknown;
    }
    // Colours live with surfaces; a brick without one has dropped them.
    if (ref.kind() == BrickKind::dense) same = same && grid.color(index).value_or(Rgb8{}) == color;
    differing += same ? 0 : 1;
    ++total.voxels;
    total.known += unknown ? 0 : 1;
    total.occupied += occupied ? 1 : 0;
  });
  ASSERT_EQ(differing, 0U);
}

void expect_canonical(const TsdfGrid& grid, const TsdfConfig& config) {
  for (const Index3& key : grid.sorted_sectors()) {
    const Sector& sector = *grid.find(key);
    EXPECT_FALSE(sector.all_unknown());
    for (int i = 0; i < kSectorBricks; ++i) {
      const BrickRef& ref = sector.bricks[static_cast<std::size_t>(i)];
      BrickRef canonical = ref;
      canonical.canonicalize(config.free_weight);
      EXPECT_EQ(canonical.kind(), ref.kind());
      EXPECT_EQ(sector.has_unknown.test(i), ref.unknown_mask().any());
      EXPECT_EQ(sector.has_occupied.test(i), ref.occupied_mask().any());
    }
  }
}

TEST(FusionProperty, BricksEqualTheDenseReferenceToTheBit) {
  Comparison total;
  for (std::uint32_t seed = 1; seed <= kFusionRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomRun run = RandomRun::with_clearing(seed);
    auto map = TsdfMap::create(run.config());
    ASSERT_TRUE(map.ok()) << map.error().to_string();
    test::DenseReference reference{run.config(), kHalfEdge};
    const Executor executor = Executor::with_threads(1 + seed % 3);
    for (int step = 0; step < kFusionSteps; ++step) {
      const int action = run.integer(0, 9);
      if (action == 0) {
        const Region region = run.region();
        ASSERT_TRUE(map->free(region).ok());
        reference.free(region);
      } else if (action <= 2) {
        const Region region = run.region();
        ASSERT_TRUE(map->forget(region).ok());
        reference.forget(region);
      } else {
        const DepthImage depth = run.depth();
        const ColorImage color = run.color();
        const Pose T_world_camera = run.pose();
        const int repeats = run.integer(1, 7);  // weights must reach their limits too
        for (int i = 0; i < repeats; ++i) {
          const auto stats = map->integrate(run.camera(), depth, T_world_camera, executor, &color);
          ASSERT_TRUE(stats.ok()) << stats.error().to_string();
          reference.integrate(run.camera(), depth, T_world_camera, &color);
        }
      }
    }
    ASSERT_NO_FATAL_FAILURE(compare(reference, map->content().grid, total));
    expect_canonical(map->content().grid, run.config());
  }
  EXPECT_EQ(total.voxels, static_cast<std::size_t>(kFusionRuns) * 8 * kHalfEdge * kHalfEdge * kHalfEdge);
  EXPECT_GT(total.known, total.voxels / 20);
  EXPECT_GT(total.occupied, total.voxels / 2000);
  std::printf("compared %zu voxels over %d seeds: %zu known, %zu occupied\n", total.voxels, kFusionRuns, total.known,
              total.occupied);
}

TEST(FusionProperty, ThreadsAndBackendsNeverChangeABit) {
  std::size_t compared{0};
  for (std::uint32_t seed = 100; seed < 106; ++seed) {
    RandomRun run = RandomRun::with_clearing(seed);
    std::vector<std::pair<Pose, DepthImage>> frames;
    for (int i = 0; i < 4; ++i) frames.emplace_back(run.pose(), run.depth());
    std::optional<TsdfGrid> first;
    for (const Executor& executor : {Executor{}, Executor::with_threads(2, test::kParallelBackend),
                                     Executor::with_threads(7, test::kParallelBackend),
                                     Executor::with_threads(3, Executor::Backend::std_thread)}) {
      auto map = TsdfMap::create(run.config());
      ASSERT_TRUE(map.ok());
      for (const auto& [T_world_camera, depth] : frames) {
        ASSERT_TRUE(map->integrate(run.camera(), depth, T_world_camera, executor).ok());
      }
      if (!first) {
        first = map->content().grid;
        continue;
      }
      EXPECT_TRUE(*first == map->content().grid) << "seed " << seed << ", " << executor.backend_name();
      ++compared;
    }
    EXPECT_GT(first->usage().bricks(), 0U);
  }
  EXPECT_EQ(compared, 18U);
}

/// Puts the default instruction set back.
struct SimdTargetGuard {
  SimdTargetGuard() = default;
  SimdTargetGuard(const SimdTargetGuard&) = delete;
  SimdTargetGuard& operator=(const SimdTargetGuard&) = delete;
  ~SimdTargetGuard() { static_cast<void>(use_simd_target("")); }
};

TEST(FusionProperty, InstructionSetsNeverChangeABit) {
  const SimdTargetGuard guard;
  std::size_t compared{0};
  const std::vector<std::string> targets = simd_targets();
  for (std::uint32_t seed = 300; seed < 300 + kTargetRuns; ++seed) {
    std::optional<TsdfGrid> first;
    Comparison total;
    for (const std::string& target : targets) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", " + target);
      ASSERT_TRUE(use_simd_target(target).ok());
      ASSERT_EQ(simd_target(), target);
      RandomRun run = RandomRun::with_clearing(seed);
      auto map = TsdfMap::create(run.config());
      ASSERT_TRUE(map.ok());
      std::optional<test::DenseReference> reference;
      if (!first) reference.emplace(run.config(), kHalfEdge);
      for (int step = 0; step < kFusionSteps; ++step) {
        const DepthImage depth = run.depth();
        const ColorImage color = run.color();
        const Pose T_world_camera = run.pose();
        ASSERT_TRUE(map->integrate(run.camera(), depth, T_world_camera, {}, &color).ok());
        if (reference) reference->integrate(run.camera(), depth, T_world_camera, &color);
      }
      const TsdfGrid& grid = map->content().grid;
      if (reference) {
        ASSERT_NO_FATAL_FAILURE(compare(*reference, grid, total));
        EXPECT_GT(total.known, 0U);
        first = grid;
      }
      EXPECT_TRUE(*first == grid);
      ++compared;
    }
  }
  EXPECT_EQ(compared, targets.size() * kTargetRuns);
  std::printf("compared %zu maps on %zu instruction sets\n", compared, targets.size());
}

TEST(FusionProperty, SnapshotsStayAsTheyWere) {
  for (std::uint32_t seed = 200; seed < 210; ++seed) {
    RandomRun run = RandomRun::with_clearing(seed);
    auto map = TsdfMap::create(run.config());
    auto untouched = TsdfMap::create(run.config());
    ASSERT_TRUE(map.ok() && untouched.ok());
    const Executor executor = Executor::with_threads(2);
    const DepthImage depth = run.depth();
    const Pose T_world_camera = run.pose();
    ASSERT_TRUE(map->integrate(run.camera(), depth, T_world_camera, executor).ok());
    ASSERT_TRUE(untouched->integrate(run.camera(), depth, T_world_camera, executor).ok());
    const TsdfSnapshot snapshot = map->snapshot();
    ASSERT_TRUE(map->integrate(run.camera(), run.depth(), run.pose(), executor).ok());
    ASSERT_TRUE(map->forget(run.region()).ok());
    ASSERT_TRUE(map->free(run.region()).ok());
    EXPECT_TRUE(snapshot.grid == untouched->content().grid) << "seed " << seed;
    EXPECT_FALSE(snapshot.grid == map->content().grid) << "seed " << seed;
  }
}

}  // namespace
}  // namespace saccade
