// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "support/placed_object.hpp"

namespace saccade {
namespace {

using test::placed;

TEST(FixtureBoxes, EncloseWhatIsFixedAndWhatSupports) {
  Scene scene;
  scene.name = "cell";
  scene.workspace = Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  scene.objects = {placed("table", BoxShape{{1.0, 0.6, 0.04}}, {0.0, 0.0, -0.04}),
                   placed("cup", SphereShape{0.1}, {0.0, 0.0, 0.1}),
                   placed("post", BoxShape{{0.2, 0.2, 1.0}}, {0.7, 0.0, -0.5})};
  scene.objects[0].support = true;
  scene.objects[2].fixture = true;
  scene.objects[2].T_world_object.rotate(Eigen::AngleAxisd{0.25 * std::numbers::pi, Eigen::Vector3d::UnitZ()});
  const std::vector<FixtureBox> boxes = fixture_boxes(scene).value();
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes[0].name, "table");
  EXPECT_TRUE(boxes[0].support);
  EXPECT_TRUE(boxes[0].box.min.isApprox(Eigen::Vector3d{-0.5, -0.3, -0.04}, 1e-6)) << boxes[0].box.min.transpose();
  EXPECT_NEAR(boxes[0].box.max.z(), 0.0, 1e-6);
  EXPECT_EQ(boxes[1].name, "post");
  EXPECT_FALSE(boxes[1].support);
  EXPECT_NEAR(boxes[1].box.max.x(), 0.7 + std::sqrt(0.02), 1e-6) << "turned by 45°";
}

TEST(FixtureBoxes, MayBeNone) {
  Scene scene;
  scene.name = "nothing";
  scene.workspace = Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  EXPECT_TRUE(fixture_boxes(scene).value().empty());
}

}  // namespace
}  // namespace saccade
