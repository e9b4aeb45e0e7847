// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/kinematics.hpp"

#include <gtest/gtest.h>

#include "support/effort.hpp"
#include "support/kdl_arm.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

using test::describe;
using test::random_configuration;

/// Seven joints, one of them prismatic, axes at all angles.
ArmModel crooked_arm() {
  ArmDescription description = describe("crooked", test::oblique_rows());
  ArmJoint slide;
  slide.name = "slide";
  slide.kind = JointKind::prismatic;
  slide.T_parent_joint = Pose{Eigen::Translation3d{0.1, 0.2, 0.0} * Eigen::AngleAxisd{1.0, Eigen::Vector3d::UnitY()}};
  slide.axis_joint = {1.0, 1.0, 0.3};
  slide.limits = {-0.2, 0.5, 1.0, 1.0};
  description.joints.insert(description.joints.begin() + 2, slide);
  description.links.push_back({"last", {}});
  for (ArmJoint& joint : description.joints) joint.axis_joint += Eigen::Vector3d{0.1, -0.2, 0.05};
  return test::with_camera(std::move(description));
}

TEST(Kinematics, PosesAndJacobianAreThoseOfKdl) {
  std::mt19937_64 random{7};
  int cases = 0;
  for (const ArmModel& arm : {crooked_arm(), test::with_camera(describe("comau", test::comau_rows()))}) {
    test::KdlArm kdl{arm};
    for (int i = 0; i < test::scaled_cases(2000); ++i, ++cases) {
      const Configuration q = random_configuration(arm, random);
      const ArmPoses poses = forward_kinematics(arm, q);
      ASSERT_LT(test::miss(poses.T_world_camera, kdl.camera_pose(q)), 1e-13);
      ASSERT_LT(test::miss(poses.T_world_camera, camera_pose(arm, q)), 1e-14);
      ASSERT_LT((camera_jacobian(arm, q) - kdl.camera_jacobian(q)).norm(), 1e-12);
    }
  }
  EXPECT_EQ(cases, 2 * test::scaled_cases(2000));
}

TEST(Kinematics, JacobianIsTheDerivativeOfThePose) {
  const ArmModel arm = crooked_arm();
  std::mt19937_64 random{3};
  for (int i = 0; i < test::scaled_cases(100); ++i) {
    const Configuration q = random_configuration(arm, random);
    const Jacobian J = camera_jacobian(arm, q);
    constexpr double kStep{1e-6};
    for (int k = 0; k < arm.dof(); ++k) {
      Configuration before = q;
      Configuration after = q;
      before[k] -= kStep;
      after[k] += kStep;
      const Eigen::Matrix<double, 6, 1> slope =
          twist_between(camera_pose(arm, before), camera_pose(arm, after)) / (2.0 * kStep);
      ASSERT_LT((slope - J.col(k)).norm(), 1e-8);
    }
  }
}

TEST(Kinematics, TheComauIsTheProductOfItsRows) {
  const ArmModel arm = ArmModel::create(describe("comau", test::comau_rows())).value();
  std::mt19937_64 random{5};
  for (int i = 0; i < 100; ++i) {
    const Configuration q = random_configuration(arm, random);
    ASSERT_LT(test::miss(camera_pose(arm, q), test::dh_product(test::comau_rows(), q)), 1e-14);
  }
}

TEST(Kinematics, NothingIsFartherThanTheReachBound) {
  const ArmModel arm = crooked_arm();
  std::mt19937_64 random{5};
  const Eigen::Vector3d first = arm.T_world_base() * arm.joint(0).T_parent_joint.translation();
  double farthest_m = 0.0;
  for (int i = 0; i < test::scaled_cases(1000); ++i) {
    const Pose T = camera_pose(arm, random_configuration(arm, random));
    farthest_m = std::max(farthest_m, (T.translation() - first).norm());
  }
  EXPECT_LT(farthest_m, reach_bound_m(arm));
  EXPECT_GT(farthest_m, 0.5 * reach_bound_m(arm));
}

}  // namespace
}  // namespace saccade
