// SPDX-License-Identifier: Apache-2.0
#pragma once
// SphericalWrist: closed-form inverse kinematics of six joints that turn, the last three about axes through one point.

#include <Eigen/Core>
#include <array>

#include "saccade/arm/arm_model.hpp"

namespace saccade {

/// The solutions of one pose: at most two shoulders, two elbows and two wrists.
struct WristSolutions {
  std::array<Eigen::Matrix<double, 6, 1>, 8> q;  ///< rad; the first `count` are set
  std::size_t count{0};
};

/// Solves arms whose axes 4, 5 and 6 meet in a point, the wrist's centre, whose axes 2 and 3 are parallel, and whose
/// axis 1 is not parallel to them: nearly all industrial arms. Offsets and angles are as they come: shoulders beside
/// axis 1, forearms beside axis 4, tilted bases, oblique wrists.
///
/// Axes are taken in the world with q = 0, so that T(q) = e^(ξ₁q₁) … e^(ξ₆q₆) T(0) (product of exponentials, Brockett
/// 1984), and where the links' frames lie does not matter. The last three joints leave the wrist's centre where it is,
/// so the first three are found from its position and the last three from what is left of the rotation (Pieper 1968):
///  - q₁: the wrist's centre, turned back about axis 1, has the distance along a₂ that it has at q = 0;
///  - q₃: the law of cosines in the plane across a₂; q₂: the direction in that plane;
///  - q₅: the law of cosines on the sphere for the angle between a₄ and a₆; then q₄ and q₆.
/// Angles come from half-angle formulas and atan2, which keep their digits where acos loses half of them.
///
/// Singular poses: where a joint's angle is free (q₁: wrist's centre on axis 1; q₂: on axis 2; q₄ and q₆: their axes in
/// one line) q₁, q₂, q₄ are those of the reference and the others follow; q₄ gives way as far as q₆'s limits need it.
/// Two solutions that fall together (arm stretched or folded, wrist straight) are returned once.
class SphericalWrist {
 public:
  /// Axes of a description that was rounded count as meeting or parallel within this; is_exact() tells.
  static constexpr double kTolerance{1e-4};

  /// unsupported, saying what about the arm does not fit.
  [[nodiscard]] static Result<SphericalWrist> find(const ArmModel& arm);

  /// Whether the axes meet, and are parallel, to the last digits. If not, solutions are near ones, to be refined.
  [[nodiscard]] bool is_exact() const { return exact_; }

  /// All solutions in which every angle, give or take whole turns, is within its limits. Angles are in (−π, π] but for
  /// those taken from the reference. Order: shoulder, elbow, wrist. A microsecond or two; safe for concurrent use.
  [[nodiscard]] WristSolutions solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  struct Shoulder;
  SphericalWrist() = default;
  [[nodiscard]] bool allowed(int joint, double angle_rad) const;
  void solve_elbow(const Shoulder& shoulder, const Configuration& reference, WristSolutions& found) const;
  void solve_wrist(const Shoulder& shoulder, double q2, double q3, const Configuration& reference,
                   WristSolutions& found) const;
  void give_way(double sign, Eigen::Matrix<double, 6, 1>& q) const;

  bool exact_{true};
  std::array<Eigen::Vector3d, 6> axis_;  // unit, world frame, q = 0
  Eigen::Vector3d p1_, p2_;              // points on axes 1 and 2
  Eigen::Vector3d p_camera_wrist_;       // the wrist's centre in the camera's frame, always the same
  Eigen::Matrix3d R_camera_world_;       // of the camera at q = 0
  double wrist_along_a2_{0.0};           // of the wrist's centre from p1 at q = 0
  Eigen::Vector3d u_, v_;                // plane across axis 2
  Eigen::Vector2d upper_, fore_;         // axis 2 to axis 3, axis 3 to the wrist's centre at q = 0, in that plane
  double upper_m_{0.0}, fore_m_{0.0}, elbow_zero_{0.0};
  double sign3_{1.0};                          // axis 3 = sign · axis 2
  double alpha_{0.0}, beta_{0.0}, phi5_{0.0};  // angles between axes 4 and 5, 5 and 6; q5 where 4, 5, 6 lie in a plane
  Eigen::Vector3d across6_;                    // unit, across axis 6
  std::array<double, 6> lower_{}, upper_limit_{};
};

}  // namespace saccade
