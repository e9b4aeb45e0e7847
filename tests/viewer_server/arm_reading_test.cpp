// SPDX-License-Identifier: Apache-2.0
// How an arm was read, in run.json and back; a run.json may come from anywhere.
#include "server/show/arm_reading.hpp"

#include <gtest/gtest.h>

namespace saccade::server {
namespace {

using nlohmann::json;

TEST(ArmReading, ComesBackAsItWas) {
  UrdfConfig config;
  config.base = "base";
  config.tip = "flange";
  config.camera = "eye";
  config.packages = {{"arm", "/robots/arm"}, {"gripper", "gripper"}};
  config.package_paths = {"/opt/ros/noetic/share", "src"};
  config.keep_beyond_tip = false;
  config.T_world_base = Eigen::Translation3d{0.5, -1.0, 2.0} * Eigen::AngleAxisd{0.3, Eigen::Vector3d::UnitZ()};
  const UrdfConfig back = arm_reading_from_json(arm_reading_to_json(config)).value();
  EXPECT_EQ(back.base, config.base);
  EXPECT_EQ(back.tip, config.tip);
  EXPECT_EQ(back.camera, config.camera);
  EXPECT_EQ(back.packages, config.packages);
  EXPECT_EQ(back.package_paths, config.package_paths);
  EXPECT_FALSE(back.keep_beyond_tip);
  ASSERT_TRUE(back.T_world_base.has_value());
  EXPECT_TRUE(back.T_world_base->isApprox(*config.T_world_base, 1e-12));
  EXPECT_EQ(arm_reading_to_json({}), json::object());
  EXPECT_TRUE(arm_reading_from_json(nullptr).ok()) << "a run from before it was kept";
}

TEST(ArmReading, OtherThingsAreErrors) {
  for (const char* text :
       {"3", "\"tip\"", "[1]", R"({"tip": 5})", R"({"packages": {"a": 3}})", R"({"packages": 3})",
        R"({"package_paths": "src"})", R"({"package_paths": [3]})", R"({"drop_beyond_tip": "yes"})",
        R"({"T_world_base": [[1]]})", R"({"T_world_base": [[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})"}) {
    EXPECT_FALSE(arm_reading_from_json(json::parse(text)).ok()) << text;
  }
}

}  // namespace
}  // namespace saccade::server
