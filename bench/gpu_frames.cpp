// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <vector>

#include "gpu_steps.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/cuda/gpu_align.hpp"
#include "saccade/map/map_changes.hpp"
#include "table_map.hpp"

namespace saccade::bench {
namespace {

/// What is asked of the GPU, in milliseconds.
constexpr double kAskedFusion_ms{0.3};
constexpr double kAskedRaycast_ms{0.5};

constexpr double kVoxelBytes{4.0};  // value and weight
constexpr double kMaskBytes{2.0 * kBrickVoxels / 8.0};
constexpr double kEntryBytes{4.0};

/// A map with the same images on both, and the images.
struct Frames {
  Executor executor{Executor::with_threads(0)};
  PinholeCamera camera{};
  std::vector<Pose> poses;
  std::vector<DepthImage> images;
  TsdfMap cpu;
  GpuMap gpu;
};

struct FrameTimes {
  std::vector<double> gpu_ms;
  std::vector<double> cpu_ms;
  std::vector<double> gpu_raycast_ms;
  std::vector<double> cpu_raycast_ms;
  std::vector<double> gpu_align_ms;
  std::vector<double> cpu_align_ms;
  int frames{0};
  int different_pixels{0};
  int different_alignments{0};
};

/// Fuses all images in turn, casts rays from their poses, and aligns them; in a map that has seen them all before, but
/// for the first round.
FrameTimes time_frames(const GpuCheck& check, Frames& f) {
  GpuAligner aligner = need(check.emulated ? GpuAligner::create_emulated(f.executor) : GpuAligner::create());
  FrameTimes times;
  Pose T_start = Pose::Identity();
  T_start.translation() = Eigen::Vector3d{0.01, -0.005, 0.008};
  for (int round = 0; round < (check.quick ? 1 : 3); ++round) {
    for (std::size_t i = 0; i < f.poses.size(); ++i, ++times.frames) {
      Stopwatch clock;
      need(f.cpu.integrate(f.camera, f.images[i], f.poses[i], f.executor));
      const double cpu_took_ms = clock.lap_ms();
      need(f.gpu.integrate(f.camera, f.images[i], f.poses[i]));
      const double gpu_took_ms = clock.lap_ms();
      const SurfaceView on_gpu = need(f.gpu.raycast(f.camera, f.poses[i]));
      const double gpu_cast_took_ms = clock.lap_ms();
      const SurfaceView on_cpu = need(raycast(f.cpu.content(), f.camera, f.poses[i], f.executor));
      const double cpu_cast_took_ms = clock.lap_ms();
      times.different_pixels += different_pixels(on_gpu, on_cpu);
      const PointImage measured = to_points(f.images[i], f.camera, f.executor);
      const PointImage model = to_points(on_cpu, f.executor);
      clock.lap_ms();
      const IcpResult aligned = align(measured, model, f.camera, T_start, f.executor);
      const double cpu_align_took_ms = clock.lap_ms();
      const IcpResult gpu_aligned = need(aligner.align(measured, model, f.camera, T_start));
      const double gpu_align_took_ms = clock.lap_ms();
      const bool same = aligned.T_model_camera.matrix() == gpu_aligned.T_model_camera.matrix();
      times.different_alignments += same ? 0 : 1;
      if (round == 0 && !check.quick) continue;
      times.cpu_ms.push_back(cpu_took_ms);
      times.gpu_ms.push_back(gpu_took_ms);
      times.gpu_raycast_ms.push_back(gpu_cast_took_ms);
      times.cpu_raycast_ms.push_back(cpu_cast_took_ms);
      times.gpu_align_ms.push_back(gpu_align_took_ms);
      times.cpu_align_ms.push_back(cpu_align_took_ms);
    }
  }
  return times;
}

bool has_voxels(const BrickRef& brick) { return !brick.is_unknown() && brick.kind() != BrickKind::constant_free; }

/// Returns the bytes of the map that change from one state to the other, and those that have to be read for it. Of a
/// brick whose voxels differ, all are read; what changes is written, and its masks. Of any other, the entry.
double fused_bytes(const TsdfGrid& before, const TsdfGrid& after, const Executor& executor) {
  double bytes{0.0};
  for (const SectorBricks& some : changed_sectors(before, after, executor)) {
    const Sector* const was = before.find(some.sector);
    const Sector* const is = after.find(some.sector);
    some.bricks.for_each([&](std::size_t i) {
      const BrickRef old = was != nullptr ? was->bricks[i] : BrickRef{};
      const BrickRef& brick = is->bricks[i];
      bytes += kEntryBytes;
      if (!has_voxels(brick)) return;
      if (has_voxels(old)) bytes += kBrickVoxels * kVoxelBytes;
      for (int voxel = 0; voxel < kBrickVoxels; ++voxel)
        bytes += old.voxel(voxel) == brick.voxel(voxel) ? 0.0 : kVoxelBytes;
      bytes += kMaskBytes;
    });
  }
  return bytes;
}

/// Returns the number of voxels in which the surface of a view lies.
double voxels_hit(const SurfaceView& view, const PinholeCamera& camera, const Pose& T_world_camera, double voxel_m) {
  std::vector<Index3> hit;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double depth_m = view.depth.data()[static_cast<std::size_t>(v * camera.width + u)];
      if (depth_m <= 0.0) continue;
      const Eigen::Vector3d p_camera{(u - camera.cx) / camera.fx * depth_m, (v - camera.cy) / camera.fy * depth_m,
                                     depth_m};
      hit.push_back(voxel_at(T_world_camera * p_camera, voxel_m));
    }
  }
  const auto key = [](const Index3& i) { return std::array{i.z, i.y, i.x}; };
  std::sort(hit.begin(), hit.end(), [&](const Index3& a, const Index3& b) { return key(a) < key(b); });
  return static_cast<double>(std::unique(hit.begin(), hit.end()) - hit.begin());
}

/// Counts what a fused image and a ray cast move at least, on average over some images, which are fused once more.
void count_bytes(Frames& f, std::size_t images, LeastBytes& fusion, LeastBytes& raycasts) {
  for (std::size_t i = 0; i < images; ++i) {
    const TsdfSnapshot before = f.cpu.snapshot();
    need(f.cpu.integrate(f.camera, f.images[i], f.poses[i], f.executor));
    const GpuTraffic at_first = f.gpu.traffic();
    need(f.gpu.integrate(f.camera, f.images[i], f.poses[i]));
    const GpuTraffic fused = f.gpu.traffic();
    const SurfaceView view = need(f.gpu.raycast(f.camera, f.poses[i]));
    fusion += link_bytes(at_first, fused);
    raycasts += link_bytes(fused, f.gpu.traffic());
    // The image is written where it arrives, and read.
    fusion.memory += 2.0 * sizeof(float) * static_cast<double>(f.images[i].size()) +
                     fused_bytes(before.grid, f.cpu.content().grid, f.executor);
    // Depth and normals are written; of each voxel hit, the value is read.
    raycasts.memory +=
        (sizeof(float) + sizeof(Eigen::Vector3f)) * static_cast<double>(view.depth.size()) +
        sizeof(std::int16_t) * voxels_hit(view, f.camera, f.poses[i], f.cpu.content().config.voxel_size_m);
  }
  for (LeastBytes* const bytes : {&fusion, &raycasts}) {
    bytes->sent /= static_cast<double>(images);
    bytes->read /= static_cast<double>(images);
    bytes->memory /= static_cast<double>(images);
  }
}

}  // namespace

bool check_gpu_frames(const GpuCheck& check) {
  Frames f{.poses = every_nth_pose(check.quick ? 320 : 48),
           .images = {},
           .cpu = need(TsdfMap::create({})),
           .gpu = open(check, {})};
  for (const Pose& pose : f.poses) f.images.push_back(need(render(table(), f.camera, pose, f.executor)).depth);
  const FrameTimes times = time_frames(check, f);
  LeastBytes fusion;
  LeastBytes raycasts;
  count_bytes(f, check.quick ? 1 : f.poses.size(), fusion, raycasts);
  const bool equal = need(f.gpu.snapshot()).grid == f.cpu.content().grid;
  const double fusion_ms = median(times.gpu_ms);
  const double raycast_ms = median(times.gpu_raycast_ms);
  std::printf(" \"fusion\": {\"gpu_ms\": %.3f, %s, \"cpu_ms\": %.3f, \"frames\": %d, \"equal\": %s, %s},\n", fusion_ms,
              limit(fusion_ms, kAskedFusion_ms).c_str(), median(times.cpu_ms), times.frames, text_of(equal),
              share_of_rates(check.rates, fusion, fusion_ms).c_str());
  std::printf(" \"raycast\": {\"gpu_ms\": %.3f, %s, \"cpu_ms\": %.3f, \"different\": %d, %s},\n", raycast_ms,
              limit(raycast_ms, kAskedRaycast_ms).c_str(), median(times.cpu_raycast_ms), times.different_pixels,
              share_of_rates(check.rates, raycasts, raycast_ms).c_str());
  std::printf(" \"align\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"different\": %d},\n", median(times.gpu_align_ms),
              median(times.cpu_align_ms), times.different_alignments);
  return equal && times.different_pixels == 0 && times.different_alignments == 0;
}

}  // namespace saccade::bench
