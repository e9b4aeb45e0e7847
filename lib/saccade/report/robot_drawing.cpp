// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/robot_drawing.hpp"

#include <cmath>

#include "saccade/core/angle.hpp"
#include "saccade/report/internal/blend.hpp"
#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/mesh_picture.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kPath{20, 118, 196};
constexpr double kLine_px{2.4};
constexpr double kStart_px{8.0};
constexpr double kHiddenPath{0.4};

void draw_arm(Canvas& canvas, const RobotDrawing& robot, const Executor& executor) {
  if (robot.arm.triangles.empty() || robot.opacity <= 0.0) return;
  const ColorImage behind = robot.opacity < 1.0 ? canvas.samples() : ColorImage{};
  const Image<float> before = robot.opacity < 1.0 ? canvas.sample_depth() : Image<float>{};
  draw_mesh(canvas, robot.arm, executor);
  for (std::size_t i = 0; i < behind.size(); ++i) {
    Rgb8& sample = canvas.samples().data()[i];
    if (canvas.sample_depth().data()[i] < before.data()[i]) {
      sample = blend(behind.data()[i], sample, robot.opacity);
    }
  }
}

}  // namespace

void draw_robot(Canvas& canvas, const RobotDrawing& robot, const Executor& executor) {
  SACCADE_EXPECTS(robot.opacity >= 0.0 && robot.opacity <= 1.0);
  draw_arm(canvas, robot, executor);
  const auto& path = robot.p_world_path;
  for (std::size_t i = 1; i < path.size(); ++i) canvas.line(path[i - 1], path[i], {kPath, kLine_px, kHiddenPath});
  if (!path.empty()) canvas.point(path.front(), kStart_px, kPath, kHiddenPath);
}

Rgb8 path_color() { return kPath; }

double azimuth_beside(const Eigen::Vector3d& p_world_base, const Eigen::Vector3d& p_world_middle, double azimuth_rad) {
  constexpr double kApart{125_deg};
  const Eigen::Vector3d to_base = p_world_base - p_world_middle;
  if (to_base.head<2>().norm() < 1e-6) return azimuth_rad;
  const double base_rad = std::atan2(to_base.y(), to_base.x());
  const double turn_rad = std::remainder(azimuth_rad - base_rad, 360_deg);
  return std::fabs(turn_rad) >= kApart ? azimuth_rad : base_rad + std::copysign(kApart, turn_rad);
}

Viewpoint overview_with(const RobotDrawing* robot, std::vector<Eigen::Vector3d> points_world,
                        const Eigen::Vector3d& p_world_middle, OverviewConfig config) {
  if (robot != nullptr) {
    if (robot->p_world_base) {
      config.azimuth_rad = azimuth_beside(*robot->p_world_base, p_world_middle, config.azimuth_rad);
    }
  }
  return overview_of(points_world, config);
}

}  // namespace saccade
