// SPDX-License-Identifier: Apache-2.0
// How cost grows with the number of views, image size, voxel size, map extent and threads. One of them varies per row,
// its argument; the others are as in view_evaluation and mapping.
#include <benchmark/benchmark.h>

#include <map>
#include <numbers>

#include "frames.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;
using bench::frames;
using bench::kRegion;
using bench::kWarmFrames;

const double kDefaultVoxel_m{TsdfConfig{}.voxel_size_m};

double voxel_size_m(const benchmark::State& state) { return 1e-6 * static_cast<double>(state.range(0)); }

PinholeCamera scaled(PinholeCamera camera, std::int64_t width) {
  const double factor = static_cast<double>(width) / camera.width;
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(factor * camera.height);
  camera.fx *= factor;
  camera.fy *= factor;
  camera.cx = factor * (camera.cx + 0.5) - 0.5;
  camera.cy = factor * (camera.cy + 0.5) - 0.5;
  return camera;
}

/// The nearest pixel of the recorded image, so that noise and edges stay what they are.
DepthImage scaled(const DepthImage& image, const PinholeCamera& camera) {
  DepthImage resampled{camera.width, camera.height};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      resampled(u, v) = image(u * image.width() / camera.width, v * image.height() / camera.height);
    }
  }
  return resampled;
}

const TsdfSnapshot& table_of(double voxel_size_m, double extent_m, bool workspace) {
  static std::map<std::pair<double, double>, TsdfSnapshot> maps;
  TsdfSnapshot& map = maps[{voxel_size_m, workspace ? extent_m : 0.0}];
  if (map.grid.empty()) map = bench::table_map({voxel_size_m, 0.5 * extent_m, workspace});
  return map;
}
const TsdfSnapshot& table_of(double voxel_size_m) { return table_of(voxel_size_m, 2.4, false); }

/// Latitudes and rolls stay as they are: 80 poses per longitude.
std::vector<Pose> poses_of_longitudes(std::size_t longitudes) {
  ViewSphereConfig config;
  config.longitude_step_rad = 2.0 * std::numbers::pi / static_cast<double>(longitudes);
  return poses_of(view_sphere(bench::kPoi, config).value());
}

void evaluate(benchmark::State& state, const TsdfSnapshot& map, const std::vector<Pose>& poses,
              const GainConfig& config, std::size_t threads) {
  const Executor executor = Executor::with_threads(threads);
  GainConfig by_ray = config;
  by_ray.savings.tiles = by_ray.savings.shared_lattice = false;
  const std::ptrdiff_t checked{11};
  const std::uint64_t expected =
      evaluate_views(map, kRegion, std::span{poses.data() + checked, 1}, by_ray, executor).value().gains.front();
  for (auto _ : state) {
    const auto result = evaluate_views(map, kRegion, poses, config, executor);
    if (expected == 0 || result->gains[checked] != expected) return state.SkipWithError("a gain is wrong");
  }
  state.counters["poses"] = static_cast<double>(poses.size());
}

void evaluate_by_poses(benchmark::State& state) {
  evaluate(state, table_of(kDefaultVoxel_m), poses_of_longitudes(static_cast<std::size_t>(state.range(0)) / 80), {}, 2);
}
void evaluate_by_image_width(benchmark::State& state) {
  GainConfig config;
  config.sensor = scaled(config.sensor, state.range(0));
  evaluate(state, table_of(kDefaultVoxel_m), bench::all_poses(), config, 2);
}
void evaluate_by_voxel_um(benchmark::State& state) {
  evaluate(state, table_of(voxel_size_m(state)), bench::all_poses(), {}, 2);
}
void evaluate_by_extent_m(benchmark::State& state) {
  evaluate(state, table_of(kDefaultVoxel_m, static_cast<double>(state.range(0)), true), bench::all_poses(), {}, 2);
}
void evaluate_by_threads(benchmark::State& state) {
  evaluate(state, table_of(kDefaultVoxel_m), bench::all_poses(), {}, static_cast<std::size_t>(state.range(0)));
}

const TsdfSnapshot& warm_map(double voxel_size_m) {
  static std::map<double, TsdfSnapshot> maps;
  TsdfSnapshot& map = maps[voxel_size_m];
  if (map.grid.empty()) {
    TsdfConfig config;
    config.voxel_size_m = voxel_size_m;
    TsdfMap fused = TsdfMap::create(config).value();
    const Executor executor = Executor::with_threads(0);
    for (std::size_t i = 0; i < kWarmFrames; ++i) {
      SACCADE_EXPECTS(fused.integrate(frames().camera, frames().depth[i], frames().T_world_camera[i], executor).ok());
    }
    map = fused.snapshot();
  }
  return map;
}

/// Input of a row about the map.
struct MapCase {
  double voxel_size_m;
  std::int64_t width;
  std::size_t threads;
};
MapCase by_image_width(const benchmark::State& state) { return {kDefaultVoxel_m, state.range(0), 2}; }
MapCase by_voxel_um(const benchmark::State& state) { return {voxel_size_m(state), 640, 2}; }
MapCase by_threads(const benchmark::State& state) {
  return {kDefaultVoxel_m, 640, static_cast<std::size_t>(state.range(0))};
}

template <MapCase (*kCase)(const benchmark::State&)>
void integrate(benchmark::State& state) {
  const MapCase wanted = kCase(state);
  const Executor executor = Executor::with_threads(wanted.threads);
  const PinholeCamera camera = scaled(frames().camera, wanted.width);
  std::vector<DepthImage> images;
  for (std::size_t i = kWarmFrames; i < frames().depth.size(); ++i) images.push_back(scaled(frames().depth[i], camera));
  TsdfMap map{warm_map(wanted.voxel_size_m)};
  std::size_t i{0};
  for (auto _ : state) {
    const auto done = map.integrate(camera, images[i], frames().T_world_camera[kWarmFrames + i], executor);
    if (!done || done->bricks_updated == 0) return state.SkipWithError("nothing was fused");
    i = (i + 1) % images.size();
  }
}

template <MapCase (*kCase)(const benchmark::State&)>
void surface_raycast(benchmark::State& state) {
  const MapCase wanted = kCase(state);
  const Executor executor = Executor::with_threads(wanted.threads);
  const PinholeCamera camera = scaled(frames().camera, wanted.width);
  const TsdfSnapshot& map = warm_map(wanted.voxel_size_m);
  const auto seen = raycast(map, camera, frames().T_world_camera[kWarmFrames], executor);
  std::size_t hits{0};
  for (const float depth : seen->depth.pixels()) hits += depth > 0.0F ? 1U : 0U;
  if (hits < seen->depth.size() / 4) return state.SkipWithError("little surface is seen");
  std::size_t i{kWarmFrames};
  for (auto _ : state) {
    benchmark::DoNotOptimize(raycast(map, camera, frames().T_world_camera[i], executor)->depth.data());
    i = i + 1 < frames().depth.size() ? i + 1 : kWarmFrames;
  }
}

using Row = benchmark::internal::Benchmark;
void row(Row* row, const char* argument) {
  row->ArgName(argument)->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(0.15);
}
void poses(Row* made) {
  row(made, "poses");
  for (const int longitudes : {1, 3, 6, 12, 24, 48}) made->Arg(80L * longitudes);
}
void widths(Row* made) {
  row(made, "width_px");
  for (const int width : {160, 320, 640, 1280}) made->Arg(width);
}
void voxels(Row* made) {
  row(made, "voxel_um");
  for (const int voxel : {2900, 5800, 11600, 23200}) made->Arg(voxel);
}
void extents(Row* made) {
  row(made, "extent_m");
  for (const int extent : {1, 2, 4, 8}) made->Arg(extent);
}
/// 1, 2, 4 … up to all cores.
void threads(Row* made) {
  row(made, "threads");
  const std::size_t cores = Executor::with_threads(0).threads();
  for (std::size_t n = 1; n < cores; n *= 2) made->Arg(static_cast<std::int64_t>(n));
  made->Arg(static_cast<std::int64_t>(cores));
}

BENCHMARK(evaluate_by_poses)->Apply(poses);
BENCHMARK(evaluate_by_image_width)->Apply(widths);
BENCHMARK(evaluate_by_voxel_um)->Apply(voxels);
BENCHMARK(evaluate_by_extent_m)->Apply(extents);
BENCHMARK(evaluate_by_threads)->Apply(threads);
BENCHMARK(integrate<by_image_width>)->Name("integrate_by_image_width")->Apply(widths);
BENCHMARK(integrate<by_voxel_um>)->Name("integrate_by_voxel_um")->Apply(voxels);
BENCHMARK(integrate<by_threads>)->Name("integrate_by_threads")->Apply(threads);
BENCHMARK(surface_raycast<by_image_width>)->Name("surface_raycast_by_image_width")->Apply(widths);
BENCHMARK(surface_raycast<by_voxel_um>)->Name("surface_raycast_by_voxel_um")->Apply(voxels);
BENCHMARK(surface_raycast<by_threads>)->Name("surface_raycast_by_threads")->Apply(threads);

}  // namespace

BENCHMARK_MAIN();
