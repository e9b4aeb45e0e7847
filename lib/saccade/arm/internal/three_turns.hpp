// SPDX-License-Identifier: Apache-2.0
#pragma once
// ThreeTurns: the angles of three joints about axes through one point that produce a given rotation.

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "saccade/arm/internal/joint_axes.hpp"

namespace saccade {

/// Solver for the wrist of most arms, or the shoulder of arms with seven joints.
///
/// R = R_a R_b R_c takes axis c to u = R c. The angle between a and u is a side of the axes' triangle on the sphere,
/// which gives the second joint's angle. The first joint brings axis c to u, and the third adds the remaining rotation.
///
/// Where axes a and c are collinear, only the sum or difference of the outer angles counts. The caller then gives the
/// first and the third follows; the first deviates as far as the third's limits require.
/// caller says and the third follows; the first gives way as far as the third's limits need it.
class ThreeTurns {
 public:
  ThreeTurns() = default;
  /// Takes joints `first` to `first` + 2, whose neighbouring axes must not be parallel.
  ThreeTurns(const JointAxes& axes, std::size_t first);

  struct Solutions {
    std::array<Eigen::Vector3d, 2> q;  ///< rad; the first `count` are set
    std::size_t count{0};
  };
  /// Returns all solutions in which every angle, up to whole turns, is within its limits; coinciding solutions once.
  [[nodiscard]] Solutions solve(const Eigen::Matrix3d& R, double first_if_free) const;

 private:
  [[nodiscard]] bool allow(std::size_t joint, double angle_rad) const;
  void give_way(double sign, Eigen::Vector3d& q) const;

  std::array<Eigen::Vector3d, 3> axis_;
  std::array<double, 3> lower_{};
  std::array<double, 3> upper_{};
  double alpha_{0.0}, beta_{0.0};  // angles between the first and second, second and third axes
  double phi_{0.0};                // second angle at which the three axes lie in a plane
  Eigen::Vector3d across_;         // unit, across the third axis
};

}  // namespace saccade
