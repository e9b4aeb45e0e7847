// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/split_polygon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

using Point = Eigen::Vector2d;

/// Projects the corners along the axis nearest to the face's normal, so that they run counter-clockwise.
std::vector<Point> flatten(std::span<const Eigen::Vector3f> vertices, std::span<const std::uint32_t> corners) {
  const Eigen::Vector3d origin = vertices[corners[0]].cast<double>();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // Newell's
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d a = vertices[corners[i]].cast<double>() - origin;
    const Eigen::Vector3d b = vertices[corners[(i + 1) % corners.size()]].cast<double>() - origin;
    normal += a.cross(b);
  }
  Eigen::Index axis{0};
  normal.cwiseAbs().maxCoeff(&axis);
  const Eigen::Index u = (axis + 1) % 3;
  const Eigen::Index v = (axis + 2) % 3;
  const bool turned = normal[axis] < 0.0;
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const Eigen::Vector3d p = vertices[corner].cast<double>() - origin;
    points.emplace_back(turned ? p[v] : p[u], turned ? p[u] : p[v]);
  }
  return points;
}

/// Twice the area of abc, positive where it runs counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a;
  const Point ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

bool is_convex(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0.0) return false;
  }
  return true;
}

/// The corners that are left of a face, and the search for its next ear.
class Ears {
 public:
  explicit Ears(const std::vector<Point>& points) : points_{points} {
    for (std::size_t i = 0; i < points.size(); ++i) left_.push_back(i);
  }
  [[nodiscard]] std::size_t left() const { return left_.size(); }
  [[nodiscard]] std::size_t corner(std::size_t i) const { return left_[i % left_.size()]; }

  /// Returns the place before the next ear's tip; left() where there is no ear.
  [[nodiscard]] std::size_t find() {
    for (std::size_t tried = 0; tried < left_.size(); ++tried) {
      const std::size_t i = (begin_ + tried) % left_.size();
      if (is_ear(i)) return i;
    }
    return left_.size();
  }
  void cut(std::size_t before) {
    const std::size_t tip = (before + 1) % left_.size();
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(tip));
    begin_ = tip % left_.size();
  }

 private:
  [[nodiscard]] bool is_ear(std::size_t i) const {
    const Point& a = points_[corner(i)];
    const Point& b = points_[corner(i + 1)];
    const Point& c = points_[corner(i + 2)];
    if (turn(a, b, c) <= 0.0) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::size_t other) {
      const Point& p = points_[other];
      if (p == a || p == b || p == c) return false;
      return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
    });
  }

  const std::vector<Point>& points_;
  std::vector<std::size_t> left_;
  std::size_t begin_{0};
};

}  // namespace

bool split_polygon(std::span<const Eigen::Vector3f> vertices, std::span<const std::uint32_t> corners,
                   std::vector<std::array<std::uint32_t, 3>>& triangles) {
  if (corners.size() < 3) return true;
  if (corners.size() == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return true;
  }
  const std::vector<Point> points = flatten(vertices, corners);
  if (is_convex(points)) {
    for (std::size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
    return true;
  }
  if (corners.size() > kMostConcaveCorners) return false;
  Ears ears{points};
  while (ears.left() > 3) {
    const std::size_t before = ears.find();
    if (before == ears.left()) break;  // it crosses itself
    triangles.push_back(
        {corners[ears.corner(before)], corners[ears.corner(before + 1)], corners[ears.corner(before + 2)]});
    ears.cut(before);
  }
  for (std::size_t i = 2; i < ears.left(); ++i) {
    triangles.push_back({corners[ears.corner(0)], corners[ears.corner(i - 1)], corners[ears.corner(i)]});
  }
  return true;
}

}  // namespace saccade
