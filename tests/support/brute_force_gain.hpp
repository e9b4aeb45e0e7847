// SPDX-License-Identifier: Apache-2.0
#pragma once
// brute_force_gain: eq. 2.10 read aloud: every pixel, voxel by voxel, no savings. Reference for evaluate_views.

#include <limits>
#include <set>
#include <tuple>

#include "saccade/views/sensor_rays.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade::test {

class BruteForceGain {
 public:
  BruteForceGain(const TsdfSnapshot& map, const Region& region, const GainConfig& config)
      : map_{map},
        region_{region},
        config_{config},
        sensor_{widened_vertically(config.sensor, config.tilt_rad)},
        voxel_size_m_{map.config.voxel_size_m} {}

  std::uint64_t operator()(const Pose& T_world_camera) const {
    const SensorRays rays = sensor_rays(T_world_camera, voxel_size_m_);
    std::uint64_t hits{0};
    std::set<std::tuple<int, int, int>> voxels;
    for (int v = 0; v < sensor_.height; ++v) {
      for (int u = 0; u < sensor_.width; ++u) {
        Index3 voxel;
        if (!scores(pixel_ray(rays, sensor_, u, v), voxel)) continue;
        ++hits;
        voxels.emplace(voxel.x, voxel.y, voxel.z);
      }
    }
    return config_.count == GainCount::rays ? hits : voxels.size();
  }

  /// Tells whether a single ray scores.
  [[nodiscard]] bool scores(const LatticeRay& ray) const {
    Index3 voxel;
    return scores(ray, voxel);
  }

 private:
  enum class Meets { nothing, blocker, scoring };

  [[nodiscard]] Meets at(const Index3& voxel) const {
    const Eigen::Vector3d center = voxel_center(voxel, voxel_size_m_);
    if (map_.config.workspace && !contains(*map_.config.workspace, center)) return Meets::nothing;
    switch (map_.grid.state(voxel)) {
      case VoxelState::empty: return Meets::nothing;
      case VoxelState::occupied: return Meets::blocker;
      case VoxelState::unknown: break;
    }
    if (contains(region_, center)) return Meets::scoring;
    return config_.unknown_outside == UnknownOutside::blocks ? Meets::blocker : Meets::nothing;
  }

  bool scores(const LatticeRay& ray, Index3& voxel) const {
    std::int32_t p[3]{0, 0, 0};
    float depth{-1.0F};  // the camera's own voxel is not entered
    for (;;) {
      voxel = ray.origin + Index3{p[0], p[1], p[2]};
      const Meets met = at(voxel);
      if (met != Meets::nothing) return met == Meets::scoring && depth >= static_cast<float>(sensor_.min_range_m);
      int next{-1};
      float t_next{std::numeric_limits<float>::infinity()};
      for (int axis = 0; axis < 3; ++axis) {
        if (ray.d[axis] == 0.0F) continue;
        const int plane = ray.d[axis] > 0.0F ? p[axis] + 1 : p[axis];
        const float t = (static_cast<float>(plane) - ray.o[axis]) * (1.0F / ray.d[axis]);
        if (t < t_next) {
          t_next = t;
          next = axis;
        }
      }
      if (t_next > static_cast<float>(sensor_.max_range_m)) return false;
      p[next] += ray.d[next] > 0.0F ? 1 : -1;
      depth = t_next;
    }
  }

  const TsdfSnapshot& map_;
  const Region& region_;
  const GainConfig& config_;
  PinholeCamera sensor_;
  double voxel_size_m_;
};

}  // namespace saccade::test
