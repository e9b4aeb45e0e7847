// SPDX-License-Identifier: Apache-2.0
// Twenty regions in the built-in tabletop scenes, as the robot knows them after its scan: spheres of 0.2 m around
// points of surfaces, just forgotten, and again after the frame from the best view was fused. All gains, or only the
// best view. Of all gains the time of the region in the middle, too: after the frame a few regions, of which one view
// shows little, take most of the time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>

#include "saccade/core/clock.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/views/internal/best_views.hpp"
#include "saccade/views/view_sphere.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kRegionsPerScene{5};
constexpr double kRadius_m{0.2};
constexpr int kEveryVoxel{37};  // step between a brick's voxels among which surface points are drawn

struct Case {
  Region region;
  std::vector<Pose> poses;
  TsdfSnapshot first;  ///< the region just forgotten
  TsdfSnapshot again;  ///< and the frame from the best view fused
};

std::vector<Eigen::Vector3d> surface_points(const TsdfSnapshot& map) {
  std::vector<Eigen::Vector3d> points;
  for (const Index3& at : map.grid.sorted_sectors()) {
    const Sector& sector = *map.grid.find(at);
    sector.has_occupied.for_each([&](std::size_t i) {
      const Index3 brick = at * kSectorEdge + child_offset(static_cast<int>(i));
      const Mask512 occupied = sector.bricks[i].occupied_mask();
      for (int k = 0; k < kBrickVoxels; k += kEveryVoxel) {
        if (!occupied.test(k)) continue;
        points.push_back(voxel_center(brick * kBrickEdge + child_offset(k), map.config.voxel_size_m));
      }
    });
  }
  return points;
}

/// Cases in the map that the scan of a scene leaves.
Result<std::vector<Case>> cases_of(const std::string& name, const Executor& executor) {
  SACCADE_TRY(Scene scene, find_scene(name));
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

  const std::vector<Eigen::Vector3d> points = surface_points(map.content());
  std::mt19937 random{1};
  std::vector<Case> cases;
  for (std::size_t i = 0; i < kRegionsPerScene; ++i) {
    const Eigen::Vector3d& center = points[random() % points.size()];
    Case made{Sphere{center, kRadius_m}, {}, {}, {}};
    SACCADE_TRY(const std::vector<ViewCandidate> sphere, view_sphere(center));
    made.poses = poses_of(sphere);
    TsdfMap forgetting{map.snapshot()};
    SACCADE_CHECK(forgetting.forget(made.region));
    made.first = forgetting.snapshot();
    SACCADE_TRY(const BestViews best, best_views(made.first, made.region, made.poses, 1, {}, executor));
    const Pose& view = best.views.front().T_world_camera;
    SACCADE_CHECK(forgetting.integrate(config.camera, camera.capture(view, executor).depth, view, executor));
    made.again = forgetting.snapshot();
    cases.push_back(std::move(made));
  }
  return cases;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> made = [] {
    std::vector<Case> all;
    const Executor executor = Executor::with_threads(0);
    for (const char* const scene : {"tabletop-1", "tabletop-2", "tabletop-3", "tabletop-4"}) {
      auto some = cases_of(scene, executor).value();
      std::move(some.begin(), some.end(), std::back_inserter(all));
    }
    return all;
  }();
  return made;
}

const TsdfSnapshot& map_of(const Case& region, bool again) { return again ? region.again : region.first; }

/// Arguments of the benchmarks: whether the frame from the best view was fused; threads.
void all_poses(benchmark::State& state) {
  const bool again = state.range(0) != 0;
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  double poses{0.0};
  (void)cases();
  for (auto _ : state) {
    poses = 0.0;
    for (const Case& region : cases()) {
      const auto result = evaluate_views(map_of(region, again), region.region, region.poses, {}, executor);
      if (!result) return state.SkipWithError(result.error().to_string().c_str());
      poses += static_cast<double>(result->gains.size());
    }
  }
  state.counters["poses"] = poses;
}

void best_pose(benchmark::State& state) {
  const bool again = state.range(0) != 0;
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  std::vector<OrderedView> expected;
  for (const Case& region : cases()) {
    const auto all = evaluate_views(map_of(region, again), region.region, region.poses, {}, executor);
    expected.push_back(order_views(all.value().gains, region.poses).front());
  }
  double evaluated{0.0};
  for (auto _ : state) {
    evaluated = 0.0;
    for (std::size_t i = 0; i < cases().size(); ++i) {
      const Case& region = cases()[i];
      const auto best = best_views(map_of(region, again), region.region, region.poses, 1, {}, executor);
      if (!best || best->views.front().index != expected[i].index || best->views.front().gain != expected[i].gain) {
        return state.SkipWithError("the best view differs from that of all gains");
      }
      evaluated += static_cast<double>(best->poses_evaluated);
    }
  }
  state.counters["poses_evaluated"] = evaluated;
}

/// All gains in each region; what is timed is the region in the middle: the mean of the two there.
void all_poses_of_median_region(benchmark::State& state) {
  const bool again = state.range(0) != 0;
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  (void)cases();
  for (auto _ : state) {
    std::vector<double> times_ms;
    for (const Case& region : cases()) {
      const Stopwatch clock;
      const auto result = evaluate_views(map_of(region, again), region.region, region.poses, {}, executor);
      if (!result) return state.SkipWithError(result.error().to_string().c_str());
      times_ms.push_back(clock.elapsed_ms());
    }
    std::sort(times_ms.begin(), times_ms.end());
    const std::size_t middle = times_ms.size() / 2;
    state.SetIterationTime(0.5e-3 * (times_ms[middle - 1] + times_ms[middle]));
  }
}

void arguments(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"again", "threads"})->ArgsProduct({{0, 1}, {2}})->Unit(benchmark::kMillisecond);
}
BENCHMARK(all_poses)->Apply(arguments)->UseRealTime();
BENCHMARK(best_pose)->Apply(arguments)->UseRealTime();
BENCHMARK(all_poses_of_median_region)->Apply(arguments)->UseManualTime();

}  // namespace

BENCHMARK_MAIN();
