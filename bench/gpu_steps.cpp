// SPDX-License-Identifier: Apache-2.0
#include "gpu_steps.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/clock.hpp"
#include "saccade/cuda/internal/cuda_compute.hpp"
#include "saccade/cuda/internal/gain_kernel.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/views/expected_surface.hpp"
#include "saccade/views/surface_gain.hpp"
#include "saccade/views/view_gain.hpp"
#include "table_map.hpp"

namespace saccade::bench {
namespace {

bool equal(const ExpectedSurface& a, const ExpectedSurface& b) {
  return a.seen_cm2 == b.seen_cm2 && a.completed == b.completed &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const ExpectedPoint& p, const ExpectedPoint& q) {
                      return p.voxel == q.voxel && p.normal == q.normal && p.area_cm2 == q.area_cm2 &&
                             p.support == q.support && p.object == q.object;
                    });
}

bool equal(const RankedViews& a, const RankedViews& b) {
  return std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(),
                    [](const RankedView& p, const RankedView& q) {
                      return p.gain == q.gain && p.T_world_camera.matrix() == q.T_world_camera.matrix();
                    });
}

/// Expected surface of the table, and the best of the 960 views by lines of sight.
Result<bool> check_surface(const GpuCheck& check) {
  const Executor executor = Executor::with_threads(0);
  TsdfSnapshot map = map_after(check.quick ? 0 : kMostViews);
  map.config.workspace = Box{{-0.6, -0.6, -0.1}, {0.6, 0.6, 0.5}};
  GpuMap gpu = open(check, map.config);
  const std::vector<Pose> poses = check.quick ? every_nth_pose(64) : all_poses();
  RegionOfInterest region;
  region.bounds = *map.config.workspace;
  SurfaceGain gain{SurfaceGainConfig{}};
  std::vector<double> gpu_ms;
  std::vector<double> cpu_ms;
  std::vector<double> gpu_views_ms;
  std::vector<double> cpu_views_ms;
  bool same{true};
  std::size_t points{0};
  for (int i = 0; i < (check.quick ? 1 : 12); ++i) {
    Stopwatch clock;
    SACCADE_TRY(ExpectedSurface wanted, expected_surface(map, {}, executor));
    cpu_ms.push_back(clock.lap_ms());
    SACCADE_TRY(ExpectedSurface got, expected_surface(map, {}, executor, &gpu));
    gpu_ms.push_back(clock.lap_ms());
    same = same && equal(got, wanted);
    points = wanted.points.size();
    const auto best = [&](ExpectedSurface surface, ViewDevice* device) {
      auto shared = std::make_shared<const ExpectedSurface>(std::move(surface));
      PlanningContext context{map, executor};
      context.expected = &shared;
      context.device = device;
      clock.lap_ms();
      return gain.best(context, region, poses, 4);
    };
    SACCADE_TRY(const RankedViews wanted_views, best(std::move(wanted), nullptr));
    cpu_views_ms.push_back(clock.lap_ms());
    SACCADE_TRY(const RankedViews got_views, best(std::move(got), &gpu));
    gpu_views_ms.push_back(clock.lap_ms());
    same = same && equal(got_views, wanted_views);
  }
  std::printf(" \"expected_surface\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"points\": %zu, \"equal\": %s},\n",
              median(gpu_ms), median(cpu_ms), points, text_of(same));
  std::printf(" \"surface_views\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"poses\": %zu},\n", median(gpu_views_ms),
              median(cpu_views_ms), poses.size());
  return same;
}

/// Steps of fusion, ray cast and 120 views that leave the map on the device, then what changed back and forth.
Result<bool> check_steps(const GpuCheck& check) {
  const Executor executor = Executor::with_threads(0);
  const PinholeCamera camera;
  const std::vector<Pose> poses = every_nth_pose(check.quick ? 480 : 64);
  const std::vector<Pose> views = every_nth_pose(check.quick ? 320 : 8);
  TsdfSnapshot start = map_after(0);
  GpuMap gpu = open(check, start.config);
  SACCADE_CHECK(gpu.assign(start));
  TsdfMap cpu{start};
  std::vector<double> gpu_ms;
  std::vector<double> cpu_ms;
  std::vector<double> pull_ms;
  std::vector<double> follow_ms;
  GpuTraffic in_steps{};
  GpuTraffic in_pulls{};
  bool same{true};
  for (const Pose& pose : poses) {
    SACCADE_TRY(const RenderedFrame rendered, render(table(), camera, pose, executor));
    const GpuTraffic before = gpu.traffic();
    Stopwatch clock;
    SACCADE_CHECK(gpu.integrate(camera, rendered.depth, pose));
    SACCADE_TRY(const SurfaceView seen, gpu.raycast(camera, pose));
    SACCADE_TRY(const GainResult gains, gpu.evaluate_views(kRegion, views, {}, executor));
    gpu_ms.push_back(clock.lap_ms());
    const GpuTraffic after = gpu.traffic();
    SACCADE_CHECK(cpu.integrate(camera, rendered.depth, pose, executor));
    SACCADE_TRY(const SurfaceView wanted, raycast(cpu.content(), camera, pose, executor));
    SACCADE_TRY(const GainResult wanted_gains, evaluate_views(cpu.content(), kRegion, views, {}, executor));
    cpu_ms.push_back(clock.lap_ms());
    SACCADE_TRY(const TsdfSnapshot content, gpu.snapshot());
    pull_ms.push_back(clock.lap_ms());
    in_steps.bytes_sent += after.bytes_sent - before.bytes_sent;
    in_steps.bytes_read += after.bytes_read - before.bytes_read;
    in_pulls.bytes_read += gpu.traffic().bytes_read - after.bytes_read;
    same = same && gains.gains == wanted_gains.gains && content.grid == cpu.content().grid &&
           std::equal(seen.depth.data(), seen.depth.data() + seen.depth.size(), wanted.depth.data());
    SACCADE_CHECK(cpu.forget(Sphere{kPoi, 0.05}));
    clock.lap_ms();
    SACCADE_CHECK(gpu.follow(cpu.content(), executor));
    follow_ms.push_back(clock.lap_ms());
  }
  const auto steps = static_cast<double>(poses.size());
  std::printf(
      " \"step\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"views\": %zu, \"sent_kib\": %.0f, \"read_kib\": %.0f, "
      "\"pull_ms\": %.3f, \"pulled_kib\": %.0f, \"follow_ms\": %.3f, \"equal\": %s},\n",
      median(gpu_ms), median(cpu_ms), views.size(), static_cast<double>(in_steps.bytes_sent) / 1024.0 / steps,
      static_cast<double>(in_steps.bytes_read) / 1024.0 / steps, median(pull_ms),
      static_cast<double>(in_pulls.bytes_read) / 1024.0 / steps, median(follow_ms), text_of(same));
  return same;
}

/// Returns the bytes that a map's bricks take on a device, without the table: values, weights and masks.
std::size_t bytes_of_bricks(const TsdfSnapshot& map, const Executor& executor) {
  constexpr std::size_t kBrickBytes{kBrickVoxels * 4 + kBrickVoxels / 4};
  std::size_t bytes{0};
  for (const SectorBricks& some : changed_sectors({}, map.grid, executor)) {
    const Sector& sector = *map.grid.find(some.sector);
    some.bricks.for_each(
        [&](std::size_t i) { bytes += sector.bricks[i].kind() == BrickKind::constant_free ? 0 : kBrickBytes; });
  }
  return bytes;
}

/// Views from four sides in turn, on a device that has room for half the map's bricks.
Result<bool> check_pages(const GpuCheck& check) {
  const Executor executor = Executor::with_threads(0);
  const TsdfSnapshot& map = map_after(0);
  const std::size_t memory_bytes = bytes_of_bricks(map, executor) / 2;
  GpuMap gpu = open(check, map.config, memory_bytes);
  SACCADE_CHECK(gpu.assign(map));
  const std::span<const Pose> all{all_poses()};
  constexpr std::size_t kSides{4};
  constexpr std::size_t kViews{8};  // all rolls of a camera centre
  std::vector<std::span<const Pose>> sides;
  for (std::size_t side = 0; side < kSides; ++side) sides.push_back(all.subspan(side * all.size() / kSides, kViews));
  std::array<std::vector<std::uint64_t>, kSides> wanted;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    SACCADE_TRY(GainResult gains, evaluate_views(map, kRegion, sides[side], {}, executor));
    wanted[side] = std::move(gains.gains);
  }
  std::vector<double> gpu_ms;
  bool same{true};
  const GpuTraffic before = gpu.traffic();
  const std::size_t turns = check.quick ? 8 : 40;
  for (std::size_t turn = 0; turn < turns; ++turn) {
    const std::size_t side = turn % sides.size();
    const Stopwatch clock;
    SACCADE_TRY(const GainResult gains, gpu.evaluate_views(kRegion, sides[side], {}, executor));
    gpu_ms.push_back(clock.elapsed_ms());
    same = same && gains.gains == wanted[side];
  }
  const bool paged = gpu.is_paged();
  std::printf(
      " \"pages\": {\"gpu_ms\": %.3f, \"memory_mib\": %.1f, \"sent_kib\": %.0f, \"views\": %zu, \"paged\": %s, "
      "\"equal\": %s},\n",
      median(gpu_ms), static_cast<double>(memory_bytes) / (1U << 20U),
      link_bytes(before, gpu.traffic()).sent / 1024.0 / static_cast<double>(turns), sides.front().size(),
      text_of(paged), text_of(same));
  return same && paged;
}

/// The 960 views with other limits of the gain kernel's registers: more blocks on a multiprocessor hide more of the
/// time that a ray waits for the map, and spill more. What is fastest is a question to the GPU.
Result<bool> time_register_limits(const GpuCheck& check) {
  const Executor executor = Executor::with_threads(0);
  const TsdfSnapshot& map = map_after(0);
  std::vector<std::uint64_t> first;
  std::string times;
  bool same{true};
  for (const unsigned blocks : {1U, 10U, 12U, 16U}) {
    SACCADE_TRY(auto compute, internal::cuda::open_cuda(internal::cuda::with_blocks_per_unit(
                                  internal::cuda::kernel_ptx(), internal::cuda::CountScoringRays::kName, blocks)));
    GpuMap gpu = internal::cuda::GpuMapMaker::make(map.config, std::move(compute));
    SACCADE_CHECK(gpu.assign(map));
    std::vector<double> took_ms;
    GainResult gains;
    for (int i = 0; i < (check.quick ? 2 : 20); ++i) {
      const Stopwatch clock;
      SACCADE_TRY(gains, gpu.evaluate_views(kRegion, all_poses(), {}, executor));
      took_ms.push_back(clock.elapsed_ms());
    }
    if (first.empty()) first = gains.gains;
    same = same && gains.gains == first;
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%s\"%u\": %.3f", times.empty() ? "" : ", ", blocks, median(took_ms));
    times += text.data();
  }
  std::printf(" \"gains_by_blocks_per_unit\": {%s},\n", times.c_str());
  return same;
}

}  // namespace

Result<bool> check_gpu_steps(const GpuCheck& check) {
  SACCADE_TRY(const bool surface, check_surface(check));
  SACCADE_TRY(const bool steps, check_steps(check));
  SACCADE_TRY(const bool pages, check_pages(check));
  const bool same = surface && steps && pages;
  if (check.emulated) return same;
  SACCADE_TRY(const bool limits, time_register_limits(check));
  return same && limits;
}

}  // namespace saccade::bench
