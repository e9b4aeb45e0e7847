// SPDX-License-Identifier: Apache-2.0
// Gain of the 960 view poses of thesis §2.2.3 around a forgotten sphere of 0.2 m on a table: 640×480 rays, 5.8 mm; also
// after the best views were fused. The peer is Embree, where it is installed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <optional>

#include "embree_views.hpp"
#include "peer_comparison.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/internal/best_views.hpp"
#include "saccade/views/view_gain.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;
using bench::all_poses;
using bench::every_nth_pose;
using bench::kMostViews;
using bench::kRegion;

/// The first argument of a benchmark: how many best views were fused.
const TsdfSnapshot& map_of(const benchmark::State& state) {
  return bench::map_after(static_cast<std::size_t>(state.range(0)));
}

/// Arguments of a benchmark: best views fused, threads.
void run(benchmark::State& state, const GainConfig& config, std::size_t every) {
  const std::vector<Pose> poses = every_nth_pose(every);
  const TsdfSnapshot& map = map_of(state);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  GainConfig few_savings = config;
  few_savings.savings = GainSavings::none();
  few_savings.savings.region_rays = few_savings.savings.region_exit = few_savings.savings.empty_bricks = true;
  const std::span<const Pose> some{poses.data() + poses.size() / 2, 2};
  const auto expected = evaluate_views(map, kRegion, some, few_savings, executor);
  double prepare_ms{0.0};
  double evaluate_ms{0.0};
  double cast{0.0};
  for (auto _ : state) {
    const auto result = evaluate_views(map, kRegion, poses, config, executor);
    if (!result || !expected ||
        !std::equal(expected->gains.begin(), expected->gains.end(),
                    result->gains.begin() + static_cast<std::ptrdiff_t>(poses.size() / 2)) ||
        expected->gains[0] == 0) {
      state.SkipWithError("the gains differ from those of rays walked one by one");
      return;
    }
    prepare_ms = result->prepare_ms;
    evaluate_ms = result->evaluate_ms;
    cast = static_cast<double>(result->rays_cast);
  }
  state.counters["poses"] = static_cast<double>(poses.size());
  state.counters["prepare_ms"] = prepare_ms;
  state.counters["evaluate_ms"] = evaluate_ms;
  state.counters["rays_cast"] = cast;
}

void all_savings(benchmark::State& state) { run(state, {}, 1); }
/// Only the best pose, which is that of all gains.
void best_only(benchmark::State& state) {
  const TsdfSnapshot& map = map_of(state);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  const auto all = evaluate_views(map, kRegion, all_poses(), {}, executor);
  const OrderedView expected = order_views(all->gains, all_poses()).front();
  double evaluated{0.0};
  for (auto _ : state) {
    const auto best = best_views(map, kRegion, all_poses(), 1, {}, executor);
    if (!best || best->views.front().index != expected.index || best->views.front().gain != expected.gain) {
      return state.SkipWithError("the best view differs from that of all gains");
    }
    evaluated = static_cast<double>(best->poses_evaluated);
  }
  state.counters["poses_evaluated"] = evaluated;
}
void distinct_voxels(benchmark::State& state) {
  GainConfig config;
  config.count = GainCount::distinct_voxels;
  run(state, config, 1);
}
void without_shared_lattice(benchmark::State& state) {
  GainConfig config;
  config.savings.shared_lattice = false;
  run(state, config, 1);
}
void without_tiles(benchmark::State& state) {
  GainConfig config;
  config.savings.tiles = false;
  run(state, config, 1);
}
/// Baseline: every ray of the region walked by itself, on every eighth pose.
void rays_one_by_one(benchmark::State& state) {
  GainConfig config;
  config.savings.tiles = config.savings.shared_lattice = false;
  run(state, config, 8);
}

#ifdef SACCADE_WITH_EMBREE
using bench::Cost;
using bench::CostClock;

constexpr double kMostDifference{1e-3};

template <class Work>
Cost cost_of(const Work& work) {
  const CostClock clock;
  work();
  return clock.elapsed();
}

/// Embree's evaluation on two threads, without its preparation; ours with preparation, right after it. `speedup` and
/// `cpu_speedup` are how many times longer Embree took. Arguments: best views fused; every how many poses.
void embree(benchmark::State& state) {
  const std::vector<Pose> poses = every_nth_pose(static_cast<std::size_t>(state.range(1)));
  const TsdfSnapshot& map = map_of(state);
  const GainConfig config;
  const Executor executor = Executor::with_threads(2);
  std::optional<bench::EmbreeViews> peer;
  const Cost prepared =
      cost_of([&] { peer.emplace(bench::EmbreeViews::prepare(map, kRegion, poses, executor).value()); });
  Cost peers;
  Cost ours;
  double differing{0.0};
  for (auto _ : state) {
    std::vector<std::uint64_t> gains;
    std::vector<std::uint64_t> expected;
    const Cost cost = cost_of([&] { gains = peer->gains(poses, config.sensor, executor); });
    ours = ours + cost_of([&] { expected = evaluate_views(map, kRegion, poses, config, executor).value().gains; });
    state.SetIterationTime(cost.wall_s);
    peers = peers + cost;
    differing = bench::gain_difference(gains, expected);
    if (differing > kMostDifference) return state.SkipWithError("the gains differ from ours");
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["poses"] = static_cast<double>(poses.size());
  state.counters["faces"] = static_cast<double>(peer->faces());
  state.counters["prepare_ms"] = 1e3 * prepared.wall_s;
  state.counters["differing"] = differing;
  state.counters["cpu_ms"] = 1e3 * peers.cpu_s / rounds;
  state.counters["ours_ms"] = 1e3 * ours.wall_s / rounds;
  state.counters["ours_cpu_ms"] = 1e3 * ours.cpu_s / rounds;
  state.counters["speedup"] = peers.wall_s / ours.wall_s;
  state.counters["cpu_speedup"] = peers.cpu_s / ours.cpu_s;
}

// 17 has no factor in common with the numbers of rolls, longitudes and latitudes.
BENCHMARK(embree)
    ->ArgNames({"views", "every"})
    ->ArgsProduct({{0, 1, kMostViews}, {17, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
#endif

/// One row per choice of views fused and threads.
void arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"views", "threads"})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK(all_savings)->Apply(arguments)->Args({0, 1})->Args({0, 2})->Args({1, 2})->Args({kMostViews, 2});
BENCHMARK(best_only)->Apply(arguments)->Args({0, 2})->Args({1, 2})->Args({kMostViews, 2});
BENCHMARK(distinct_voxels)->Apply(arguments)->Args({0, 1})->Args({0, 2});
BENCHMARK(without_shared_lattice)->Apply(arguments)->Args({0, 2});
BENCHMARK(without_tiles)->Apply(arguments)->Args({0, 2});
BENCHMARK(rays_one_by_one)->Apply(arguments)->Args({0, 1});

}  // namespace

BENCHMARK_MAIN();
