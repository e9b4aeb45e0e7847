// SPDX-License-Identifier: Apache-2.0
// A simulated camera that sees the arm which holds it: what the map learns with and without the mask.
#include <gtest/gtest.h>

#include "saccade/arm/arm_silhouette.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/scene/simulated_camera.hpp"

namespace saccade {
namespace {

PinholeCamera hand_camera() { return {320, 240, 262.5, 262.5, 159.5, 119.5, 0.5, 4.0}; }

/// Vertices of the map's surface within 4 cm of the arm, along the camera's z.
std::size_t vertices_on_arm(const DepthImage& fused, const DepthImage& arm, const Pose& T_world_camera) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  TsdfMap map = TsdfMap::create(config).value();
  EXPECT_TRUE(map.integrate(hand_camera(), fused, T_world_camera, Executor{}));
  const TriangleMesh mesh = extract_mesh(map.snapshot(), Executor{});
  EXPECT_GT(mesh.vertices.size(), 1000U);
  std::size_t count = 0;
  for (const Eigen::Vector3f& p_world : mesh.vertices) {
    const Eigen::Vector3d p = T_world_camera.inverse() * p_world.cast<double>();
    const Eigen::Vector2d at = hand_camera().project(p);
    const auto u = static_cast<int>(std::lround(at.x()));
    const auto v = static_cast<int>(std::lround(at.y()));
    if (u < 0 || v < 0 || u >= arm.width() || v >= arm.height() || !(arm(u, v) > 0.0F)) continue;
    count += std::fabs(p.z() - arm(u, v)) < 0.04 ? 1U : 0U;
  }
  return count;
}

TEST(ArmInPicture, TheMaskKeepsTheArmOutOfTheMap) {
  const ArmModel arm = find_robot("comau_smart_six").value().arm;
  const ArmSilhouette silhouette = ArmSilhouette::create(arm, hand_camera()).value();
  Configuration q{6};
  q << -1.924, 0.215, -2.306, -0.277, 1.399, -0.081;  // the wrist bent back: the camera sees the upper arm and the base
  ASSERT_TRUE(arm.within_limits(q));
  const DepthImage arm_depth = silhouette.depth(q);
  SimulatedCameraConfig config;
  config.camera = hand_camera();
  SimulatedCamera simulated =
      SimulatedCamera::create(RayScene::build(find_scene("tabletop-1").value()).value(), config).value();
  const Pose T_world_camera = camera_pose(arm, q);
  const Frame frame = simulated.capture(T_world_camera, arm_depth);
  EXPECT_GT(vertices_on_arm(frame.depth, arm_depth, T_world_camera), 300U);
  DepthImage masked = frame.depth;
  const auto lost = silhouette.mask(q, masked);
  ASSERT_TRUE(lost);
  EXPECT_GT(*lost, masked.size() / 10);
  EXPECT_EQ(vertices_on_arm(masked, arm_depth, T_world_camera), 0U);
}

/// The views of a table from the built-in arm's side of it do not show the arm: nothing is lost there.
TEST(ArmInPicture, TheBuiltInArmLooksAwayFromItselfInItsMiddle) {
  const ArmModel arm = find_robot("comau_smart_six").value().arm;
  const ArmSilhouette silhouette = ArmSilhouette::create(arm, hand_camera()).value();
  EXPECT_FALSE(silhouette.in_picture(arm.middle()));
  DepthImage depth{320, 240, 1.0F};
  EXPECT_EQ(silhouette.mask(arm.middle(), depth).value(), 0U);
}

}  // namespace
}  // namespace saccade
