// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/elbow_triangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kElbowRounding{1e-12};  // relative distance beyond the reach that counts as rounding
constexpr double kOnePoint_m{1e-10};     // points closer together than this define no direction

/// Returns a frame with its x axis along a vector, and its z axis as near to another as possible.
Matrix3d frame_along(const Vector3d& x, const Vector3d& z) {
  Matrix3d frame;
  frame.col(0) = x.normalized();
  const Vector3d across = z.cross(frame.col(0));
  const double length = across.norm();
  frame.col(1) = length > kOnePoint_m ? Vector3d{across / length} : frame.col(0).unitOrthogonal();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

}  // namespace

ElbowTriangle::ElbowTriangle(const Vector3d& S, const Vector3d& W, const Vector3d& axis1, const Vector3d& p4,
                             const Vector3d& axis4)
    : S_{S},
      axis1_{axis1},
      axis4_{axis4},
      elbow_S_{S - p4},
      elbow_W_{W - p4},
      shortest_m_{std::min(distance_to_line(S, p4, axis4), distance_to_line(W, p4, axis4))} {
  const double along = axis4.dot(elbow_S_) * axis4.dot(elbow_W_);
  A_ = elbow_S_.dot(elbow_W_) - along;
  B_ = elbow_S_.dot(axis4.cross(elbow_W_));
  C_ = 0.5 * (elbow_S_.squaredNorm() + elbow_W_.squaredNorm()) - along;
  slack_ = kElbowRounding * std::hypot(A_, B_);
}

AnglePair ElbowTriangle::elbows(const Vector3d& S_W) const {
  const double distance2 = S_W.squaredNorm();
  if (distance2 < kOnePoint_m * kOnePoint_m) return {};
  return angles_with(A_, B_, C_ - 0.5 * distance2, slack_);
}

Matrix3d ElbowTriangle::frame_of_pose(const Vector3d& S_W) const { return frame_along(S_W, axis1_.cross(S_W)); }

Matrix3d ElbowTriangle::frame_of_arm(const Matrix3d& R4) const { return frame_along(R4 * elbow_W_ - elbow_S_, axis4_); }

Matrix3d turn_about_x(double angle_rad) {
  const double s = std::sin(angle_rad);
  const double c = std::cos(angle_rad);
  Matrix3d R = Matrix3d::Identity();
  R.bottomRightCorner<2, 2>() << c, -s, s, c;
  return R;
}

double swivel_near(const JointAxes& axes, const Configuration& reference, const Matrix3d& of_pose,
                   const Matrix3d& of_arm) {
  Vector3d across = of_arm.col(1);
  for (int i = 2; i >= 0; --i) across = turned(axes.axis[static_cast<std::size_t>(i)], reference[i], across);
  return std::atan2(of_pose.col(2).dot(across), of_pose.col(1).dot(across));
}

}  // namespace saccade
