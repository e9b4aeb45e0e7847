// SPDX-License-Identifier: Apache-2.0
// Where the time of a tracked frame and of an evaluation of 960 views goes: counters in milliseconds, each the mean of
// its phase, timed by itself on the same data; and counts of what is touched, for the physical bounds.
#include <benchmark/benchmark.h>

#include "frames.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/map/internal/frame_fuser.hpp"
#include "saccade/map/internal/surface_tiles.hpp"
#include "saccade/map/ray_walk.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/views/internal/gain_problem.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;
using bench::frames;
using bench::kRegion;
using bench::kWarmFrames;

constexpr int kOpenTile_px{8};  ///< tiles of this size that are not decided go to the rays

benchmark::Counter mean(double value) { return {value, benchmark::Counter::kAvgIterations}; }

/// One frame per iteration, at its recorded pose. Argument: threads.
void tracked_frame(benchmark::State& state) {
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  const PinholeCamera& camera = frames().camera;
  TsdfMap map{bench::warm_map()};
  double list_ms{0.0};
  double raycast_ms{0.0};
  double points_ms{0.0};
  double align_ms{0.0};
  double range_ms{0.0};
  double sectors_ms{0.0};
  double integrate_ms{0.0};
  double bricks_seen{0.0};
  double bricks_updated{0.0};
  double bricks_free{0.0};
  double iterations{0.0};
  std::size_t i{kWarmFrames};
  for (auto _ : state) {
    const DepthImage& depth = frames().depth[i];
    const Pose& pose = frames().T_world_camera[i];
    const TsdfConfig& config = map.config();
    Stopwatch stopwatch;
    {
      const SectorTable sectors{map.content().grid};
      const SurfaceTiles tiles{map.content().grid, sectors, camera, pose, config.voxel_size_m, executor};
      bricks_seen += static_cast<double>(tiles.bricks().size());
      list_ms += stopwatch.lap_ms();
    }
    stopwatch.lap_ms();
    const auto view = raycast(map.content(), camera, pose, executor);
    raycast_ms += stopwatch.lap_ms();
    const PointImage model = to_points(*view, executor);
    const PointImage measured = to_points(depth, camera, executor);
    points_ms += stopwatch.lap_ms();
    const IcpResult aligned = align(measured, model, camera, Pose::Identity(), executor);
    align_ms += stopwatch.lap_ms();
    if (!aligned.converged) return state.SkipWithError("the track was lost");
    iterations += aligned.iterations;
    const RangeImage ranges{camera, depth, config.truncation_m(), executor};
    range_ms += stopwatch.lap_ms();
    const FrameFuser fuser{config, ranges, pose, nullptr};
    benchmark::DoNotOptimize(fuser.candidate_sectors(executor)->size());
    sectors_ms += stopwatch.lap_ms();
    const auto fused = map.integrate(camera, depth, pose, executor);
    integrate_ms += stopwatch.lap_ms();
    bricks_updated += static_cast<double>(fused->bricks_updated);
    bricks_free += static_cast<double>(fused->bricks_free);
    i = i + 1 < frames().depth.size() ? i + 1 : kWarmFrames;
  }
  state.counters["surface_lists_ms"] = mean(list_ms);
  state.counters["surface_rays_ms"] = mean(raycast_ms - list_ms);
  state.counters["points_ms"] = mean(points_ms);
  state.counters["align_ms"] = mean(align_ms);
  state.counters["ranges_ms"] = mean(range_ms);
  state.counters["sectors_ms"] = mean(sectors_ms);
  state.counters["bricks_ms"] = mean(integrate_ms - range_ms - sectors_ms);
  state.counters["surface_bricks"] = mean(bricks_seen);
  state.counters["bricks_updated"] = mean(bricks_updated);
  state.counters["bricks_free"] = mean(bricks_free);
  state.counters["iterations"] = mean(iterations);
}

/// Cells that the rays of a window look at when each goes by itself: bricks, and voxels of those that are mixed.
struct Walks {
  double rays{0.0};
  double looks{0.0};

  void add(const GainJob& job, const StopGrid& grid, float max_t) {
    const CastWindow& window = job.window;
    for (std::size_t j = 0; j < window.b.size(); ++j) {
      const ColumnRange columns = window.columns_of(static_cast<int>(j));
      for (int i = columns.begin; i < columns.end; ++i) {
        const LatticeRay ray = window.rays.ray(window.a[static_cast<std::size_t>(i)], window.b[j]);
        const RaySpan region = clip(ray, grid.scoring_voxels());
        if (region.empty()) continue;
        rays += 1.0;
        walk(ray, RaySpan{kRayStart, after_depth(max_t)}.until(region.exit), grid);
      }
    }
  }

 private:
  void walk(const LatticeRay& ray, const RaySpan& span, const StopGrid& grid) {
    walk_cells<kBrickLevel>(ray, span, [&](const Index3& index, const RaySpan& in_brick) {
      looks += 1.0;
      const StopGrid::Brick brick = grid.brick(index);
      if (brick.flags == stop_flags::kClear) return false;
      if (stop_flags::uniform(brick.flags)) return true;
      return walk_cells<kVoxelLevel>(ray, in_brick, [&](const Index3& voxel, const RaySpan&) {
        looks += 1.0;
        return brick.masks->stop.test(child_index(voxel));
      });
    });
  }
};

/// One thread, so that phases add up. Argument: best views fused.
void evaluation(benchmark::State& state) {
  const TsdfSnapshot& map = bench::map_after(static_cast<std::size_t>(state.range(0)));
  const GainConfig config;
  const Executor executor;
  double grid_ms{0.0};
  double prepare_ms{0.0};
  double tiles_ms{0.0};
  double rays_ms{0.0};
  std::uint64_t open_rays{0};
  std::uint64_t scored{0};
  std::uint64_t jobs{0};
  for (auto _ : state) {
    const auto problem = GainProblem::prepare(map, kRegion, bench::all_poses(), config, executor);
    Stopwatch stopwatch;
    IndexBox domain = problem->grid.scoring_voxels();
    for (const GainJob& job : problem->jobs) {
      const Index3& at = job.window.rays.origin.voxel;
      domain.lo = {std::min(domain.lo.x, at.x), std::min(domain.lo.y, at.y), std::min(domain.lo.z, at.z)};
      domain.hi = {std::max(domain.hi.x, at.x + 1), std::max(domain.hi.y, at.y + 1), std::max(domain.hi.z, at.z + 1)};
    }
    benchmark::DoNotOptimize(StopGrid::build(map, kRegion, config.unknown_outside, domain, true, executor).ok());
    grid_ms += stopwatch.lap_ms();
    prepare_ms += problem->prepare_ms;
    open_rays = scored = 0;
    for (const GainJob& job : problem->jobs) {
      GainCaster caster{problem->grid, job.window, problem->limits, nullptr};
      stopwatch.lap_ms();
      caster.look_over(kOpenTile_px);
      tiles_ms += stopwatch.lap_ms();
      open_rays += caster.open_rays();
      stopwatch.lap_ms();
      caster.refine(0);
      rays_ms += stopwatch.lap_ms();
      scored += caster.scored() * job.poses.size();
    }
    jobs = problem->jobs.size();
  }
  const auto whole = evaluate_views(map, kRegion, bench::all_poses(), config, executor);
  std::uint64_t expected{0};
  for (const std::uint64_t gain : whole->gains) expected += gain;
  if (scored != expected) return state.SkipWithError("the phases miss gains");
  state.counters["grid_ms"] = mean(grid_ms);
  state.counters["windows_ms"] = mean(prepare_ms - grid_ms);
  state.counters["tiles_ms"] = mean(tiles_ms);
  state.counters["rays_ms"] = mean(rays_ms);
  state.counters["lattices"] = static_cast<double>(jobs);
  state.counters["rays_open"] = static_cast<double>(open_rays);

  const auto problem = GainProblem::prepare(map, kRegion, bench::all_poses(), config, executor);
  constexpr std::size_t kEvery{7};
  Walks walks;
  for (std::size_t i = 0; i < problem->jobs.size(); i += kEvery) {
    walks.add(problem->jobs[i], problem->grid, problem->limits.max_t);
  }
  state.counters["rays"] = kEvery * walks.rays;
  state.counters["looks_per_ray"] = walks.looks / walks.rays;
  const FlatStops& flat = problem->grid.flat();
  state.counters["grid_bytes"] = static_cast<double>(4 * flat.bits.size());
}

BENCHMARK(tracked_frame)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(evaluation)->ArgName("views")->DenseRange(0, bench::kMostViews)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
