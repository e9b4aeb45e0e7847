// SPDX-License-Identifier: Apache-2.0
// The guided filter on a frame of 640×480 of the sample table: ours, and a sum over the whole window at every pixel.
#include "saccade/surfel/guided_filter.hpp"

#include <benchmark/benchmark.h>

#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/noise.hpp"
#include "support/naive_guided_filter.hpp"

namespace {

using namespace saccade;

/// Depth with noise, guided by colour and depth without; one return in twenty is lost.
const test::GuidedImages& images() {
  static const test::GuidedImages made = [] {
    const PinholeCamera camera = camera_preset("kinect-v1").value();
    const RenderedFrame seen = render(sample_tabletop(), camera, sample_trajectory(1).front()).value();
    const DepthImage noisy = with_noise(seen.depth, DepthNoise{.dropout = 0.05});
    test::GuidedImages frame{camera.width, camera.height, noisy.pixels(), {}, {}};
    for (std::size_t i = 0; i < seen.depth.size(); ++i) {
      const Rgb8& color = seen.color.pixels()[i];
      const float depth_m = seen.depth.pixels()[i];
      frame.guidance.emplace_back(color[0] / 255.0F, color[1] / 255.0F, color[2] / 255.0F, depth_m);
      frame.used.push_back(depth_m > 0.0F && noisy.pixels()[i] > 0.0F ? 1 : 0);
    }
    return frame;
  }();
  return made;
}

/// How far from the naive result, in units of the last place.
double worst_ulps(const test::GuidedImages& frame, const std::vector<double>& exact_m,
                  const std::vector<float>& enhanced_m) {
  double worst{0.0};
  for (std::size_t i = 0; i < exact_m.size(); ++i) {
    if (frame.used[i] != 0) worst = std::max(worst, test::ulps(enhanced_m[i], exact_m[i]));
  }
  return worst;
}

void ours(benchmark::State& state) {
  const test::GuidedImages& frame = images();
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  GuidedFilter filter;
  std::vector<float> enhanced_m(frame.depth_m.size());
  const auto apply = [&] {
    filter.apply(frame.width, frame.height, frame.depth_m, frame.guidance, frame.used, executor, enhanced_m);
  };
  apply();
  const double worst = worst_ulps(frame, test::naive_guided_filter(filter.config(), frame, executor), enhanced_m);
  const auto used = std::count(frame.used.begin(), frame.used.end(), 1);
  if (!(worst <= 1.0) || used < 150'000) state.SkipWithError("another image than the naive one");
  for (auto _ : state) {
    apply();
    benchmark::ClobberMemory();
  }
  state.counters["used"] = static_cast<double>(used);
  state.counters["ulps"] = worst;
}

void naive(benchmark::State& state) {
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(test::naive_guided_filter(GuidedFilterConfig{}, images(), executor));
}

BENCHMARK(ours)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(naive)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
