// SPDX-License-Identifier: Apache-2.0
#pragma once
// SphericalWrist: closed-form inverse kinematics of six revolute joints, the last three about axes through one point.

#include <Eigen/Core>

#include "saccade/arm/internal/joint_axes.hpp"
#include "saccade/arm/internal/three_turns.hpp"

namespace saccade {

/// Solver for arms whose axes 4, 5 and 6 meet in a point, the wrist's centre, whose axes 2 and 3 are parallel, and
/// whose axis 1 is not parallel to them: nearly all industrial arms. Offsets and angles are arbitrary: shoulders beside
/// axis 1, forearms beside axis 4, tilted bases, oblique wrists.
///
/// Axes are given in the world with q = 0, so that T(q) = e^(ξ₁q₁) … e^(ξ₆q₆) T(0) (product of exponentials, Brockett
/// 1984), independent of the links' frames. The last three joints keep the wrist's centre in place. So the first three
/// are found from its position and the last three from the remaining rotation (Pieper 1968):
///  - q₁: the wrist's centre, turned back about axis 1, has its distance along a₂ at q = 0;
///  - q₃: the law of cosines in the plane across a₂; q₂: the direction in that plane;
///  - q₄, q₅ and q₆: ThreeTurns.
/// Angles come from half-angle formulas and atan2, which keep their digits where acos loses half of them.
///
/// Singular poses: where a joint's angle is free (q₁: wrist's centre on axis 1; q₂: on axis 2; q₄ and q₆: their axes
/// collinear) q₁, q₂, q₄ are those of the reference and the others follow. q₄ deviates as far as q₆'s limits require.
/// Two solutions that coincide (arm stretched or folded, wrist straight) are returned once.
class SphericalWrist {
 public:
  /// Answers unsupported, naming the property of the arm that does not fit.
  [[nodiscard]] static Result<SphericalWrist> find(const ArmModel& arm);

  /// Tells whether the axes meet, and are parallel, to the last digits. If not, solutions are approximate and need
  /// refinement.
  [[nodiscard]] bool is_exact() const { return exact_; }

  /// Returns all solutions in which every angle, up to whole turns, is within its limits. Angles are in (−π, π], except
  /// those taken from the reference. Order: shoulder, elbow, wrist. A microsecond or two; safe for concurrent use.
  [[nodiscard]] ClosedFormSolutions solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  struct Shoulder;
  SphericalWrist() = default;
  void solve_elbow(const Shoulder& shoulder, const Configuration& reference, ClosedFormSolutions& found) const;
  void solve_wrist(const Shoulder& shoulder, double q2, double q3, const Configuration& reference,
                   ClosedFormSolutions& found) const;

  bool exact_{true};
  JointAxes axes_;
  Eigen::Vector3d p_camera_wrist_;  // wrist's centre in the camera's frame, constant
  Eigen::Matrix3d R_camera_world_;  // rotation of the camera at q = 0
  double wrist_along_a2_{0.0};      // coordinate of the wrist's centre from axis 1's point at q = 0
  Eigen::Vector3d u_, v_;           // plane across axis 2
  TwoLinks links_;                  // axis 2 to axis 3, axis 3 to the wrist's centre at q = 0, in that plane
  double sign3_{1.0};               // axis 3 = sign · axis 2
  ThreeTurns wrist_;
};

}  // namespace saccade
