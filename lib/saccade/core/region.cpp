// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/region.hpp"

#include <cmath>

namespace saccade {
namespace {

Box bounds_of(const Sphere& s) {
  const Eigen::Vector3d r = Eigen::Vector3d::Constant(s.radius_m);
  return {s.center - r, s.center + r};
}
Box bounds_of(const Box& b) { return b; }
Box bounds_of(const Cylinder& c) {
  const Eigen::Vector3d axis = (c.top - c.base).normalized();
  const Eigen::Vector3d r = c.radius_m * (Eigen::Vector3d::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  return {c.base.cwiseMin(c.top) - r, c.base.cwiseMax(c.top) + r};
}

Status check(bool finite, bool positive) {
  if (!finite) return Error{Errc::invalid_argument, "the region contains NaN or infinity", {}};
  if (!positive) return Error{Errc::invalid_argument, "the region's size must be positive", {}};
  return {};
}
Status check(const Sphere& s) { return check(s.center.allFinite() && std::isfinite(s.radius_m), s.radius_m > 0.0); }
Status check(const Box& b) {
  return check(b.min.allFinite() && b.max.allFinite(), (b.max.array() > b.min.array()).all());
}
Status check(const Cylinder& c) {
  return check(c.base.allFinite() && c.top.allFinite() && std::isfinite(c.radius_m),
               c.radius_m > 0.0 && (c.top - c.base).norm() > 0.0);
}

/// Slack in metres: above the rounding of contains(), below any voxel.
constexpr double kSlackM{1e-9};

}  // namespace

bool contains(const Cylinder& cylinder, const Eigen::Vector3d& p) {
  const Eigen::Vector3d axis = cylinder.top - cylinder.base;
  const Eigen::Vector3d q = p - cylinder.base;
  const double s = q.dot(axis) / axis.squaredNorm();
  return s >= 0.0 && s < 1.0 && (q - s * axis).norm() < cylinder.radius_m;
}

bool contains(const Region& region, const Eigen::Vector3d& p) {
  return std::visit([&](const auto& shape) { return contains(shape, p); }, region);
}

Box bounds(const Region& region) {
  return std::visit([](const auto& shape) { return bounds_of(shape); }, region);
}

Overlap overlap(const Sphere& sphere, const Box& box) {
  const Eigen::Vector3d below = box.min - sphere.center;
  const Eigen::Vector3d above = sphere.center - box.max;
  const double nearest_m = below.cwiseMax(above).cwiseMax(0.0).norm();
  const double farthest_m = below.cwiseAbs().cwiseMax(above.cwiseAbs()).norm();
  if (nearest_m > sphere.radius_m + kSlackM) return Overlap::none;
  return farthest_m < sphere.radius_m - kSlackM ? Overlap::whole : Overlap::partial;
}

Overlap overlap(const Box& region, const Box& box) {
  if ((box.max.array() < region.min.array()).any() || (box.min.array() >= region.max.array()).any()) {
    return Overlap::none;
  }
  return contains(region, box.min) && contains(region, box.max) ? Overlap::whole : Overlap::partial;
}

/// Tests the ball around the box.
Overlap overlap(const Cylinder& cylinder, const Box& box) {
  const Eigen::Vector3d axis = cylinder.top - cylinder.base;
  const double length_m = axis.norm();
  const double radius_m = 0.5 * (box.max - box.min).norm() + kSlackM;
  const Eigen::Vector3d q = 0.5 * (box.min + box.max) - cylinder.base;
  const double along_m = q.dot(axis) / length_m;
  const double from_axis_m = (q - along_m / length_m * axis).norm();
  if (along_m < -radius_m || along_m > length_m + radius_m || from_axis_m > cylinder.radius_m + radius_m) {
    return Overlap::none;
  }
  const bool whole = along_m > radius_m && along_m < length_m - radius_m && from_axis_m < cylinder.radius_m - radius_m;
  return whole ? Overlap::whole : Overlap::partial;
}

Overlap overlap(const Region& region, const Box& closed_box) {
  return std::visit([&](const auto& shape) { return overlap(shape, closed_box); }, region);
}

Status validate(const Region& region) {
  return std::visit([](const auto& shape) { return check(shape); }, region);
}

}  // namespace saccade
