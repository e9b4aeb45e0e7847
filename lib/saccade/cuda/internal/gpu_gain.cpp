// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/gpu_gain.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>
#include <vector>

#include "saccade/core/clock.hpp"
#include "saccade/views/internal/gain_problem.hpp"

namespace saccade::internal::cuda {
namespace {

Result<RegionShape> shape_of(const Region& region) {
  RegionShape shape;
  if (const auto* sphere = std::get_if<Sphere>(&region)) {
    shape.kind = RegionShape::Kind::sphere;
    std::copy_n(sphere->center.data(), 3, shape.a);
    shape.b[0] = sphere->radius_m;
    return shape;
  }
  if (const auto* box = std::get_if<Box>(&region)) {
    shape.kind = RegionShape::Kind::box;
    std::copy_n(box->min.data(), 3, shape.a);
    std::copy_n(box->max.data(), 3, shape.b);
    return shape;
  }
  return Error{Errc::unsupported, "the GPU evaluates views of spheres and boxes; use the CPU for a cylinder", "cuda"};
}

/// Coordinates of all columns and rows by quarter turns, and where each begins in one array.
class Coordinates {
 public:
  Coordinates(const PinholeCamera& sensor, std::vector<float>& all) {
    for (int turns = 0; turns < 4; ++turns) {
      PixelAxes& axes = axes_[static_cast<std::size_t>(turns)];
      axes = pixel_axes(sensor, turns);
      first_[static_cast<std::size_t>(turns)] = all.size();
      all.insert(all.end(), axes.a.begin(), axes.a.end());
      all.insert(all.end(), axes.b.begin(), axes.b.end());
    }
  }
  [[nodiscard]] const PixelAxes& axes(int turns) const { return axes_[static_cast<std::size_t>(turns)]; }
  /// Writes where a window's coordinates lie.
  void locate(const CastWindow& cast, GainWindow& window) const {
    const auto turns = static_cast<std::size_t>(cast.rays.quarter_turns);
    const PixelAxes& axes = axes_[turns];
    window.first_a =
        static_cast<std::uint32_t>(first_[turns] + static_cast<std::size_t>(cast.a.data() - axes.a.data()));
    window.first_b = static_cast<std::uint32_t>(first_[turns] + axes.a.size() +
                                                static_cast<std::size_t>(cast.b.data() - axes.b.data()));
  }

 private:
  std::array<PixelAxes, 4> axes_;
  std::array<std::size_t, 4> first_{};
};

GainWindow window_on_device(const CastWindow& cast, const Coordinates& coordinates, const Region& region,
                            double voxel_size_m) {
  GainWindow window{};
  const SensorRays& rays = cast.rays;
  window.origin = rays.origin;
  std::copy_n(rays.x, 3, window.x);
  std::copy_n(rays.y, 3, window.y);
  std::copy_n(rays.z, 3, window.z);
  if (const auto* sphere = std::get_if<Sphere>(&region)) {
    const LatticePoint& o = rays.origin;
    const Eigen::Vector3d origin_vox{o.voxel.x + static_cast<double>(o.fraction[0]),
                                     o.voxel.y + static_cast<double>(o.fraction[1]),
                                     o.voxel.z + static_cast<double>(o.fraction[2])};
    const Eigen::Vector3f to_center = (sphere->center / voxel_size_m - origin_vox).cast<float>();
    std::copy_n(to_center.data(), 3, window.to_center);
  }
  coordinates.locate(cast, window);
  window.columns = static_cast<std::uint32_t>(cast.a.size());
  window.rows = static_cast<std::uint32_t>(cast.b.size());
  return window;
}

constexpr std::uint64_t kMostTiles{std::numeric_limits<std::int32_t>::max()};

GainWindows windows_of(const TsdfConfig& map, const Region& region, std::span<const Pose> poses,
                       const PinholeCamera& sensor, const IndexBox& region_voxels, const Executor& executor) {
  GainWindows found;
  const Coordinates coordinates{sensor, found.coordinates};
  const double reach = longest_ray_vox(sensor, map.voxel_size_m);
  std::vector<CastWindow> casts(poses.size());
  constexpr std::size_t kPosesAtATime{32};
  executor.parallel_for(poses.size(), kPosesAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SensorRays rays = sensor_rays(poses[i], map.voxel_size_m);
      if (!within_reach(rays.origin.voxel, region_voxels, reach)) continue;
      casts[i] = window_of(rays, coordinates.axes(rays.quarter_turns), region_voxels, region, map.voxel_size_m);
    }
  });
  std::unordered_map<LatticeKey, std::vector<std::size_t>, LatticeHash> known;  // windows by lattice
  std::vector<std::size_t> first_pose;                                          // first pose of each window
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (casts[i].empty()) continue;
    std::vector<std::size_t>& same_lattice = known[key_of(casts[i].rays)];
    const auto same = std::find_if(same_lattice.begin(), same_lattice.end(),
                                   [&](std::size_t window) { return casts[first_pose[window]].same_rays(casts[i]); });
    if (same != same_lattice.end()) {
      found.poses[*same].push_back(i);
      continue;
    }
    same_lattice.push_back(found.windows.size());
    first_pose.push_back(i);
    found.poses.push_back({i});
    GainWindow& window = found.windows.emplace_back(window_on_device(casts[i], coordinates, region, map.voxel_size_m));
    window.first_tile = static_cast<std::uint32_t>(found.tiles);
    found.tiles +=
        std::uint64_t{(window.columns + kTileColumns - 1) / kTileColumns} * ((window.rows + kTileRows - 1) / kTileRows);
    if (found.tiles > kMostTiles) break;  // refused by the caller
    while (found.first_windows.size() * kTilesPerHint < found.tiles)
      found.first_windows.push_back(static_cast<std::uint32_t>(found.windows.size() - 1));
  }
  return found;
}

}  // namespace

Status check_gains(const Region& region, const GainConfig& config) {
  if (config.count != GainCount::rays) {
    return Error{Errc::unsupported, "the GPU counts rays; use the CPU to count distinct voxels", "cuda"};
  }
  if (const auto shape = shape_of(region); !shape.ok()) return shape.error();
  return {};
}

Result<GainTask> prepare_gains(const TsdfConfig& map, const Region& region, std::span<const Pose> T_world_camera,
                               const GainConfig& config, const Executor& executor) {
  const Stopwatch stopwatch;
  SACCADE_CHECK(check_evaluation(map, region, T_world_camera, config));
  SACCADE_CHECK(check_gains(region, config));
  const PinholeCamera sensor = widened_vertically(config.sensor, config.tilt_rad);
  GainTask task;
  task.poses = T_world_camera.size();
  task.rays_total = std::uint64_t{T_world_camera.size()} * static_cast<std::uint64_t>(sensor.width) *
                    static_cast<std::uint64_t>(sensor.height);
  GainArguments& a = task.arguments;
  SACCADE_TRY(a.region, shape_of(region));
  constexpr double kHalfDiagonal_vox{0.8660254037844387};
  constexpr double kSlack_vox{0.05};
  a.radius_vox = static_cast<float>(a.region.b[0] / map.voxel_size_m + kHalfDiagonal_vox + kSlack_vox);
  a.region_voxels = region_in_workspace(region, map);
  a.has_workspace = map.workspace.has_value();
  if (a.has_workspace) a.workspace = voxels_with_center_in(*map.workspace, map.voxel_size_m);
  a.unknown_blocks = config.unknown_outside == UnknownOutside::blocks;
  a.voxel_size_m = map.voxel_size_m;
  a.min_t = static_cast<float>(sensor.min_range_m);
  a.max_t = static_cast<float>(sensor.max_range_m);
  if (!a.region_voxels.empty()) {
    task.windows = windows_of(map, region, T_world_camera, sensor, a.region_voxels, executor);
  }
  if (task.windows.tiles > kMostTiles) {
    return Error{Errc::unsupported, "too many rays for one evaluation on the GPU; evaluate fewer poses at a time",
                 "cuda"};
  }
  task.prepare_ms = stopwatch.elapsed_ms();
  return task;
}

Result<GainResult> GpuGain::count(const GainTask& task, BrickStore& bricks) {
  const Stopwatch stopwatch;
  const GainWindows& windows = task.windows;
  GainResult result;
  result.gains.assign(task.poses, 0);
  result.rays_total = task.rays_total;
  result.prepare_ms = task.prepare_ms;
  if (windows.windows.empty()) return result;
  GainArguments a = task.arguments;
  SACCADE_CHECK(windows_.assign(windows.windows));
  SACCADE_CHECK(first_windows_.assign(windows.first_windows));
  SACCADE_CHECK(coordinates_.assign(windows.coordinates));
  SACCADE_CHECK(gains_.reserve(windows.windows.size()));
  SACCADE_CHECK(gains_.fill(0, windows.windows.size()));
  a.windows = windows_.data();
  a.first_windows = first_windows_.data();
  a.window_count = static_cast<std::uint32_t>(windows.windows.size());
  a.coordinates = coordinates_.data();
  a.gains = gains_.data();
  SACCADE_CHECK(bricks.mark_blocks());
  a.map = bricks.view();
  SACCADE_CHECK(launch<CountScoringRays>(compute_, windows.tiles, a));
  std::vector<std::uint64_t> gains(windows.windows.size());
  SACCADE_CHECK(gains_.read(gains));
  for (std::size_t i = 0; i < gains.size(); ++i) {
    result.rays_cast += std::uint64_t{windows.windows[i].columns} * windows.windows[i].rows;
    for (const std::size_t pose : windows.poses[i]) result.gains[pose] = gains[i];
  }
  result.evaluate_ms = stopwatch.elapsed_ms();
  return result;
}

void GpuGain::free_buffers() noexcept {
  windows_.free();
  first_windows_.free();
  coordinates_.free();
  gains_.free();
}

}  // namespace saccade::internal::cuda
