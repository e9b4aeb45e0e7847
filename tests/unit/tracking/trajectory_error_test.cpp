// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/trajectory_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace saccade {
namespace {

Pose pose_at(double x, double y, double z, double yaw_rad = 0.0) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()}.toRotationMatrix();
  T.translation() = Eigen::Vector3d{x, y, z};
  return T;
}

std::vector<Pose> square() { return {pose_at(0, 0, 0), pose_at(1, 0, 0), pose_at(1, 1, 0), pose_at(0, 1, 0)}; }

TEST(TrajectoryError, IsZeroWhenOnlyTheWorldsDiffer) {
  const Pose T_other_world = pose_at(3, -2, 5, 1.1);
  std::vector<Pose> moved;
  for (const Pose& T : square()) moved.push_back(T_other_world * T);
  const auto error = trajectory_error(moved, square());
  ASSERT_TRUE(error);
  EXPECT_EQ(error->poses, 4U);
  EXPECT_NEAR(error->first_pose_rmse_m, 0.0, 1e-12);
  EXPECT_NEAR(error->aligned_rmse_m, 0.0, 1e-12);
  EXPECT_NEAR(error->max_m, 0.0, 1e-12);
}

TEST(TrajectoryError, DriftAfterTheFirstPoseIsAlignedAway) {
  std::vector<Pose> estimated = square();  // the first pose alone is off by 0.4 m
  for (std::size_t i = 1; i < estimated.size(); ++i) estimated[i].translation().z() += 0.4;
  const auto error = trajectory_error(estimated, square());
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->first_pose_rmse_m, 0.4 * std::sqrt(0.75), 1e-12);
  EXPECT_LT(error->aligned_rmse_m, 0.2);
  EXPECT_GE(error->max_m, error->aligned_rmse_m);
}

TEST(TrajectoryError, DoesNotAlignScale) {
  std::vector<Pose> estimated = square();
  for (Pose& T : estimated) T.translation() *= 2.0;
  const auto error = trajectory_error(estimated, square());
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->first_pose_rmse_m, 1.0, 1e-12);                // (0 + 1 + 2 + 1) / 4 under the root
  EXPECT_NEAR(error->aligned_rmse_m, 0.5 * std::sqrt(2.0), 1e-12);  // centred, every corner is off by half a diagonal
  EXPECT_NEAR(error->max_m, 0.5 * std::sqrt(2.0), 1e-12);
}

TEST(TrajectoryError, RotationOfTheFirstPoseCounts) {
  std::vector<Pose> estimated = square();
  estimated[0] = pose_at(0, 0, 0, 0.1);  // joining at the first pose turns all the others
  const auto error = trajectory_error(estimated, square());
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->first_pose_rmse_m, 2.0 * std::sin(0.05), 1e-12);  // distances 1, √2, 1 from the turning point
  EXPECT_NEAR(error->aligned_rmse_m, 0.0, 1e-12);
}

TEST(TrajectoryError, NeedsAsManyPosesOnEitherSide) {
  const std::vector<Pose> one{Pose::Identity()};
  EXPECT_EQ(trajectory_error(square(), one).error().code, Errc::size_mismatch);
  EXPECT_EQ(trajectory_error({}, {}).error().code, Errc::invalid_argument);
  const auto single = trajectory_error(one, std::vector<Pose>{pose_at(1, 2, 3)});
  ASSERT_TRUE(single);
  EXPECT_EQ(single->aligned_rmse_m, 0.0);
}

}  // namespace
}  // namespace saccade
