// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/pose.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <string>

namespace saccade {

Result<Pose> pose_from_matrix(const Eigen::Matrix4d& matrix) {
  if (!matrix.allFinite()) return Error{Errc::invalid_argument, "the pose contains NaN or infinity", {}};
  const Eigen::RowVector4d last_row{0.0, 0.0, 0.0, 1.0};
  if ((matrix.row(3) - last_row).norm() > kRotationTolerance) {
    return Error{Errc::invalid_argument, "the last row of a pose must be 0 0 0 1", {}};
  }
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const double deviation = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(deviation <= kRotationTolerance) || R.determinant() <= 0.0) {
    return Error{Errc::invalid_argument,
                 "the pose is not a rotation: ‖RRᵀ − I‖ = " + std::to_string(deviation) +
                     ", det = " + std::to_string(R.determinant()),
                 {}};
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd{R, Eigen::ComputeFullU | Eigen::ComputeFullV};
  Pose T{Pose::Identity()};
  T.linear() = svd.matrixU() * svd.matrixV().transpose();
  T.translation() = matrix.topRightCorner<3, 1>();
  return T;
}

Pose look_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target, const Eigen::Vector3d& up,
             double roll_rad) {
  SACCADE_EXPECTS((target - position).norm() > 0.0);
  const Eigen::Vector3d z = (target - position).normalized();
  Eigen::Vector3d x = z.cross(up);
  if (x.norm() < 1e-9 * up.norm()) x = z.cross(Eigen::Vector3d::UnitY());
  if (x.norm() < 1e-9) x = z.cross(Eigen::Vector3d::UnitX());
  x.normalize();
  Pose T{Pose::Identity()};
  T.linear().col(0) = x;
  T.linear().col(1) = z.cross(x);
  T.linear().col(2) = z;
  T.translation() = position;
  if (roll_rad != 0.0) T.rotate(Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitZ()});
  return T;
}

double rotation_angle_rad(const Pose& T) { return Eigen::AngleAxisd{T.linear()}.angle(); }

}  // namespace saccade
