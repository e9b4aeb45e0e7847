// SPDX-License-Identifier: Apache-2.0
// Cost of choosing a view, all computing, in a whole run: the built-in arm, a table with eight objects, 5.8 mm, five
// views, noise on. A round is a run; its time is the mean choice. The number of threads must not change the views.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <memory>

#include "saccade/arm/urdf.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace {

using namespace saccade;

constexpr std::array<Phase, 7> kChoosing{Phase::obstacles,    Phase::candidates, Phase::segmentation, Phase::saliency,
                                         Phase::reachability, Phase::gain,       Phase::planning};

const GroundTruth& truth() {
  static const GroundTruth made = [] {
    const RayScene rays = RayScene::build(find_scene("tabletop-2").value()).value();
    return GroundTruth::build(rays, 0.004, Executor::with_threads(0)).value();
  }();
  return made;
}

RunRecord run(const char* strategy, int lookahead, std::size_t threads) {
  static const auto arm = std::make_shared<const ArmModel>(find_robot("comau_smart_six")->arm);
  SimulatedRunConfig config = SimulatedRunConfig{}.with(trial_planners().find(strategy).value());
  config.arm = arm;
  config.exploration.max_views = 5;
  config.exploration.lookahead = lookahead;
  return run_simulated(truth(), config, Executor::with_threads(threads)).value();
}

bool same_views(const RunRecord& a, const RunRecord& b) {
  return std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(),
                    [](const ViewRecord& one, const ViewRecord& other) {
                      return one.T_world_camera.matrix() == other.T_world_camera.matrix() &&
                             one.gain_predicted == other.gain_predicted;
                    });
}

/// Argument: threads.
void choose(benchmark::State& state, const char* strategy, int lookahead) {
  const RunRecord reference = run(strategy, lookahead, 1);
  std::array<double, kChoosing.size()> phases_ms{};
  double longest_ms = 0.0;
  double choices = 0.0;
  for (auto _ : state) {
    const RunRecord record = run(strategy, lookahead, static_cast<std::size_t>(state.range(0)));
    if (record.views.empty()) return state.SkipWithError("no view was taken");
    if (!same_views(record, reference)) return state.SkipWithError("the views are not those of one thread");
    double sum_ms = 0.0;
    for (const ViewRecord& view : record.views) {
      double choice_ms = 0.0;
      for (std::size_t i = 0; i < kChoosing.size(); ++i) {
        choice_ms += view.times.ms(kChoosing[i]);
        phases_ms[i] += view.times.ms(kChoosing[i]);
      }
      longest_ms = std::max(longest_ms, choice_ms);
      sum_ms += choice_ms;
    }
    choices += static_cast<double>(record.views.size());
    state.SetIterationTime(1e-3 * sum_ms / static_cast<double>(record.views.size()));
  }
  state.counters["longest_ms"] = longest_ms;
  for (std::size_t i = 0; i < kChoosing.size(); ++i) {
    state.counters[std::string{to_string(kChoosing[i])} + "_ms"] = phases_ms[i] / choices;
  }
}

BENCHMARK_CAPTURE(choose, surface, "surface", 1)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(choose, surface_two_ahead, "surface", 2)
    ->ArgName("threads")
    ->Arg(2)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(choose, attention, "attention", 1)
    ->ArgName("threads")
    ->Arg(2)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
