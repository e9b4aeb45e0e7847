// SPDX-License-Identifier: Apache-2.0
#pragma once
// SphericalShoulder: closed-form inverse kinematics of six revolute joints, the first three about axes through one
// point, the last two about axes through another.

#include <Eigen/Core>

#include "saccade/arm/internal/elbow_triangle.hpp"
#include "saccade/arm/internal/three_turns.hpp"

namespace saccade {

/// Solver for six joints whose axes 1, 2 and 3 meet in a point S, and whose axes 5 and 6 meet in a point W; S and W lie
/// beside axis 4. These are the first six joints of most arms with seven: Franka's, whose elbow and wrist have offsets,
/// and arms with a spherical shoulder and a spherical wrist, such as KUKA's. Offsets and angles are arbitrary.
///
/// Axes are given in the world with q = 0, as in SphericalWrist. With T(q) T(0)⁻¹ = e₁ e₂ e₃ e₄ e₅ e₆ = G:
///  - q₄: joints 5 and 6 keep W in place, and joints 1 to 3 keep its distance from S: ElbowTriangle;
///  - the swivel, a rotation about the line from S to G W: R₁ R₂ R₃ R₄ a₅ must enclose with G a₆ the angle between a₅
/// and a₆. With q₄ that gives R₁ R₂ R₃ (the idea of He and Liu 2021, there for one arm);
///  - q₅: it takes a₆ to the rest of G a₆; q₆: the remainder of the rotation; q₁, q₂ and q₃: ThreeTurns.
///
/// Singular poses: where any swivel is a solution (a₅ or G a₆ along the line from S to W) it is the reference's; where
/// axes 1 and 3 are collinear, q₁ is. A pose with W in S is not solved.
class SphericalShoulder {
 public:
  /// Answers unsupported, naming the property of the arm that does not fit.
  [[nodiscard]] static Result<SphericalShoulder> find(const ArmModel& arm);

  /// Tells whether axes meet to the last digits. If not, solutions are approximate and need refinement.
  [[nodiscard]] bool is_exact() const { return exact_; }

  /// Returns all solutions in which every angle, up to whole turns, is within its limits. Angles are in (−π, π], except
  /// those taken from the reference. Order: elbow, swivel, shoulder. A microsecond or two, a tenth where W is out of
  /// reach; safe for concurrent use.
  [[nodiscard]] ClosedFormSolutions solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  struct Elbow;
  SphericalShoulder() = default;
  void solve_swivel(const Elbow& elbow, const Configuration& reference, ClosedFormSolutions& found) const;
  void solve_rest(const Elbow& elbow, double swivel, const Configuration& reference, ClosedFormSolutions& found) const;

  bool exact_{true};
  JointAxes axes_;
  Eigen::Vector3d p_camera_W_;      // W in the frame of the camera, constant
  Eigen::Matrix3d R_camera_world_;  // rotation of the camera at q = 0
  ElbowTriangle elbow_;
  double cos_56_{0.0};       // cosine of the angle between axes 5 and 6
  Eigen::Vector3d across6_;  // unit, across axis 6
  ThreeTurns shoulder_;
};

}  // namespace saccade
