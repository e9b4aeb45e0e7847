// SPDX-License-Identifier: Apache-2.0
// Both dip detectors on one made-up task, one thread: a whole trajectory, the stream per trajectory, and the smoothing
// with bins beside that with all samples.

#include <benchmark/benchmark.h>

#include "saccade/attention/dip_detector.hpp"
#include "support/made_hands.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kActions{2};

/// To a place, to another one, and away, in as long as users take; as many samples as asked for.
HandTrajectory task(std::int64_t samples, double noise_m) {
  const std::vector<Eigen::Vector3d> places{{0.8, 0.0, 0.3}, {0.3, 0.2, 0.0}, {-0.3, 0.1, 0.1}, {0.5, -0.8, 0.4}};
  HandTrajectory hand = test::hand_through(places, {0.5, 0.1, 1.7 / static_cast<double>(samples)});
  std::mt19937_64 random{3};
  if (noise_m > 0.0) test::add_noise(hand, noise_m, random);
  return hand;
}

void whole_trajectory(benchmark::State& state) {
  const HandTrajectory hand = task(state.range(0), 0.001 * static_cast<double>(state.range(1)));
  for (auto _ : state) {
    const auto result = detect_dips(hand);
    if (!result || result->actions.size() != kActions) state.SkipWithError("not two actions");
  }
}
BENCHMARK(whole_trajectory)
    ->ArgNames({"samples", "noise_mm"})
    ->Args({170, 0})
    ->Args({170, 10})
    ->Args({170, 50})
    ->Args({680, 0})
    ->Args({680, 50})
    ->Unit(benchmark::kMicrosecond);

void stream(benchmark::State& state) {
  const HandTrajectory hand = task(state.range(0), 0.0);
  for (auto _ : state) {
    DipStream stream = DipStream::create().value();
    std::size_t actions{0};
    for (const HandSample& sample : hand) actions += stream.put(sample).value().size();
    if (actions != kActions) state.SkipWithError("not two actions");
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(hand.size()));
}
BENCHMARK(stream)->ArgName("samples")->Arg(170)->Arg(680)->Unit(benchmark::kMicrosecond);

constexpr double kKernel_s{0.06};

void smoothing_in_bins(benchmark::State& state) {
  const std::vector<TimedPoint> samples = fresh_samples(task(state.range(0), 0.01));
  for (auto _ : state) benchmark::DoNotOptimize(smooth(samples, kKernel_s, 0.01));
}
BENCHMARK(smoothing_in_bins)->ArgName("samples")->Arg(170)->Arg(680)->Unit(benchmark::kMicrosecond);

void smoothing_over_all_samples(benchmark::State& state) {
  const std::vector<TimedPoint> samples = fresh_samples(task(state.range(0), 0.01));
  const std::vector<SmoothedPoint> binned = smooth(samples, kKernel_s, 0.01);
  for (auto _ : state) {
    for (const SmoothedPoint& point : binned) {
      const SmoothedPoint direct = test::smoothed_at(samples, point.time_s, kKernel_s, 0.01);
      if ((direct.position_m - point.position_m).norm() > 0.01) state.SkipWithError("bins are wrong");
    }
  }
}
BENCHMARK(smoothing_over_all_samples)->ArgName("samples")->Arg(170)->Arg(680)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
