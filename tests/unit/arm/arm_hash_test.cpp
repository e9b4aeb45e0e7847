// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_model.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "support/test_arms.hpp"

namespace saccade {
namespace {

ArmDescription described() {
  ArmDescription arm = test::describe("arm", test::comau_rows());
  arm.links[1].bodies.push_back({"upper", Pose::Identity(), BoxBody{{0.1, 0.1, 0.4}}});
  arm.links[2].bodies.push_back(
      {"lower", Pose::Identity(), MeshBody{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {{0, 1, 2}}}}});
  return arm;
}

TEST(ArmHash, ChangesWithAllThatAPlannerSees) {
  const auto hash_of = [](const ArmDescription& arm) { return arm_hash(ArmModel::create(arm).value()); };
  const std::string hash = hash_of(described());
  EXPECT_EQ(hash.size(), 16U);
  EXPECT_EQ(hash_of(described()), hash);
  ArmDescription renamed = described();
  renamed.name = renamed.joints[0].name = renamed.links[1].bodies[0].name = "another";
  EXPECT_EQ(hash_of(renamed), hash);
  const std::vector<std::function<void(ArmDescription&)>> changes{
      [](ArmDescription& arm) { arm.T_world_base.translation().x() += 0.001; },
      [](ArmDescription& arm) { arm.joints[2].T_parent_joint.translation().y() += 0.001; },
      [](ArmDescription& arm) { arm.joints[2].axis_joint = Eigen::Vector3d::UnitX(); },
      [](ArmDescription& arm) { arm.joints[1].limits.upper -= 0.01; },
      [](ArmDescription& arm) { arm.joints[1].limits.speed *= 0.5; },
      [](ArmDescription& arm) { arm.joints[5].kind = JointKind::continuous; },
      [](ArmDescription& arm) { arm.T_flange_camera.translation().z() += 0.001; },
      [](ArmDescription& arm) { arm.links[1].bodies.pop_back(); },
      [](ArmDescription& arm) { arm.links[1].bodies[0].T_link_body.translation().z() += 0.001; },
      [](ArmDescription& arm) {
        arm.links[1].bodies[0].shape = BoxBody{{0.1, 0.1, 0.5}};
      },
      [](ArmDescription& arm) { arm.links[1].bodies[0].shape = SphereBody{0.1}; },
      [](ArmDescription& arm) {
        arm.links[1].bodies[0].shape = CylinderBody{0.1, 0.4};
      },
      [](ArmDescription& arm) { std::get<MeshBody>(arm.links[2].bodies[0].shape).mesh.vertices[1].x() = 2.0F; }};
  std::set<std::string> hashes{hash};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    ArmDescription changed = described();
    changes[i](changed);
    EXPECT_TRUE(hashes.insert(hash_of(changed)).second) << "change " << i;
  }
}

}  // namespace
}  // namespace saccade
