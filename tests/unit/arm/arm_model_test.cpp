// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_model.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "saccade/arm/kinematics.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

using test::describe;

void expect_refused(const std::function<void(ArmDescription&)>& spoil, const std::string& part) {
  ArmDescription description = describe("test", test::comau_rows());
  spoil(description);
  const auto arm = ArmModel::create(std::move(description));
  ASSERT_FALSE(arm) << part;
  EXPECT_EQ(arm.error().code, Errc::invalid_argument);
  EXPECT_NE(arm.error().to_string().find(part), std::string::npos) << arm.error().to_string();
}

TEST(ArmModel, SaysWhatIsWrong) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  expect_refused([](ArmDescription& d) { d.joints.clear(); }, "arm test: has no joint that moves");
  expect_refused([](ArmDescription& d) { d.joints.resize(13, d.joints[0]); }, "has 13 joints; 12 at most");
  expect_refused([](ArmDescription& d) { d.links.pop_back(); }, "one link more than joints");
  expect_refused([](ArmDescription& d) { d.joints[2].axis_joint.setZero(); }, "joint joint_3: its axis has no length");
  expect_refused([](ArmDescription& d) { d.joints[2].axis_joint.x() = kNan; }, "its axis has no length");
  expect_refused([](ArmDescription& d) { d.joints[1].limits.lower = kNan; }, "joint joint_2: its position limits");
  expect_refused([](ArmDescription& d) { d.joints[1].limits.upper = -4.0; }, "lower limit must lie below");
  expect_refused([](ArmDescription& d) { d.joints[5].limits.speed = 0.0; }, "joint joint_6: its speed limit");
  expect_refused([](ArmDescription& d) { d.joints[5].limits.acceleration = kNan; }, "its acceleration limit");
  expect_refused([](ArmDescription& d) { d.joints[0].T_parent_joint(0, 3) = kNan; }, "its origin is not a rigid");
  expect_refused([](ArmDescription& d) { d.joints[0].T_parent_joint(0, 3) = 1e308; }, "longer than 1 km");
  expect_refused([](ArmDescription& d) { d.T_flange_camera(0, 0) = 2.0; }, "hand-eye transform");
  const auto with_body = [](const decltype(CollisionBody::shape)& shape) {
    return [shape](ArmDescription& d) { d.links[3].bodies.push_back({"elbow", Pose::Identity(), shape}); };
  };
  expect_refused(with_body(BoxBody{{0.1, 0.0, 0.1}}), "link elbow: the sides of a collision box");
  expect_refused(with_body(SphereBody{-1.0}), "radius of a collision sphere");
  expect_refused(with_body(CylinderBody{0.1, kNan}), "length of a collision cylinder");
  expect_refused(with_body(MeshBody{}), "has no triangles");
  MeshBody mesh;
  mesh.mesh.vertices.resize(3, Eigen::Vector3f::Zero());
  mesh.mesh.triangles.push_back({0, 1, 3});
  expect_refused(with_body(mesh), "names a vertex it does not have");
}

TEST(ArmModel, KeepsWhatItWasGiven) {
  ArmDescription description = describe("test", test::comau_rows());
  description.joints[3].axis_joint = {0.0, 0.0, -5.0};
  description.joints[5].kind = JointKind::continuous;
  description.joints[1].limits.lower = -1.0;
  description.joints[1].limits.upper = 2.0;
  const auto arm = ArmModel::create(std::move(description));
  ASSERT_TRUE(arm) << arm.error().to_string();
  EXPECT_EQ(arm->dof(), 6);
  EXPECT_EQ(arm->joint(3).axis_joint, -Eigen::Vector3d::UnitZ());
  EXPECT_EQ(arm->middle()[1], 0.5);
  EXPECT_EQ(arm->middle()[5], 0.0);
  Configuration q = Configuration::Zero(6);
  q[5] = 1000.0;
  EXPECT_TRUE(arm->within_limits(q));
  q[1] = 2.1;
  EXPECT_FALSE(arm->within_limits(q));
  EXPECT_TRUE(arm->within_limits(q, 0.2));
  q[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(arm->within_limits(q));
}

}  // namespace
}  // namespace saccade
