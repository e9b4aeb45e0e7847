// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/sensor_rays.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

Eigen::Vector3d snapped(const Eigen::Vector3d& axis) {
  constexpr double kSteps{16777216.0};
  return (axis * kSteps).unaryExpr([](double x) { return std::round(x) / kSteps; });
}

bool lexicographically_greater(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end());
}

bool equal(const float (&p)[3], const float (&q)[3]) { return p[0] == q[0] && p[1] == q[1] && p[2] == q[2]; }

float column_coordinate(const PinholeCamera& camera, int u) { return static_cast<float>((u - camera.cx) / camera.fx); }
float row_coordinate(const PinholeCamera& camera, int v) { return static_cast<float>((v - camera.cy) / camera.fy); }

std::vector<float> ascending(std::vector<float> values, bool negate) {
  if (negate) {
    std::reverse(values.begin(), values.end());
    for (float& value : values) value = -value;
  }
  return values;
}

}  // namespace

bool SensorRays::same_lattice(const SensorRays& other) const {
  return origin == other.origin && equal(x, other.x) && equal(y, other.y) && equal(z, other.z);
}

SensorRays sensor_rays(const Pose& T_world_camera, double voxel_size_m) {
  SensorRays rays;
  const Eigen::Vector3d center_vox = T_world_camera.translation() / voxel_size_m;
  rays.origin = lattice_point(center_vox.x(), center_vox.y(), center_vox.z());
  Eigen::Vector3d x = snapped(T_world_camera.linear().col(0));
  Eigen::Vector3d y = snapped(T_world_camera.linear().col(1));
  const Eigen::Vector3d z = snapped(T_world_camera.linear().col(2));
  Eigen::Vector3d best_x = x;
  Eigen::Vector3d best_y = y;
  for (int turns = 1; turns < 4; ++turns) {
    const Eigen::Vector3d turned_x = y;
    y = -x;
    x = turned_x;
    if (lexicographically_greater(x, best_x)) {
      best_x = x;
      best_y = y;
      rays.quarter_turns = turns;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    rays.x[axis] = static_cast<float>(best_x[axis] / voxel_size_m) + 0.0F;  // no negative zeros
    rays.y[axis] = static_cast<float>(best_y[axis] / voxel_size_m) + 0.0F;
    rays.z[axis] = static_cast<float>(z[axis] / voxel_size_m) + 0.0F;
  }
  return rays;
}

PixelAxes pixel_axes(const PinholeCamera& camera, int quarter_turns) {
  std::vector<float> columns;
  std::vector<float> rows;
  for (int u = 0; u < camera.width; ++u) columns.push_back(column_coordinate(camera, u));
  for (int v = 0; v < camera.height; ++v) rows.push_back(row_coordinate(camera, v));
  switch (quarter_turns) {
    case 0: return {columns, rows, camera.fx, camera.fy};
    case 1: return {rows, ascending(columns, true), camera.fy, camera.fx};
    case 2: return {ascending(columns, true), ascending(rows, true), camera.fx, camera.fy};
    default: return {ascending(rows, true), columns, camera.fy, camera.fx};
  }
}

LatticeRay pixel_ray(const SensorRays& rays, const PinholeCamera& camera, int u, int v) {
  const float a = column_coordinate(camera, u);
  const float b = row_coordinate(camera, v);
  switch (rays.quarter_turns) {
    case 0: return rays.ray(a, b);
    case 1: return rays.ray(b, -a);
    case 2: return rays.ray(-a, -b);
    default: return rays.ray(-b, a);
  }
}

}  // namespace saccade
