// SPDX-License-Identifier: Apache-2.0
// The detectors of hand actions on the recorded hands of the thesis' data set, or on made-up tasks without it:
// median time per trajectory, one thread. The baseline is EM without vectors of samples, straight from the formulas.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "support/hand_detectors.hpp"
#include "support/places.hpp"
#include "support/recorded_hands.hpp"
#include "support/reference_em.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kMadeUpTasks{100};

const std::vector<LabelledTrajectory>& hands() {
  static const std::vector<LabelledTrajectory> read = [] {
    std::vector<LabelledTrajectory> all = test::recorded_hands(test::shared_data()).all();
    if (!all.empty()) return all;
    for (std::uint64_t seed = 0; seed < kMadeUpTasks; ++seed) {
      SyntheticTask task = synthetic_task(seed, {.actions = 1 + static_cast<int>(seed % 2)});
      all.push_back({"made up", std::move(task.trajectory), std::move(task.actions_m)});
    }
    return all;
  }();
  return read;
}

/// All trajectories per iteration; `ms_median` and `ms_longest` are per trajectory.
void run(benchmark::State& state, const HandActionDetector& detector) {
  DetectorEvaluation sum;
  for (auto _ : state) {
    const auto result = evaluate_detector(detector, hands());
    if (!result) return state.SkipWithError(result.error().to_string().c_str());
    sum += *result;
  }
  if (sum.counts.recall().value_or(0.0) < 0.8) return state.SkipWithError("too few actions were found");
  state.counters["trajectories"] = static_cast<double>(hands().size());
  state.counters["ms_median"] = *sum.median_ms();
  state.counters["ms_longest"] = *std::max_element(sum.ms.begin(), sum.ms.end());
}

void gmm_as(benchmark::State& state) { run(state, test::by_gmm); }
BENCHMARK(gmm_as)->Unit(benchmark::kMillisecond);

void zvc(benchmark::State& state) { run(state, test::by_zvc); }
BENCHMARK(zvc)->Unit(benchmark::kMillisecond);

void ours(benchmark::State& state) { run(state, test::by_dips); }
BENCHMARK(ours)->Unit(benchmark::kMillisecond);

constexpr int kGaussians{8};
constexpr int kSteps{10};

/// Ten steps of EM with eight Gaussians on a task of 8 s: vectors of samples, and the plain formulas.
std::vector<Eigen::Vector4d> em_samples() {
  return test::augmented_samples(synthetic_task(1, {.actions = 4}).trajectory);
}

void em_steps(benchmark::State& state) {
  const auto samples = em_samples();
  const GmmEm em = GmmEm::create(samples, {.relative_stop = 0.0, .max_iterations = kSteps}).value();
  for (auto _ : state) benchmark::DoNotOptimize(em.fit(kGaussians));
  state.counters["samples"] = static_cast<double>(samples.size());
}
BENCHMARK(em_steps)->Unit(benchmark::kMicrosecond);

void em_steps_plain(benchmark::State& state) {
  const auto samples = em_samples();
  const GmmEmConfig config{.relative_stop = 0.0, .max_iterations = 1};
  const GmmFit start = GmmEm::create(samples, config).value().fit(kGaussians);
  const double expected =
      GmmEm::create(samples, {.relative_stop = 0.0, .max_iterations = kSteps}).value().fit(kGaussians).log_likelihood();
  for (auto _ : state) {
    std::vector<Gaussian4> mixture = start.gaussians;
    for (int i = 1; i < kSteps; ++i) mixture = test::em_step(samples, mixture, config.covariance_floor);
    if (std::abs(test::log_likelihood(samples, mixture) - expected) > 1e-5) {
      return state.SkipWithError("the fast EM differs from the plain one");
    }
  }
}
BENCHMARK(em_steps_plain)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
