// SPDX-License-Identifier: Apache-2.0
// The Kinect v2 depth filter on frames of 512×424 of the sample table with noise, per frame: the thesis' method and
// ours, one thread and all.

#include <benchmark/benchmark.h>

#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"
#include "saccade/sensor/noise.hpp"

namespace {

using namespace saccade;

void filter_frame(benchmark::State& state, DepthFilterMethod method) {
  const PinholeCamera camera = camera_preset("kinect-v2").value();
  const RenderedFrame seen = render(sample_tabletop(), camera, sample_trajectory(1).front()).value();
  const DepthImage depth = with_noise(seen.depth, DepthNoise{});
  const DepthFilter filter = DepthFilter::create(camera, {.method = method}).value();
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  FilteredDepth filtered;
  for (auto _ : state) filtered = filter.filter(depth, executor).value();
  if (filtered.points < 100000 || filtered.shadow_points < 1000 || filtered.veil_points < 100) {
    state.SkipWithError("too few points, or too few removed");
  }
  state.counters["points"] = static_cast<double>(filtered.points);
  state.counters["removed"] = static_cast<double>(filtered.points - filtered.kept());
}
BENCHMARK_CAPTURE(filter_frame, thesis, DepthFilterMethod::thesis)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(0)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(filter_frame, surface, DepthFilterMethod::surface)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(0)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
