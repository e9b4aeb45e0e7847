// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/solids.hpp"

#include <gtest/gtest.h>

#include "support/placed_object.hpp"

namespace saccade {
namespace {

Solids solids_of(const std::vector<SceneObject>& objects) {
  Scene scene;
  scene.name = "solids";
  scene.workspace = Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  scene.objects = objects;
  return *Solids::build(*RayScene::build(scene), [](const SceneObject& one) { return one.name != "ghost"; });
}

TEST(Solids, KnowInsideFromOutsideAndFromHollow) {
  const RevolutionShape cup{{{0.05, 0.0}, {0.05, 0.1}}, 0.01};
  const Solids solids = solids_of({test::placed("cup", cup, Eigen::Vector3d::Zero()),
                                   test::placed("block", BoxShape{{0.1, 0.1, 0.1}}, {0.0, 0.0, -0.1}),
                                   test::placed("ghost", SphereShape{0.1}, {0.5, 0.0, 0.0})});
  EXPECT_TRUE(solids.contain({0.0451, 0.001, 0.05}));   // the wall
  EXPECT_TRUE(solids.contain({0.011, 0.001, 0.005}));   // the floor
  EXPECT_FALSE(solids.contain({0.011, 0.001, 0.05}));   // the hollow
  EXPECT_TRUE(solids.contain({0.011, 0.001, -0.05}));   // the block, under the cup that stands on it
  EXPECT_FALSE(solids.contain({0.011, 0.001, -0.15}));  // below everything
  EXPECT_FALSE(solids.contain({0.501, 0.001, 0.05}));   // was not wanted
  EXPECT_NEAR(solids.distance_m({0.5, 0.0, 0.05}, 1.0), 0.45, 1e-3);
  EXPECT_EQ(solids.distance_m({0.5, 0.0, 0.05}, 0.1), 0.1);
}

TEST(Solids, PartsOfOneBodyMayRunIntoEachOther) {
  MeshShape cross;
  for (const Eigen::Vector3d& size_m : {Eigen::Vector3d{0.3, 0.1, 0.1}, Eigen::Vector3d{0.1, 0.3, 0.1}}) {
    const TriangleMesh box = *tessellate(BoxShape{size_m});
    const auto offset = static_cast<std::uint32_t>(cross.mesh.vertices.size());
    cross.mesh.vertices.insert(cross.mesh.vertices.end(), box.vertices.begin(), box.vertices.end());
    for (const auto& [a, b, c] : box.triangles) cross.mesh.triangles.push_back({a + offset, b + offset, c + offset});
  }
  for (Eigen::Vector3f& vertex : cross.mesh.vertices) vertex.z() += vertex.x() > 0.1F ? 0.013F : 0.0F;
  const Solids solids = solids_of({test::placed("cross", cross, Eigen::Vector3d::Zero())});
  EXPECT_TRUE(solids.contain({0.011, 0.012, 0.05}));  // in both bars
  EXPECT_TRUE(solids.contain({0.011, 0.121, 0.05}));  // in one
  EXPECT_FALSE(solids.contain({0.111, 0.121, 0.05}));
}

TEST(Solids, MayBeEmpty) {
  const Solids nothing = solids_of({test::placed("ghost", SphereShape{0.1}, Eigen::Vector3d::Zero())});
  EXPECT_FALSE(nothing.contain(Eigen::Vector3d::Zero()));
  EXPECT_EQ(nothing.distance_m(Eigen::Vector3d::Zero(), 0.3), 0.3);
}

}  // namespace
}  // namespace saccade
