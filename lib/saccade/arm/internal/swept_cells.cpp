// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/swept_cells.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/arm/internal/obstacle_cells.hpp"
#include "saccade/arm/internal/sphere_tree.hpp"

namespace saccade {
namespace {

std::size_t number_of(const Index3& cell, const ObstacleCells& cells) {
  const Index3 from_corner = cell - cells.box().lo;
  const Index3 size = cells.size();
  return (static_cast<std::size_t>(from_corner.z) * static_cast<std::size_t>(size.y) +
          static_cast<std::size_t>(from_corner.y)) *
             static_cast<std::size_t>(size.x) +
         static_cast<std::size_t>(from_corner.x);
}

}  // namespace

SweptCells::SweptCells(const ArmCollision& collision, const ObstacleMap& obstacles, double margin_m)
    : collision_{collision}, obstacles_{obstacles}, margin_m_{margin_m} {
  const Index3 size = obstacles.cells().size();
  swept_.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z));
}

void SweptCells::add(const Configuration& q) {
  const ArmPoses poses = forward_kinematics(collision_.arm(), q);
  for (int link = 1; link <= collision_.arm().dof(); ++link) {
    const Pose& T_world_link = poses.T_world_link[static_cast<std::size_t>(link)];
    for (const SphereTree& cover : collision_.cover(link)) {
      const auto balls = cover.balls();
      for (std::uint32_t i = 0; i < balls.size();) {
        const TreeBall& ball = balls[i];
        const Eigen::Vector3d center = T_world_link * ball.center.cast<double>();
        const double radius_m = static_cast<double>(ball.radius_m) + margin_m_;
        if (obstacles_.distance_bound_m(center) > radius_m) {
          i = ball.next;
          continue;
        }
        if (ball.finest) add_cells(center, radius_m);
        ++i;
      }
    }
  }
}

void SweptCells::add(const Trajectory& trajectory) {
  const Configuration still = Configuration::Zero(collision_.arm().dof());
  for (const Trajectory::Piece& piece : trajectory.pieces()) {
    const Configuration last_speed = piece.speed + piece.duration_s * piece.acceleration;
    const Configuration fastest = piece.speed.cwiseAbs().cwiseMax(last_speed.cwiseAbs());
    const double travel_m = collision_.travel_bound_m(still, fastest) * piece.duration_s;
    const int steps = std::max(1, static_cast<int>(std::ceil(travel_m / kMargin_m)));
    for (int i = 0; i <= steps; ++i) {
      const double t_s = piece.duration_s * i / steps;
      add(piece.q + t_s * piece.speed + 0.5 * t_s * t_s * piece.acceleration);
    }
  }
}

void SweptCells::add_cells(const Eigen::Vector3d& center_world, double radius_m) {
  const ObstacleCells& cells = obstacles_.cells();
  const double edge_m = cells.cell_edge_m();
  const auto first = [&](Eigen::Index axis) {
    return static_cast<std::int32_t>(std::floor((center_world[axis] - radius_m) / edge_m));
  };
  const auto last = [&](Eigen::Index axis) {
    return static_cast<std::int32_t>(std::floor((center_world[axis] + radius_m) / edge_m)) + 1;
  };
  const IndexBox around{{first(0), first(1), first(2)}, {last(0), last(1), last(2)}};
  around.intersection(cells.box()).for_each([&](const Index3& cell) {
    if (!cells.is_obstacle(cell)) return;
    const Box box = cells.bounds_of(cell);
    const Eigen::Vector3d nearest = center_world.cwiseMax(box.min).cwiseMin(box.max);
    if ((nearest - center_world).norm() > radius_m) return;
    auto swept = swept_[number_of(cell, cells)];
    count_ += swept ? 0 : 1;
    swept = true;
  });
}

std::vector<Box> SweptCells::boxes() const {
  std::vector<Box> boxes;
  obstacles_.cells().box().for_each([&](const Index3& cell) {
    if (swept_[number_of(cell, obstacles_.cells())]) boxes.push_back(obstacles_.cells().bounds_of(cell));
  });
  return boxes;
}

}  // namespace saccade
