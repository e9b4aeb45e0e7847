// SPDX-License-Identifier: Apache-2.0
#include "thesis/ray_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "saccade/map/ray_walk.hpp"
#include "saccade/views/sensor_rays.hpp"

namespace saccade::thesis {
namespace {

class ExactSearch final : public RaySearch {
 public:
  ExactSearch(const TsdfSnapshot& map, const StopVolume& volume)
      : box_{volume.box()}, sectors_{map.grid, {parent(parent(box_.lo)), parent(parent(box_.hi)) + Index3{1, 1, 1}}} {}

  [[nodiscard]] std::string_view name() const override { return "every ray, exactly"; }
  [[nodiscard]] std::optional<Index3> first_voxel(const LatticeRay& ray) const override {
    const auto hit = saccade::first_voxel(ray, clip(ray, box_), sectors_);
    if (!hit) return std::nullopt;
    return hit->voxel;
  }

 private:
  IndexBox box_;
  SectorTable sectors_;
};

class FixedStepSearch final : public RaySearch {
 public:
  FixedStepSearch(const StopVolume& volume, double step_vox)
      : volume_{volume}, step_vox_{static_cast<float>(step_vox)} {}

  [[nodiscard]] std::string_view name() const override { return "every ray, by a fixed step"; }
  [[nodiscard]] std::optional<Index3> first_voxel(const LatticeRay& ray) const override {
    const float length = std::hypot(ray.d[0], ray.d[1], ray.d[2]);
    const Index3 start = ray.origin - volume_.box().lo;
    const float from[3]{static_cast<float>(start.x) + ray.o[0], static_cast<float>(start.y) + ray.o[1],
                        static_cast<float>(start.z) + ray.o[2]};
    const float step[3]{ray.d[0] / length * step_vox_, ray.d[1] / length * step_vox_, ray.d[2] / length * step_vox_};
    const int steps = steps_within(from, step);
    for (int i = 0; i <= steps; ++i) {
      const auto t = static_cast<float>(i);
      const Index3 offset{static_cast<std::int32_t>(from[0] + t * step[0]),
                          static_cast<std::int32_t>(from[1] + t * step[1]),
                          static_cast<std::int32_t>(from[2] + t * step[2])};
      if (volume_.at_offset(offset) != Stop::no) return volume_.box().lo + offset;
    }
    return std::nullopt;
  }

 private:
  /// Returns the number of steps that stay within the volume, whatever the rounding.
  [[nodiscard]] int steps_within(const float (&from)[3], const float (&step)[3]) const {
    constexpr float kMargin_vox{1e-3F};
    const float size[3]{static_cast<float>(volume_.size().x), static_cast<float>(volume_.size().y),
                        static_cast<float>(volume_.size().z)};
    float most = std::numeric_limits<float>::max();
    for (int axis = 0; axis < 3; ++axis) {
      const float room = step[axis] > 0.0F ? size[axis] - from[axis] : from[axis];
      if (step[axis] != 0.0F) most = std::min(most, (room - kMargin_vox) / std::fabs(step[axis]));
    }
    return static_cast<int>(std::max(most, 0.0F));
  }

  const StopVolume& volume_;
  float step_vox_;
};

/// Calls visit(pixel ray) for every pixel of a view, row by row.
template <class Visit>
void for_each_ray(const Pose& T_world_camera, const PinholeCamera& sensor, double voxel_size_m,
                  const StopVolume& volume, const Visit& visit) {
  const SensorRays rays = sensor_rays(T_world_camera, voxel_size_m);
  SACCADE_EXPECTS(volume.box().contains(rays.origin.voxel));
  if (volume.at(rays.origin.voxel) != Stop::no) return;
  const PixelAxes axes = pixel_axes(sensor, rays.quarter_turns);
  for (const float b : axes.b) {
    for (const float a : axes.a) visit(rays.ray(a, b));
  }
}

/// Calls work(pose index), shared by the threads, and reports.
Status for_each_pose(std::string_view stage, std::size_t poses, const Executor& executor, const Progress& progress,
                     const std::function<void(std::size_t)>& work) {
  std::mutex report;
  std::size_t done{0};
  executor.parallel_for(poses, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (progress.cancelled()) return;
      work(i);
      const std::lock_guard lock{report};
      progress.report(stage, ++done, poses);
    }
  });
  if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", std::string{stage}};
  return {};
}

}  // namespace

std::unique_ptr<RaySearch> exact_search(const TsdfSnapshot& map, const StopVolume& volume) {
  return std::make_unique<ExactSearch>(map, volume);
}

std::unique_ptr<RaySearch> fixed_step_search(const StopVolume& volume, double step_vox) {
  SACCADE_EXPECTS(step_vox > 0.0);
  return std::make_unique<FixedStepSearch>(volume, step_vox);
}

std::size_t blocked_cameras(const StopVolume& volume, std::span<const Pose> T_world_camera, double voxel_size_m) {
  return static_cast<std::size_t>(std::count_if(T_world_camera.begin(), T_world_camera.end(), [&](const Pose& pose) {
    return volume.at(sensor_rays(pose, voxel_size_m).origin.voxel) != Stop::no;
  }));
}

Result<std::vector<std::uint64_t>> gains_of(const RaySearch& search, const StopVolume& volume,
                                            std::span<const Pose> T_world_camera, const PinholeCamera& sensor,
                                            double voxel_size_m, const Executor& executor, const Progress& progress) {
  std::vector<std::uint64_t> gains(T_world_camera.size());
  SACCADE_CHECK(for_each_pose(search.name(), gains.size(), executor, progress, [&](std::size_t pose) {
    std::uint64_t scored{0};
    for_each_ray(T_world_camera[pose], sensor, voxel_size_m, volume, [&](const LatticeRay& ray) {
      const auto voxel = search.first_voxel(ray);
      if (voxel && volume.at(*voxel) == Stop::scores) ++scored;
    });
    gains[pose] = scored;
  }));
  return gains;
}

Result<RayComparison> compare_rays(const RaySearch& search, const RaySearch& reference, const StopVolume& volume,
                                   std::span<const Pose> T_world_camera, const PinholeCamera& sensor,
                                   double voxel_size_m, const Executor& executor, const Progress& progress) {
  std::vector<RayComparison> of_poses(T_world_camera.size());
  SACCADE_CHECK(for_each_pose(search.name(), of_poses.size(), executor, progress, [&](std::size_t pose) {
    for_each_ray(T_world_camera[pose], sensor, voxel_size_m, volume, [&](const LatticeRay& ray) {
      const auto found = search.first_voxel(ray);
      const auto expected = reference.first_voxel(ray);
      RayComparison& tally = of_poses[pose];
      ++tally.rays;
      if (found == expected) return;
      ++tally.other_voxel;
      const bool scores = found && volume.at(*found) == Stop::scores;
      const bool should_score = expected && volume.at(*expected) == Stop::scores;
      if (scores != should_score) ++tally.other_score;
    });
  }));
  RayComparison all;
  for (const RayComparison& tally : of_poses) {
    all.rays += tally.rays;
    all.other_voxel += tally.other_voxel;
    all.other_score += tally.other_score;
  }
  return all;
}

}  // namespace saccade::thesis
