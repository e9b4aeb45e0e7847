// SPDX-License-Identifier: Apache-2.0
// Segments of labelled clouds (mOSD) beside PCL's, and of a map of 490,000 surface voxels, without and with their
// saliency: from scratch, and after views of about 5 % of it were fused. What the segments are worth: program
// segmentation.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "saccade/attention/saliency.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/segment/live_segments.hpp"
#include "segmentation_peer.hpp"
#include "support/labelled_clouds.hpp"
#include "support/places.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;

Executor threads_of(const benchmark::State& state, std::size_t argument) {
  return Executor::with_threads(static_cast<std::size_t>(state.range(argument)));
}

const std::vector<test::LabelledCloud>& clouds() {
  static const std::vector<test::LabelledCloud> read = test::labelled_clouds(test::shared_data());
  return read;
}

SupervoxelConfig single_camera() {
  SupervoxelConfig config;
  config.voxels.single_camera = true;
  return config;
}

/// Twelve clouds an iteration.
void segment_clouds(benchmark::State& state) {
  const Executor executor = threads_of(state, 0);
  std::size_t segments{0};
  for (auto _ : state) {
    segments = 0;
    for (const test::LabelledCloud& cloud : clouds()) {
      const SupervoxelResult supervoxels = find_supervoxels(cloud.cloud, single_camera(), executor).value();
      segments += segment_by_convexity(supervoxels).value().segments;
    }
  }
  if (segments < 2 * clouds().size()) return state.SkipWithError("too few segments");
  state.counters["segments"] = static_cast<double>(segments);
}

#ifdef SACCADE_WITH_PCL
void segment_clouds_with_pcl(benchmark::State& state) {
  std::size_t segments{0};
  for (auto _ : state) {
    segments = 0;
    for (const test::LabelledCloud& cloud : clouds()) {
      segments += bench::segment_with_pcl(cloud.cloud, single_camera(), {}).segments;
    }
  }
  if (segments < 2 * clouds().size()) return state.SkipWithError("too few segments");
  state.counters["segments"] = static_cast<double>(segments);
}
#endif

const std::vector<TsdfSnapshot>& maps() {
  static const std::vector<TsdfSnapshot> made = bench::fine_maps_after_views(1);
  return made;
}

MapSegmentsConfig wanted_of(const benchmark::State& state) {
  MapSegmentsConfig config;
  config.voxel_size_m = 1e-6 * static_cast<double>(state.range(0));
  return config;
}

void segment_whole_map(benchmark::State& state) {
  const Executor executor = threads_of(state, 1);
  const TsdfSnapshot& map = maps().front();
  MapSegments found;
  for (auto _ : state) found = segment_map(map, executor, wanted_of(state)).value();
  if (found.segments.segments < 4 || found.points.positions_m.size() < 480000) {
    return state.SkipWithError("too few segments or points");
  }
  state.counters["points"] = static_cast<double>(found.points.positions_m.size());
  state.counters["voxels"] = static_cast<double>(found.supervoxels.voxels);
}

/// Without the list of all points with their labels, which segments() makes.
void follow_views(benchmark::State& state) {
  const Executor executor = threads_of(state, 1);
  LiveSegments live = LiveSegments::create(wanted_of(state)).value();
  static_cast<void>(live.update(maps().front(), executor));
  const auto voxels = static_cast<double>(live.segments(executor).supervoxels.voxels);
  static_cast<void>(live.update(maps()[1], executor));
  if (live.segments(executor).segments.labels !=
      segment_map(maps()[1], executor, wanted_of(state)).value().segments.labels) {
    return state.SkipWithError("labels differ from those from scratch");
  }
  std::size_t next{2};
  double changed{0.0};
  for (auto _ : state) {
    const Stopwatch stopwatch;
    changed += static_cast<double>(live.update(maps()[next], executor).voxels_changed);
    state.SetIterationTime(1e-3 * stopwatch.elapsed_ms());
    if (++next < maps().size()) continue;
    static_cast<void>(live.update(maps().front(), executor));  // untimed
    next = 1;
  }
  state.counters["changed_share"] = changed / voxels / static_cast<double>(state.iterations());
}

/// Saliency (eq. 3.12) of the segments of a map, by its voxels.
double most_salient(const LiveSegments& live, const Executor& executor) {
  const VoxelSegments voxels = live.voxels(executor);
  const SegmentedPoints points = SegmentedPoints::create(voxels.positions_m, voxels.labels, voxels.segments).value();
  const MeasureConfig config;
  const std::vector<SegmentMeasures> measures = measure_segments(points, config, executor).value();
  const std::vector<Saliency> saliencies = objectness()({points, measures, config});
  return std::max_element(saliencies.begin(), saliencies.end(),
                          [](const Saliency& a, const Saliency& b) { return a.value < b.value; })
      ->value;
}

/// Segments and saliency, from scratch.
void attend_to_whole_map(benchmark::State& state) {
  const Executor executor = threads_of(state, 1);
  for (auto _ : state) {
    LiveSegments live = LiveSegments::create(wanted_of(state)).value();
    static_cast<void>(live.update(maps().front(), executor));
    if (!(most_salient(live, executor) > 0.0)) return state.SkipWithError("nothing is salient");
  }
}

/// Segments and saliency, after a view.
void attend_after_views(benchmark::State& state) {
  const Executor executor = threads_of(state, 1);
  LiveSegments live = LiveSegments::create(wanted_of(state)).value();
  static_cast<void>(live.update(maps().front(), executor));
  std::size_t next{1};
  for (auto _ : state) {
    const Stopwatch stopwatch;
    static_cast<void>(live.update(maps()[next], executor));
    const double most = most_salient(live, executor);
    state.SetIterationTime(1e-3 * stopwatch.elapsed_ms());
    if (!(most > 0.0)) return state.SkipWithError("nothing is salient");
    if (++next < maps().size()) continue;
    static_cast<void>(live.update(maps().front(), executor));  // untimed
    next = 1;
  }
}

const bool kRegistered = [] {
  if (!clouds().empty()) {
    benchmark::RegisterBenchmark("clouds", segment_clouds)
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
#ifdef SACCADE_WITH_PCL
    benchmark::RegisterBenchmark("pcl_clouds", segment_clouds_with_pcl)->UseRealTime()->Unit(benchmark::kMillisecond);
#endif
  }
  for (const int voxel_um : {3600, 7500}) {
    for (const int threads : {1, 2}) {
      benchmark::RegisterBenchmark("map", segment_whole_map)
          ->ArgNames({"voxel_um", "threads"})
          ->Args({voxel_um, threads})
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
      benchmark::RegisterBenchmark("map_after_view", follow_views)
          ->ArgNames({"voxel_um", "threads"})
          ->Args({voxel_um, threads})
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
      benchmark::RegisterBenchmark("attention", attend_to_whole_map)
          ->ArgNames({"voxel_um", "threads"})
          ->Args({voxel_um, threads})
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
      benchmark::RegisterBenchmark("attention_after_view", attend_after_views)
          ->ArgNames({"voxel_um", "threads"})
          ->Args({voxel_um, threads})
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
  return true;
}();

}  // namespace

BENCHMARK_MAIN();
