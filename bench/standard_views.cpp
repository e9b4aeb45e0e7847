// SPDX-License-Identifier: Apache-2.0
// The thesis' standard method (§3.2.2): the best view of the whole workspace among all views of its contours, with the
// rays of a Kinect v2, on a table with eight objects after its scan and some views more. Contour voxels are hardly
// grouped, so that there are as many candidates as in Fig. 3.16 (91,960).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>

#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/views/contours.hpp"
#include "saccade/views/internal/best_views.hpp"

namespace {

using namespace saccade;

constexpr int kMostViews{4};       // fused after the scan
constexpr double kGroup_m{0.008};  // D_th
constexpr double kLowest_m{0.1};   // no camera below the table, whose inside the workspace cuts open
constexpr std::size_t kEvery{41};  // step between the poses whose gains are all computed
constexpr unsigned kOneInReachable{10};

struct Case {
  TsdfSnapshot map;
  std::vector<Pose> poses;
  Region region;
};

GainConfig gain_config() {
  GainConfig config;
  config.sensor = {512, 424, 365.5, 365.5, 255.5, 211.5, 0.5, 4.5};  // Kinect v2
  return config;
}

std::vector<Pose> every_nth(const std::vector<Pose>& poses, std::size_t n) {
  std::vector<Pose> some;
  for (std::size_t i = 0; i < poses.size(); i += n) some.push_back(poses[i]);
  return some;
}

/// An arm may reach any of the poses.
std::vector<Pose> reachable(const std::vector<Pose>& poses) {
  std::mt19937 random{1};
  std::vector<Pose> some;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(some),
               [&](const Pose&) { return random() % kOneInReachable == 0; });
  return some;
}

Result<std::vector<Pose>> candidates(const TsdfSnapshot& map, const Executor& executor) {
  ContourConfig config;
  config.group_distance_m = kGroup_m;
  SACCADE_TRY(const std::vector<ContourVoxel> voxels, contour_voxels(map, config, executor));
  SACCADE_TRY(std::vector<Pose> poses, contour_views(contour_points(voxels, map.config.voxel_size_m, config)));
  std::erase_if(poses, [](const Pose& T_world_camera) { return T_world_camera.translation().z() < kLowest_m; });
  return poses;
}

/// Returns maps of the table after its scan, and after 1 … kMostViews of the best views among every kEvery-th
/// candidate.
Result<std::vector<Case>> make_cases() {
  const Executor executor = Executor::with_threads(0);
  SACCADE_TRY(Scene scene, find_scene("tabletop-2"));
  const SimulatedRunConfig config;
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  TsdfConfig map_config = config.map();
  map_config.workspace = rays.scene().workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(map_config));
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(rays, config));
  SACCADE_TRY(FreeRobot robot, flying_camera(rays));
  FunctionCamera sensor{config.camera,
                        [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose, executor); }};
  Explorer explorer{{map, sensor, robot, executor}, config.exploration};
  SACCADE_TRY(const ScanRecord scanned, explorer.scan(rays.scene().scan));
  SACCADE_EXPECTS(scanned.complete);
  std::vector<Case> cases;
  for (int view = 0; view <= kMostViews; ++view) {
    SACCADE_TRY(std::vector<Pose> poses, candidates(map.content(), executor));
    cases.push_back({map.snapshot(), std::move(poses), *map_config.workspace});
    const Case& last = cases.back();
    SACCADE_TRY(const BestViews best,
                best_views(last.map, last.region, every_nth(last.poses, kEvery), 1, gain_config(), executor));
    const Pose& pose = best.views.front().T_world_camera;
    SACCADE_CHECK(map.integrate(config.camera, camera.capture(pose, executor).depth, pose, executor));
  }
  return cases;
}

const Case& case_of(const benchmark::State& state) {
  static const std::vector<Case> made = make_cases().value();
  return made[static_cast<std::size_t>(state.range(0))];
}

/// The first of all gains of some poses is what best_views finds among them.
bool finds_the_best(const Case& test, const std::vector<Pose>& poses, const Executor& executor) {
  const auto all = evaluate_views(test.map, test.region, poses, gain_config(), executor);
  const auto best = best_views(test.map, test.region, poses, 1, gain_config(), executor);
  if (!all || !best) return false;
  const OrderedView expected = order_views(all->gains, poses).front();
  return best->views.front().index == expected.index && best->views.front().gain == expected.gain;
}

/// The gain of the best view, ray by ray without any saving.
bool gains_what_it_says(const Case& test, const OrderedView& view, const Executor& executor) {
  GainConfig config = gain_config();
  config.savings = GainSavings::none();
  const auto gain = evaluate_views(test.map, test.region, std::span{&view.T_world_camera, 1}, config, executor);
  return gain.ok() && gain->gains.front() == view.gain;
}

void run(benchmark::State& state, const std::vector<Pose>& poses) {
  const Case& test = case_of(state);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  if (!finds_the_best(test, every_nth(poses, kEvery), executor)) {
    return state.SkipWithError("the best view differs from that of all gains");
  }
  BestViews best;
  for (auto _ : state) {
    auto found = best_views(test.map, test.region, poses, 1, gain_config(), executor);
    if (!found) return state.SkipWithError(found.error().to_string().c_str());
    best = std::move(*found);
  }
  if (!gains_what_it_says(test, best.views.front(), executor)) {
    return state.SkipWithError("the best view's gain differs from that of its rays one by one");
  }
  state.counters["poses"] = static_cast<double>(poses.size());
  state.counters["poses_evaluated"] = static_cast<double>(best.poses_evaluated);
  state.counters["rays_cast"] = static_cast<double>(best.rays_cast);
  state.counters["gain"] = static_cast<double>(best.views.front().gain);
}

/// Arguments: views fused after the scan, threads.
void best_of_all(benchmark::State& state) { run(state, case_of(state).poses); }
void best_of_reachable(benchmark::State& state) { run(state, reachable(case_of(state).poses)); }

/// Baseline: all gains, of some of the poses.
void all_gains_of_every_41st(benchmark::State& state) {
  const Case& test = case_of(state);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  const std::vector<Pose> poses = every_nth(test.poses, kEvery);
  for (auto _ : state) {
    const auto result = evaluate_views(test.map, test.region, poses, gain_config(), executor);
    if (!result) return state.SkipWithError(result.error().to_string().c_str());
  }
  state.counters["poses"] = static_cast<double>(poses.size());
}

void arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"views", "threads"})
      ->ArgsProduct({{0, 1, 2, kMostViews}, {2}})
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}
BENCHMARK(best_of_all)->Apply(arguments)->Args({0, 1});
BENCHMARK(best_of_reachable)->Apply(arguments);
BENCHMARK(all_gains_of_every_41st)->Apply(arguments);

}  // namespace

BENCHMARK_MAIN();
