// SPDX-License-Identifier: Apache-2.0
#pragma once
// ElbowTriangle: a shoulder S and a wrist W with one joint between them, the elbow, which settles how far apart they
// are.

#include <Eigen/Core>

#include "saccade/arm/internal/joint_axes.hpp"

namespace saccade {

/// Axes are taken in the world with q = 0. Beyond the elbow's angle, how far apart S and W are leaves one turn open:
/// the swivel, about the line from one to the other. It is 0 where axis 1, S, W and the elbow lie in a plane.
class ElbowTriangle {
 public:
  ElbowTriangle() = default;
  /// @param axis1, axis4 unit; p4 on axis 4.
  ElbowTriangle(const Eigen::Vector3d& S, const Eigen::Vector3d& W, const Eigen::Vector3d& axis1,
                const Eigen::Vector3d& p4, const Eigen::Vector3d& axis4);

  /// From S and W to axis 4, whichever is shorter; must have some length.
  [[nodiscard]] double shortest_m() const { return shortest_m_; }
  [[nodiscard]] const Eigen::Vector3d& S() const { return S_; }

  /// What has W at a place of the world: the law of cosines about axis 4. None where W falls on S.
  [[nodiscard]] AnglePair elbows(const Eigen::Vector3d& S_W) const;
  /// A frame whose x axis leads from S to W as the pose has them, and whose z axis lies across axis 1.
  [[nodiscard]] Eigen::Matrix3d frame_of_pose(const Eigen::Vector3d& S_W) const;
  /// A frame whose x axis leads from S to W as the elbow alone has them, and whose z axis is axis 4, or lies near it.
  /// A shoulder turned by pose · (turn about x by the swivel) · (arm)ᵀ has W in its place.
  [[nodiscard]] Eigen::Matrix3d frame_of_arm(const Eigen::Matrix3d& R4) const;

 private:
  Eigen::Vector3d S_, axis1_, axis4_;
  Eigen::Vector3d elbow_S_, elbow_W_;  // from axis 4's point
  double A_{0.0}, B_{0.0}, C_{0.0};    // A cos q₄ + B sin q₄ = C − |W − S|²/2
  double slack_{0.0};                  // rounding of the right side
  double shortest_m_{0.0};
};

/// The turn about x by an angle.
[[nodiscard]] Eigen::Matrix3d turn_about_x(double angle_rad);

/// The swivel with which a shoulder stands nearest to that of the reference, whose first three joints turn about the
/// axes.
[[nodiscard]] double swivel_near(const JointAxes& axes, const Configuration& reference, const Eigen::Matrix3d& of_pose,
                                 const Eigen::Matrix3d& of_arm);

}  // namespace saccade
