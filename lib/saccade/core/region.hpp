// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sphere, Box, Cylinder, and Region: any of them.

#include <Eigen/Core>
#include <variant>

#include "saccade/core/result.hpp"

namespace saccade {

/// Ball in the world frame. Contains p iff ‖c − p‖ < r, strictly (thesis eq. 2.6).
struct Sphere {
  Eigen::Vector3d center{Eigen::Vector3d::Zero()};
  double radius_m{0.0};
};

/// Axis-aligned box in the world frame. Contains p iff min ≤ p < max in every coordinate.
struct Box {
  Eigen::Vector3d min{Eigen::Vector3d::Zero()};
  Eigen::Vector3d max{Eigen::Vector3d::Zero()};
};

/// Solid cylinder around the segment base → top. Contains p iff p lies strictly within the radius of the axis and its
/// foot on the axis lies on [base, top).
struct Cylinder {
  Eigen::Vector3d base{Eigen::Vector3d::Zero()};
  Eigen::Vector3d top{Eigen::Vector3d::Zero()};
  double radius_m{0.0};
};

using Region = std::variant<Sphere, Box, Cylinder>;

[[nodiscard]] inline bool contains(const Sphere& sphere, const Eigen::Vector3d& p) {
  return (sphere.center - p).norm() < sphere.radius_m;
}
[[nodiscard]] inline bool contains(const Box& box, const Eigen::Vector3d& p) {
  return (p.array() >= box.min.array()).all() && (p.array() < box.max.array()).all();
}
[[nodiscard]] bool contains(const Cylinder& cylinder, const Eigen::Vector3d& p);
[[nodiscard]] bool contains(const Region& region, const Eigen::Vector3d& p);

/// Returns the smallest axis-aligned box around the region.
[[nodiscard]] Box bounds(const Region& region);

/// Share of a box of points that a region contains, judged without looking at the points.
enum class Overlap {
  none,     ///< no point of the closed box
  partial,  ///< undecided: some points, or in rare cases all or none
  whole,    ///< every point of the closed box
};
/// Agrees with contains() for every point, whatever its rounding. O(1).
[[nodiscard]] Overlap overlap(const Sphere& sphere, const Box& closed_box);
[[nodiscard]] Overlap overlap(const Box& box, const Box& closed_box);
[[nodiscard]] Overlap overlap(const Cylinder& cylinder, const Box& closed_box);
[[nodiscard]] Overlap overlap(const Region& region, const Box& closed_box);

/// Answers invalid_argument when a number is not finite, or a size is zero or negative.
[[nodiscard]] Status validate(const Region& region);

}  // namespace saccade
