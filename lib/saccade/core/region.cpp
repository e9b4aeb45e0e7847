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

}  // namespace

bool contains(const Sphere& sphere, const Eigen::Vector3d& p) { return (sphere.center - p).norm() < sphere.radius_m; }

bool contains(const Box& box, const Eigen::Vector3d& p) {
  return (p.array() >= box.min.array()).all() && (p.array() < box.max.array()).all();
}

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

Status validate(const Region& region) {
  return std::visit([](const auto& shape) { return check(shape); }, region);
}

}  // namespace saccade
