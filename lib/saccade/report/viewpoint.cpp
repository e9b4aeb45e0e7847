// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/viewpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade {

namespace {

/// Along one picture axis: how near the camera may come, and where it must stand, so that |x − at| ≤ tangent · (z −
/// near) for all points.
struct Fit {
  double near;
  double at;
};
Fit fit(std::span<const Eigen::Vector3d> points, int axis, double tangent) {
  double right{-std::numeric_limits<double>::infinity()};
  double left{right};
  for (const Eigen::Vector3d& p : points) {
    right = std::max(right, p[axis] - tangent * p.z());
    left = std::max(left, -p[axis] - tangent * p.z());
  }
  return {-(right + left) / (2.0 * tangent), (right - left) / 2.0};
}

}  // namespace

double azimuth_towards(const Eigen::Vector3d& towards_viewer, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond world_up = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  const Eigen::Vector3d level = world_up.inverse() * towards_viewer;
  return level.head<2>().norm() > 1e-6 ? std::atan2(level.y(), level.x()) : OverviewConfig{}.azimuth_rad;
}

Viewpoint overview_of(std::span<const Eigen::Vector3d> points_world, const OverviewConfig& config) {
  SACCADE_EXPECTS(config.width > 0 && config.height > 0 && !points_world.empty());
  Viewpoint view;
  PinholeCamera& camera = view.camera;
  camera.width = config.width;
  camera.height = config.height;
  camera.fx = camera.fy = std::min(config.width, config.height) / 2.0 / std::tan(config.field_of_view_rad / 2.0);
  camera.cx = (config.width - 1) / 2.0;
  camera.cy = (config.height - 1) / 2.0;
  camera.min_range_m = 1e-3;
  camera.max_range_m = 1e3;

  const Eigen::Quaterniond world_up = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), config.up);
  const Eigen::Vector3d from_scene{std::cos(config.elevation_rad) * std::cos(config.azimuth_rad),
                                   std::cos(config.elevation_rad) * std::sin(config.azimuth_rad),
                                   std::sin(config.elevation_rad)};
  view.T_world_camera = look_at(world_up * from_scene, Eigen::Vector3d::Zero(), config.up);
  const Eigen::Matrix3d R = view.T_world_camera.linear();
  std::vector<Eigen::Vector3d> turned;
  for (const Eigen::Vector3d& p_world : points_world) turned.emplace_back(R.transpose() * p_world);
  constexpr double kMargin{0.93};  // share of the picture's half width
  const Fit x = fit(turned, 0, kMargin * config.width / 2.0 / camera.fx);
  const Fit y = fit(turned, 1, kMargin * config.height / 2.0 / camera.fy);
  constexpr double kNearest{0.05};
  view.T_world_camera.translation() = R * Eigen::Vector3d{x.at, y.at, std::min(x.near, y.near) - kNearest};
  return view;
}

std::vector<Eigen::Vector3d> corners_of(const Box& box) {
  std::vector<Eigen::Vector3d> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1U) != 0 ? box.max.x() : box.min.x(), (i & 2U) != 0 ? box.max.y() : box.min.y(),
                         (i & 4U) != 0 ? box.max.z() : box.min.z());
  }
  return corners;
}

Viewpoint overview_of(const Box& box, const OverviewConfig& config) { return overview_of(corners_of(box), config); }

}  // namespace saccade
