// SPDX-License-Identifier: Apache-2.0
// Contours of a map of 490,000 surface voxels: from scratch, beside a walk voxel by voxel, and after views of about 5 %
// of it were fused; its contour points and their views; what
// grouping them costs and brings.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "saccade/core/clock.hpp"
#include "saccade/sensor/noise.hpp"
#include "saccade/views/contours.hpp"
#include "saccade/views/view_gain.hpp"
#include "support/naive_contours.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kFewestVoxels{2000};

Executor threads_of(const benchmark::State& state) {
  return Executor::with_threads(static_cast<std::size_t>(state.range(0)));
}

const std::vector<TsdfSnapshot>& maps() {
  constexpr int kFrames{5};  // known is what was seen five times
  static const std::vector<TsdfSnapshot> made = bench::fine_maps_after_views(kFrames);
  return made;
}

void from_scratch(benchmark::State& state) {
  const Executor executor = threads_of(state);
  const TsdfSnapshot& map = maps().back();
  std::vector<ContourVoxel> found;
  for (auto _ : state) found = contour_voxels(map, {}, executor).value();
  if (found.size() < kFewestVoxels) return state.SkipWithError("too few contour voxels");
  state.counters["voxels"] = static_cast<double>(found.size());
}

void voxel_by_voxel(benchmark::State& state) {
  const TsdfSnapshot& map = maps().back();
  std::vector<ContourVoxel> found;
  for (auto _ : state) found = test::NaiveContours{map, ContourConfig{}.known_weight}.all();
  if (found != contour_voxels(map, {}, {}).value()) return state.SkipWithError("voxels differ");
  state.counters["voxels"] = static_cast<double>(found.size());
}

void after_view(benchmark::State& state) {
  const Executor executor = threads_of(state);
  LiveContours live = LiveContours::create().value();
  live.update(maps().front(), executor);
  live.update(maps()[1], executor);
  if (live.voxels() != contour_voxels(maps()[1], {}, executor).value()) {
    return state.SkipWithError("voxels differ from those from scratch");
  }
  std::size_t next{2};
  double changed{0.0};
  for (auto _ : state) {
    const Stopwatch stopwatch;
    changed += static_cast<double>(live.update(maps()[next], executor).bricks_changed);
    state.SetIterationTime(1e-3 * stopwatch.elapsed_ms());
    if (++next < maps().size()) continue;
    live.update(maps().front(), executor);  // untimed
    next = 1;
  }
  state.counters["bricks"] = changed / static_cast<double>(state.iterations());
}

/// Measures contour points and their views for the voxels of the whole map.
void points_and_views(benchmark::State& state) {
  const std::vector<ContourVoxel> voxels = contour_voxels(maps().back(), {}, {}).value();
  std::vector<ContourPoint> points;
  std::vector<Pose> views;
  for (auto _ : state) {
    points = contour_points(voxels, bench::kFineVoxel_m, {});
    views = contour_views(points).value();
  }
  if (views.size() < 40 * 50) return state.SkipWithError("too few views");
  state.counters["points"] = static_cast<double>(points.size());
  state.counters["views"] = static_cast<double>(views.size());
}

/// Two views of the table, ten noisy frames each; nothing else is known.
const TsdfSnapshot& map_of_two_views() {
  static const TsdfSnapshot made = [] {
    TsdfConfig config;
    config.truncation_vox = 2.0;
    TsdfMap map = TsdfMap::create(config).value();
    const PinholeCamera camera;
    for (std::uint64_t frame = 0; frame < 20; ++frame) {
      const double turn_rad = frame < 10 ? 0.0 : 2.1;
      const Eigen::Vector3d eye{0.56 * std::cos(turn_rad), 0.56 * std::sin(turn_rad), 0.67};
      const Pose T_world_camera = look_at(eye, bench::kPoi);
      const DepthImage depth = render(bench::table(), camera, T_world_camera, {}).value().depth;
      SACCADE_EXPECTS(map.integrate(camera, with_noise(depth, {}, frame), T_world_camera, {}).ok());
    }
    return map.snapshot();
  }();
  return made;
}

/// Cost and benefit of D_th: contour points, and the best gain of their views.
void grouping(benchmark::State& state) {
  const TsdfSnapshot& map = map_of_two_views();
  ContourConfig config;
  config.group_distance_m = 1e-3 * static_cast<double>(state.range(0));
  config.group_angle_rad = static_cast<double>(state.range(1)) * std::numbers::pi / 180.0;
  std::vector<ContourVoxel> voxels = contour_voxels(map, config, {}).value();
  std::erase_if(voxels, [&](const ContourVoxel& voxel) {
    return !contains(bench::kRegion, voxel_center(voxel.voxel, map.config.voxel_size_m));
  });
  std::vector<ContourPoint> points;
  for (auto _ : state) points = contour_points(voxels, map.config.voxel_size_m, config);
  GainConfig gain;
  gain.sensor = {160, 120, 131.25, 131.25, 79.5, 59.5, 0.5, 6.0};
  const std::vector<std::uint64_t> gains =
      evaluate_views(map, bench::kRegion, contour_views(points).value(), gain, Executor::with_threads(0)).value().gains;
  if (gains.empty()) return state.SkipWithError("no contours");
  state.counters["voxels"] = static_cast<double>(voxels.size());
  state.counters["points"] = static_cast<double>(points.size());
  state.counters["best_gain"] = static_cast<double>(*std::max_element(gains.begin(), gains.end()));
}

BENCHMARK(from_scratch)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(voxel_by_voxel)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(after_view)->ArgName("threads")->Arg(1)->Arg(2)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(grouping)
    ->ArgNames({"distance_mm", "angle_deg"})
    ->ArgsProduct({{6, 15, 30, 60, 100}, {30}})
    ->ArgsProduct({{30}, {15, 45}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(points_and_views)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
