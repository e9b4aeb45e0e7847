// SPDX-License-Identifier: Apache-2.0
#pragma once
// SphericalShoulder: closed-form inverse kinematics of six joints that turn, the first three about axes through one
// point, the last two about axes through another.

#include <Eigen/Core>

#include "saccade/arm/internal/elbow_triangle.hpp"
#include "saccade/arm/internal/three_turns.hpp"

namespace saccade {

/// Solves six joints whose axes 1, 2 and 3 meet in a point S, and whose axes 5 and 6 meet in a point W; S and W lie
/// beside axis 4. Those are the first six of most arms with seven: Franka's, whose elbow and wrist have offsets, and
/// those with a spherical shoulder and a spherical wrist, such as KUKA's. Offsets and angles are as they come.
///
/// Axes are taken in the world with q = 0, as in SphericalWrist. With T(q) T(0)⁻¹ = e₁ e₂ e₃ e₄ e₅ e₆ = G:
///  - q₄: joints 5 and 6 leave W where it is, and joints 1 to 3 its distance from S: ElbowTriangle;
///  - the swivel, a turn about the line from S to G W: R₁ R₂ R₃ R₄ a₅ must enclose with G a₆ the angle that a₅ and a₆
///    enclose. With q₄ that gives R₁ R₂ R₃ (the same idea as in He and Liu 2021, there for one arm);
///  - q₅: it leads a₆ to what is left of G a₆; q₆: what is missing of the turn; q₁, q₂ and q₃: ThreeTurns.
///
/// Singular poses: where any swivel will do (a₅ or G a₆ along the line from S to W) it is the reference's; where axes 1
/// and 3 end up in one line, q₁ is. A pose that has W in S is not solved.
class SphericalShoulder {
 public:
  /// unsupported, saying what about the arm does not fit.
  [[nodiscard]] static Result<SphericalShoulder> find(const ArmModel& arm);

  /// Whether axes meet to the last digits. If not, solutions are near ones, to be refined.
  [[nodiscard]] bool is_exact() const { return exact_; }

  /// All solutions in which every angle, give or take whole turns, is within its limits. Angles are in (−π, π] but for
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
  Eigen::Vector3d p_camera_W_;      // in the frame of the camera, always the same
  Eigen::Matrix3d R_camera_world_;  // rotation of the camera at q = 0
  ElbowTriangle elbow_;
  double cos_56_{0.0};       // cosine of the angle between axes 5 and 6
  Eigen::Vector3d across6_;  // unit, across axis 6
  ThreeTurns shoulder_;
};

}  // namespace saccade
