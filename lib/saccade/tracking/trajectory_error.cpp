// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/trajectory_error.hpp"

#include <cmath>

namespace saccade {
namespace {

Eigen::Matrix3Xd positions_of(std::span<const Pose> poses) {
  Eigen::Matrix3Xd positions{3, static_cast<Eigen::Index>(poses.size())};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    positions.col(static_cast<Eigen::Index>(i)) = poses[i].translation();
  }
  return positions;
}

double rmse(const Eigen::Matrix3Xd& differences) { return std::sqrt(differences.colwise().squaredNorm().mean()); }

}  // namespace

Result<TrajectoryError> trajectory_error(std::span<const Pose> T_world_estimated, std::span<const Pose> T_world_true) {
  if (T_world_estimated.size() != T_world_true.size()) {
    return Error{Errc::size_mismatch, "the trajectories differ in their number of poses", {}};
  }
  if (T_world_true.empty()) return Error{Errc::invalid_argument, "the trajectories hold no pose", {}};
  const Eigen::Matrix3Xd estimated = positions_of(T_world_estimated);
  const Eigen::Matrix3Xd truth = positions_of(T_world_true);
  const Pose T_joined = T_world_true.front() * T_world_estimated.front().inverse();
  const Eigen::Matrix3Xd joined = (T_joined.linear() * estimated).colwise() + T_joined.translation();
  Eigen::Matrix3Xd aligned = truth;
  if (truth.cols() > 1) {
    const Eigen::Matrix4d T_aligned = Eigen::umeyama(estimated, truth, false);
    aligned = (T_aligned.topLeftCorner<3, 3>() * estimated).colwise() + T_aligned.topRightCorner<3, 1>();
  }
  return TrajectoryError{T_world_true.size(), rmse(joined - truth), rmse(aligned - truth),
                         (aligned - truth).colwise().norm().maxCoeff(), (joined - truth).rightCols<1>().norm()};
}

}  // namespace saccade
