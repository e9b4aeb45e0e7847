// SPDX-License-Identifier: Apache-2.0
// Fusion, surface ray cast, tracking, snapshots and forgetting at 5.8 mm and 640×480, on recorded Kinect frames
// ($SACCADE_DATA/rgbd_redkitchen, ../shared/data), else on frames of the built-in sample scene.
#include <benchmark/benchmark.h>

#include <cmath>

#include "frames.hpp"
#include "peers.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/core/simd.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace {

using namespace saccade;
using bench::frames;
using bench::kWarmFrames;
using bench::warm_map;

Executor executor_of(const benchmark::State& state) {
  return Executor::with_threads(static_cast<std::size_t>(state.range(0)));
}

void integrate(benchmark::State& state) {
  const Executor executor = executor_of(state);
  TsdfMap map{warm_map()};
  std::size_t i{kWarmFrames};
  for (auto _ : state) {
    const auto done = map.integrate(frames().camera, frames().depth[i], frames().T_world_camera[i], executor);
    if (!done || done->bricks_updated == 0) return state.SkipWithError("nothing was fused");
    i = i + 1 < frames().depth.size() ? i + 1 : kWarmFrames;
  }
}

void surface_raycast(benchmark::State& state) {
  const Executor executor = executor_of(state);
  const TsdfSnapshot& map = warm_map();
  std::size_t i{kWarmFrames};
  for (auto _ : state) {
    const auto view = raycast(map, frames().camera, frames().T_world_camera[i], executor);
    benchmark::DoNotOptimize(view->depth.data());
    i = i + 1 < frames().depth.size() ? i + 1 : kWarmFrames;
  }
}

void icp(benchmark::State& state) {
  const Executor executor = executor_of(state);
  const PinholeCamera& camera = frames().camera;
  const auto view = raycast(warm_map(), camera, frames().T_world_camera[kWarmFrames - 1], executor);
  const PointImage model = to_points(*view, executor);
  double iterations{0.0};
  for (auto _ : state) {
    const PointImage measured = to_points(frames().depth[kWarmFrames], camera, executor);
    const IcpResult result = align(measured, model, camera, Pose::Identity(), executor);
    if (!result.converged) return state.SkipWithError("the track was lost");
    iterations = result.iterations;
  }
  state.counters["iterations"] = iterations;
}

void tracked_frame(benchmark::State& state) {
  const Executor executor = executor_of(state);
  Reconstruction reconstruction = Reconstruction::resume(warm_map(), {}).value();
  std::size_t i{kWarmFrames};
  reconstruction.resume(frames().T_world_camera[i]);
  const auto fuses_next = [&] {
    Frame frame;
    frame.depth = frames().depth[i];
    const auto report = reconstruction.process(frame, frames().camera, TrackingMode::icp, std::nullopt, executor);
    if (++i == frames().depth.size()) {
      i = kWarmFrames;
      reconstruction.resume(frames().T_world_camera[i]);
    }
    return report && report->status == FrameReport::Status::fused;
  };
  bool tracked{true};
  do {  // the map takes its bricks over from the snapshot
    tracked = fuses_next();
  } while (tracked && i != kWarmFrames);
  for (auto _ : state) {
    if (!tracked) return state.SkipWithError("the track was lost");
    tracked = fuses_next();
  }
  if (!tracked) state.SkipWithError("the track was lost");
}

#ifdef SACCADE_WITH_OPEN3D
bench::Open3dGrid& open3d_map() {
  static bench::Open3dGrid grid{frames().camera, TsdfConfig{}.voxel_size_m, TsdfConfig{}.truncation_vox};
  static const bool filled = [] {
    for (std::size_t i = 0; i < kWarmFrames; ++i) grid.integrate(frames().depth[i], frames().T_world_camera[i]);
    return true;
  }();
  benchmark::DoNotOptimize(filled);
  return grid;
}

void open3d_integrate(benchmark::State& state) {
  bench::Open3dGrid& grid = open3d_map();
  std::size_t i{kWarmFrames};
  for (auto _ : state) {
    grid.integrate(frames().depth[i], frames().T_world_camera[i]);
    i = i + 1 < frames().depth.size() ? i + 1 : kWarmFrames;
  }
}

/// Tells whether two ray casts of the same view show the same surface, within the truncation: the peer's lies 4 mm
/// farther in the median on the recorded frames, and nine tenths of the pixels within ±12 mm.
bool same_surface(const DepthImage& ours, const DepthImage& theirs) {
  std::size_t both{0};
  std::size_t near{0};
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const float a = ours.data()[i];
    const float b = theirs.data()[i];
    if (!(a > 0.0F) || !(b > 0.0F)) continue;
    ++both;
    near += std::fabs(a - b) < static_cast<float>(TsdfConfig{}.truncation_m()) ? 1U : 0U;
  }
  return both > ours.size() / 4 && near > both * 9 / 10;
}

void open3d_raycast(benchmark::State& state) {
  bench::Open3dGrid& grid = open3d_map();
  std::size_t i{kWarmFrames};
  const auto ours = raycast(warm_map(), frames().camera, frames().T_world_camera[i], {});
  if (!same_surface(ours->depth, grid.raycast(frames().depth[i], frames().T_world_camera[i]))) {
    return state.SkipWithError("its surface differs from ours");
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(grid.raycast(frames().depth[i], frames().T_world_camera[i]).data());
    i = i + 1 < frames().depth.size() ? i + 1 : kWarmFrames;
  }
}

BENCHMARK(open3d_integrate)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(open3d_raycast)->Unit(benchmark::kMillisecond)->UseRealTime();
#endif

#ifdef SACCADE_WITH_OPENCV_RGBD
void opencv_icp(benchmark::State& state) {
  const auto view =
      raycast(warm_map(), frames().camera, frames().T_world_camera[kWarmFrames - 1], Executor::with_threads(0));
  bench::OpencvIcp peer{frames().camera};
  peer.set_model(view->depth);
  Pose T_model_camera;
  const PointImage measured = to_points(frames().depth[kWarmFrames], frames().camera, {});
  const IcpResult ours = align(measured, to_points(*view, {}), frames().camera, Pose::Identity(), {});
  if (!peer.align(frames().depth[kWarmFrames], T_model_camera) ||
      (T_model_camera.translation() - ours.T_model_camera.translation()).norm() > 0.02) {
    return state.SkipWithError("its pose differs from ours");
  }
  for (auto _ : state) {
    if (!peer.align(frames().depth[kWarmFrames], T_model_camera)) return state.SkipWithError("the track was lost");
  }
}
BENCHMARK(opencv_icp)->Unit(benchmark::kMillisecond)->UseRealTime();
#endif

void snapshot(benchmark::State& state) {
  const TsdfMap map{warm_map()};
  for (auto _ : state) {
    const TsdfSnapshot copy = map.snapshot();
    benchmark::DoNotOptimize(copy.grid.sector_count());
  }
  state.counters["sectors"] = static_cast<double>(map.content().grid.sector_count());
}

void forget(benchmark::State& state) {
  const Eigen::Vector3d center = frames().seen_point();
  for (auto _ : state) {
    TsdfMap map{warm_map()};
    const Stopwatch stopwatch;
    benchmark::DoNotOptimize(map.forget(Sphere{center, 0.2}).ok());
    state.SetIterationTime(1e-3 * stopwatch.elapsed_ms());
  }
}

BENCHMARK(integrate)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(surface_raycast)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(icp)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(tracked_frame)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(snapshot)->Unit(benchmark::kMillisecond);
BENCHMARK(forget)->Unit(benchmark::kMillisecond)->UseManualTime();

/// One thread, on an instruction set that the processor has.
void register_target(const std::string& target) {
  const auto on_target = [&](const char* name, void (*body)(benchmark::State&)) {
    benchmark::RegisterBenchmark((std::string{name} + "_on_" + target).c_str(),
                                 [=](benchmark::State& state) {
                                   SACCADE_EXPECTS(use_simd_target(target).ok());
                                   body(state);
                                   SACCADE_EXPECTS(use_simd_target("").ok());
                                 })
        ->Arg(1)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  on_target("integrate", integrate);
  on_target("surface_raycast", surface_raycast);
  on_target("icp", icp);
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string& target : simd_targets()) register_target(target);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
