// SPDX-License-Identifier: Apache-2.0
#pragma once
// ElbowTriangle: a shoulder S and a wrist W with one joint between them, the elbow, which determines their distance.

#include <Eigen/Core>

#include "saccade/arm/internal/joint_axes.hpp"

namespace saccade {

/// Triangle of shoulder, elbow and wrist. Axes are given in the world with q = 0. For a given distance between S and W,
/// one rotation remains free beyond the elbow's angle: the swivel about the line from one to the other. It is 0 where
/// axis 1, S, W and the elbow lie in a plane.
class ElbowTriangle {
 public:
  ElbowTriangle() = default;
  /// @param axis1, axis4 unit; p4 on axis 4.
  ElbowTriangle(const Eigen::Vector3d& S, const Eigen::Vector3d& W, const Eigen::Vector3d& axis1,
                const Eigen::Vector3d& p4, const Eigen::Vector3d& axis4);

  /// Returns the shorter distance of S and W from axis 4; it must be positive.
  [[nodiscard]] double shortest_m() const { return shortest_m_; }
  [[nodiscard]] const Eigen::Vector3d& S() const { return S_; }

  /// Returns the elbow angles that bring W to a place of the world: the law of cosines about axis 4. None where W falls
  /// on S.
  [[nodiscard]] AnglePair elbows(const Eigen::Vector3d& S_W) const;
  /// Returns a frame whose x axis leads from S to W as in the pose, and whose z axis is perpendicular to axis 1.
  [[nodiscard]] Eigen::Matrix3d frame_of_pose(const Eigen::Vector3d& S_W) const;
  /// Returns a frame whose x axis leads from S to W as the elbow alone sets them, and whose z axis is axis 4, or close
  /// to it. A shoulder turned by pose · (rotation about x by the swivel) · (arm)ᵀ has W in its place.
  [[nodiscard]] Eigen::Matrix3d frame_of_arm(const Eigen::Matrix3d& R4) const;

 private:
  Eigen::Vector3d S_, axis1_, axis4_;
  Eigen::Vector3d elbow_S_, elbow_W_;  // from axis 4's point
  double A_{0.0}, B_{0.0}, C_{0.0};    // A cos q₄ + B sin q₄ = C − |W − S|²/2
  double slack_{0.0};                  // rounding of the right side
  double shortest_m_{0.0};
};

/// Returns the rotation about x by an angle.
[[nodiscard]] Eigen::Matrix3d turn_about_x(double angle_rad);

/// Returns the swivel with which the shoulder is nearest to that of the reference, whose first three joints turn about
/// the axes.
[[nodiscard]] double swivel_near(const JointAxes& axes, const Configuration& reference, const Eigen::Matrix3d& of_pose,
                                 const Eigen::Matrix3d& of_arm);

}  // namespace saccade
