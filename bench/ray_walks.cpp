// SPDX-License-Identifier: Apache-2.0
// All rays of view poses to their first voxel that is not empty, each by itself: ours, and the two ways that the thesis
// compares with in Table 2.9, PCL's octree (where it is installed) and a fixed step; beside them evaluate_views, which
// gives the same gains. The task is that of the thesis (bench/thesis/update_task.hpp).
#include <benchmark/benchmark.h>

#include "peer_comparison.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/views/view_gain.hpp"
#include "thesis/ray_search.hpp"
#include "thesis/update_task.hpp"

namespace {

using namespace saccade;
using thesis::RaySearch;

constexpr std::size_t kPoses{16};         ///< sample of the 960 poses, small enough to share hardly any ray
constexpr std::size_t kComparedPoses{4};  ///< all of their rays
constexpr double kFixedStep_m{0.003};     ///< thesis §2.4.4

struct Scene {
  thesis::UpdateTask task;
  thesis::StopVolume volume;
};
const Scene& scene() {
  static const Scene made = [] {
    const Executor executor = Executor::with_threads(0);
    thesis::UpdateTask task = thesis::make_update_task(1, executor).value();
    thesis::StopVolume volume = thesis::StopVolume::fill(task.map, task.region, task.volume_bricks, executor);
    return Scene{std::move(task), std::move(volume)};
  }();
  return made;
}

GainConfig gain_config() {
  GainConfig config;
  config.sensor = scene().task.sensor;
  return config;
}

/// Compares first voxels with those of the exact walk, then times; ours, preparation included, right after each round.
/// `other_rays` is the share of rays that may end elsewhere, `other_gains` that of what scores.
void run(benchmark::State& state, const RaySearch& search, double other_rays, double other_gains) {
  const thesis::UpdateTask& task = scene().task;
  const thesis::StopVolume& volume = scene().volume;
  const double voxel_size_m = task.map.config.voxel_size_m;
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  const auto exact = thesis::exact_search(task.map, volume);
  const auto compared = thesis::compare_rays(search, *exact, volume, task.some_poses(kComparedPoses), task.sensor,
                                             voxel_size_m, executor);
  if (!compared || compared->rays == 0 || compared->other_voxel_share() > other_rays) {
    return state.SkipWithError("rays end in other voxels than those of the exact walk");
  }
  const std::vector<Pose> poses = task.some_poses(kPoses);
  double ours_ms{0.0};
  double search_ms{0.0};
  for (auto _ : state) {
    Stopwatch clock;
    const auto gains = thesis::gains_of(search, volume, poses, task.sensor, voxel_size_m, executor);
    const double ms = clock.lap_ms();
    const auto ours = evaluate_views(task.map, task.region, poses, gain_config(), executor);
    ours_ms += clock.lap_ms();
    search_ms += ms;
    state.SetIterationTime(1e-3 * ms);
    if (bench::gain_difference(*gains, ours->gains) > other_gains) {
      return state.SkipWithError("the gains differ from ours");
    }
  }
  state.counters["poses"] = static_cast<double>(poses.size());
  state.counters["differing_rays"] = compared->other_voxel_share();
  state.counters["ours_ms"] = ours_ms / static_cast<double>(state.iterations());
  state.counters["speedup"] = search_ms / ours_ms;
}

void exact_walk(benchmark::State& state) {
  run(state, *thesis::exact_search(scene().task.map, scene().volume), 0.0, 0.0);
}
/// Half a voxel: a fifth of the rays passes over a corner, and most of those end in the voxel behind it.
void fixed_step(benchmark::State& state) {
  const double step_vox = kFixedStep_m / scene().task.map.config.voxel_size_m;
  run(state, *thesis::fixed_step_search(scene().volume, step_vox), 0.4, 0.02);
}
void arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("threads")->Arg(2)->Unit(benchmark::kMillisecond)->UseManualTime();
}
BENCHMARK(exact_walk)->Apply(arguments);
BENCHMARK(fixed_step)->Apply(arguments);

#ifdef SACCADE_WITH_PCL
/// Without its preparation, which has a row of its own.
void pcl_octree(benchmark::State& state) {
  const auto search = thesis::octree_search(scene().volume);
  run(state, *search.value(), 1e-4, 1e-4);
}
void pcl_octree_prepare(benchmark::State& state) {
  for (auto _ : state) {
    if (!thesis::octree_search(scene().volume)) return state.SkipWithError("no octree");
  }
}
BENCHMARK(pcl_octree)->Apply(arguments);
BENCHMARK(pcl_octree_prepare)->Unit(benchmark::kMillisecond);
#endif

}  // namespace

BENCHMARK_MAIN();
