// SPDX-License-Identifier: Apache-2.0
// The tree of frames: interpolation, a common time, and trees that are none.
#include "apps/ros2/transforms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace saccade::test {
namespace {

using ros2::Transforms;

messages::TFMessage tf(const std::string& parent, const std::string& child, double time_s, double x,
                       double turn_rad = 0.0) {
  messages::TransformStamped t;
  t.header.stamp = messages::Time::from_seconds(time_s);
  t.header.frame_id = parent;
  t.child_frame_id = child;
  t.transform.position.x = x;
  t.transform.orientation.z = std::sin(0.5 * turn_rad);
  t.transform.orientation.w = std::cos(0.5 * turn_rad);
  return {{t}};
}

TEST(Ros2Transforms, AreInterpolatedAtTheLatestCommonTime) {
  Transforms tree;
  EXPECT_EQ(tree.add(tf("world", "base", 0.0, 1.0), true), "");
  for (const double t : {12.0, 10.0, 11.0}) EXPECT_EQ(tree.add(tf("base", "/hand", t, t, 0.1 * t), false), "");
  EXPECT_EQ(tree.add(tf("world", "eye", 11.5, -1.0), false), "");
  EXPECT_EQ(tree.add(tf("eye", "lens", 0.0, 0.5), true), "");
  const auto hand = tree.find("world", "hand");
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->time_s, 12.0);
  EXPECT_NEAR(hand->T_reference_frame.translation().x(), 13.0, 1e-12);
  const auto seen = tree.find("lens", "hand");  // the eye was last heard of at 11.5
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->time_s, 11.5);
  EXPECT_NEAR(seen->T_reference_frame.translation().x(), 1.0 + 11.5 + 0.5, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd{seen->T_reference_frame.rotation()}.angle(), 1.15, 1e-9);
  const auto fixed = tree.find("base", "world");
  ASSERT_TRUE(fixed);
  EXPECT_FALSE(fixed->time_s);
  EXPECT_EQ(fixed->T_reference_frame.translation().x(), -1.0);
  EXPECT_EQ(tree.frames(), "base, eye, hand, lens, world");
}

TEST(Ros2Transforms, WhatIsNotConnectedNotInTimeOrNoRotationIsNotFound) {
  Transforms tree;
  EXPECT_FALSE(tree.find("world", "hand"));
  EXPECT_NE(tree.add(tf("world", "hand", 1.0, std::numeric_limits<double>::quiet_NaN()), false), "");
  messages::TFMessage flat = tf("world", "hand", 1.0, 0.0);
  flat.transforms[0].transform.orientation.w = 0.0;
  EXPECT_NE(tree.add(flat, false).find("not a rotation"), std::string::npos);
  EXPECT_NE(tree.add(tf("hand", "hand", 1.0, 0.0), false), "");
  EXPECT_EQ(tree.frames(), "none");
  EXPECT_EQ(tree.add(tf("a", "b", 1.0, 0.0), false), "");
  EXPECT_EQ(tree.add(tf("b", "c", 20.0, 0.0), false), "");
  EXPECT_FALSE(tree.find("a", "c"));  // never known at one time
  EXPECT_FALSE(tree.find("world", "c"));
  EXPECT_EQ(tree.add(tf("c", "a", 20.0, 0.0), false), "");  // a loop
  EXPECT_FALSE(tree.find("a", "c"));
}

TEST(Ros2Transforms, AClockThatBeginsAnewForgetsWhatWas) {
  Transforms tree;
  EXPECT_EQ(tree.add(tf("world", "hand", 100.0, 1.0), false), "");
  EXPECT_EQ(tree.add(tf("world", "hand", 1.0, 2.0), false), "");
  EXPECT_EQ(tree.find("world", "hand")->time_s, 1.0);
}

}  // namespace
}  // namespace saccade::test
