// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/label_boxes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "saccade/core/convex_hull.hpp"
#include "saccade/core/result.hpp"

namespace saccade {
namespace {

constexpr double kInfinite{std::numeric_limits<double>::infinity()};

/// Directions of the ground plane and up: x of the cloud, or y where x is vertical, made horizontal; and what is left
/// of it.
Eigen::Matrix3d ground_axes(const Eigen::Vector3d& up) {
  constexpr double kVertical{0.9};
  const Eigen::Vector3d along = std::abs(up.x()) < kVertical ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix3d axes;
  axes.col(2) = up;
  axes.col(0) = (along - along.dot(up) * up).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

struct Rectangle {
  Eigen::Vector2d direction{Eigen::Vector2d::UnitX()};  ///< along its length
  Eigen::Vector2d center{Eigen::Vector2d::Zero()};
  Eigen::Vector2d size{Eigen::Vector2d::Zero()};  ///< length, width
};

Rectangle around(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& direction) {
  const Eigen::Vector2d across{-direction.y(), direction.x()};
  Eigen::Array2d low{kInfinite, kInfinite};
  Eigen::Array2d high{-kInfinite, -kInfinite};
  for (const Eigen::Vector2d& corner : hull) {
    const Eigen::Array2d at{corner.dot(direction), corner.dot(across)};
    low = low.min(at);
    high = high.max(at);
  }
  const Eigen::Array2d middle = 0.5 * (low + high);
  return {direction, middle.x() * direction + middle.y() * across, (high - low).matrix()};
}

/// Returns the rectangle of least area: one of its sides lies along an edge of the hull.
Rectangle least_rectangle(const std::vector<Eigen::Vector2d>& hull) {
  Rectangle best = around(hull, Eigen::Vector2d::UnitX());
  for (std::size_t i = 0; hull.size() > 1 && i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    if (edge.norm() == 0.0) continue;
    const Rectangle made = around(hull, edge.normalized());
    if (made.size.prod() < best.size.prod()) best = made;
  }
  if (best.size.x() < best.size.y()) {
    best.direction = {-best.direction.y(), best.direction.x()};
    best.size = best.size.reverse().eval();
  }
  const bool is_backwards = best.direction.x() < 0.0 || (best.direction.x() == 0.0 && best.direction.y() < 0.0);
  if (is_backwards) best.direction = -best.direction;
  return best;
}

struct LabelPoints {
  std::vector<Eigen::Vector2d> ground;
  double lowest{kInfinite};
  double highest{-kInfinite};
};

}  // namespace

std::vector<LabelBox> label_boxes(std::span<const Eigen::Vector3f> positions_m, std::span<const std::uint32_t> labels,
                                  const Eigen::Vector3d& up) {
  SACCADE_EXPECTS(positions_m.size() == labels.size());
  const Eigen::Matrix3d ground = ground_axes(up);
  std::map<std::uint32_t, LabelPoints> points_of;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0 || !positions_m[i].allFinite()) continue;
    const Eigen::Vector3d p = ground.transpose() * positions_m[i].cast<double>();
    LabelPoints& points = points_of[labels[i]];
    points.ground.emplace_back(p.head<2>());
    points.lowest = std::min(points.lowest, p.z());
    points.highest = std::max(points.highest, p.z());
  }
  std::vector<LabelBox> boxes;
  for (auto& [label, points] : points_of) {
    LabelBox box{label, points.ground.size()};
    const Rectangle rectangle = least_rectangle(convex_hull(std::move(points.ground)));
    box.size_m << rectangle.size, points.highest - points.lowest;
    box.center_m =
        ground * Eigen::Vector3d{rectangle.center.x(), rectangle.center.y(), 0.5 * (points.lowest + points.highest)};
    box.axes.col(0) = ground.leftCols<2>() * rectangle.direction;
    box.axes.col(2) = up;
    box.axes.col(1) = box.axes.col(2).cross(box.axes.col(0));
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace saccade
