// SPDX-License-Identifier: Apache-2.0
#pragma once
// ParallelAxes: closed-form inverse kinematics of six revolute joints, the middle three about parallel axes.

#include <Eigen/Core>

#include "saccade/arm/internal/joint_axes.hpp"

namespace saccade {

/// Solver for arms whose axes 2, 3 and 4 are parallel, whose axes 5 and 6 meet in a point P, and whose axes 1, 5 and 6
/// are not parallel to their neighbours: Universal Robots and many similar arms. Offsets and angles are arbitrary.
///
/// Axes are given in the world with q = 0, as in SphericalWrist. With T(q) T(0)⁻¹ = e₁ e₂ e₃ e₄ e₅ e₆ = G:
///  - q₁: joints 5 and 6 keep P in place, and joints 2 to 4 keep its coordinate along a₂: turned back about axis 1, G P
/// has the coordinate along a₂ that P has at q = 0;
///  - q₅: joints 2 to 4 keep a₂ and joint 6 keeps a₆, so the angle between a₂ and R₅ a₆ is known;
///  - q₆: it takes the image of a₂ under G and R₁ to R₅⁻¹ a₂;
///  - q₂ and q₃: the rest, e₂ e₃ e₄, is a motion in the plane across a₂, where axis 4 lies at the end of two links; q₄:
/// the remainder of its rotation.
///
/// Singular poses: where a₆ ends up along a₂, only q₄ and q₆ together count, and q₆ is the reference's. Where P lies on
/// axis 1, q₁ is the reference's; where axis 4 lies on axis 2, q₂ is.
class ParallelAxes {
 public:
  /// Answers unsupported, naming the property of the arm that does not fit.
  [[nodiscard]] static Result<ParallelAxes> find(const ArmModel& arm);

  /// Tells whether axes meet, and are parallel, to the last digits. If not, solutions are approximate and need
  /// refinement.
  [[nodiscard]] bool is_exact() const { return exact_; }

  /// Returns all solutions in which every angle, up to whole turns, is within its limits. Angles are in (−π, π], except
  /// those taken from the reference. Order: shoulder, wrist, elbow. A microsecond or two; safe for concurrent use.
  [[nodiscard]] ClosedFormSolutions solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  struct Shoulder;
  ParallelAxes() = default;
  void solve_wrist(const Shoulder& shoulder, const Configuration& reference, ClosedFormSolutions& found) const;
  void solve_elbow(const Shoulder& shoulder, double q5, double q6, const Configuration& reference,
                   ClosedFormSolutions& found) const;

  bool exact_{true};
  JointAxes axes_;
  Pose T_camera_world_;                        // pose of the world in the frame of the camera at q = 0
  Eigen::Vector3d P_;                          // intersection of axes 5 and 6
  Eigen::Vector3d u_, v_;                      // plane across axis 2
  TwoLinks links_;                             // axis 2 to axis 3, axis 3 to axis 4 at q = 0, in that plane
  double sign3_{1.0}, sign4_{1.0};             // axes 3 and 4 = sign · axis 2
  double alpha_{0.0}, beta_{0.0}, phi5_{0.0};  // angles between axes 2 and 5, 5 and 6; q5 where 2, 5, 6 lie in a plane
};

}  // namespace saccade
