// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/cell.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "saccade/devices/programs.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

constexpr const char* kWhole{R"(cell: bench
workspace: {min: [-0.4, -0.4, -0.02], max: [0.4, 0.4, 0.3]}
fixtures: [{min: [0, 0, 0], max: [1, 2, 3]}]
free: [{min: [-1, -1, 0], max: [0, 0, 1]}]
arm:
  urdf: arms/arm.urdf
  base: base_link
  tip: tool0
  camera_frame: optical
  base_at: [1, 2, 3, 90]
  packages: {arm_description: meshes}
  drop_beyond_tip: true
  T_flange_camera: [[1, 0, 0, 0.01], [0, 1, 0, 0.02], [0, 0, 1, 0.03]]
  speed: 0.3
camera: {command: python3 camera.py, timeout: 5, clock_offset: -0.035}
joints: {command: ./joints, tolerance: 0.02, lag: 0.1, watchdog: 0.5}
hand: {command: ./hand}
tracking: hint
)"};

TEST(Cell, DevicesOverRosAreProgramsWithOptions) {
  const auto cell = parse_cell(R"(arm: {robot: comau_smart_six}
camera: {ros: /camera/depth, info: /camera/camera_info, min_range: 0.3, timeout: 5, clock_offset: 0.1}
joints: {ros: /arm_controller/follow_joint_trajectory, states: "/it's/states", watchdog: 0.5}
hand: ros2:/hand_frame
)");
  ASSERT_TRUE(cell.ok()) << cell.error().to_string();
  EXPECT_EQ(cell->camera.command, "ros:/camera/depth --info /camera/camera_info --min-range 0.3 --timeout 4.000000");
  EXPECT_EQ(cell->camera_clock_offset_s, 0.1);
  EXPECT_EQ(cell->joints.command,
            "ros:/arm_controller/follow_joint_trajectory --states '/it'\\''s/states' --silence 0.400000");
  EXPECT_EQ(cell->watch.watchdog_s, 0.5);
  EXPECT_EQ(cell->hand.command, "ros2:/hand_frame");
}

TEST(Cell, WhatCannotBeOverRosIsSaid) {
  const auto problem = [](const char* yaml) {
    const auto cell = parse_cell(yaml);
    return cell.ok() ? std::string{} : cell.error().to_string();
  };
  EXPECT_NE(problem("robot: ros:/arm").find("no program over ROS"), std::string::npos) << problem("robot: ros:/arm");
  EXPECT_NE(problem("camera: {ros: /a b}").find("needs a name of ROS"), std::string::npos);
  EXPECT_NE(problem("camera: {ros: /a, command: b}").find("exclude each other"), std::string::npos);
  EXPECT_NE(problem("hand: {ros: /a, info: /b}").find("info"), std::string::npos);
}

TEST(RosDevice, AProgramThatIsMissingIsSaidWithItsPackages) {
  EXPECT_TRUE(find_program("saccade-there-is-none").empty());
  EXPECT_FALSE(find_program("sh").empty());
  if (!find_program("saccade-ros2").empty()) GTEST_SKIP() << "saccade-ros2 is in PATH";
  ProgramConfig config;
  config.command = "ros2:/camera";
  const auto camera = ProgramCamera::start(config);
  ASSERT_FALSE(camera.ok());
  EXPECT_EQ(camera.error().code, Errc::unavailable);
  EXPECT_NE(camera.error().to_string().find("built without ROS 2"), std::string::npos) << camera.error().to_string();
}

TEST(Cell, AllOfItIsRead) {
  const auto cell = parse_cell(kWhole, "/cells");
  ASSERT_TRUE(cell.ok()) << cell.error().to_string();
  EXPECT_EQ(cell->folder, "/cells");
  ASSERT_TRUE(cell->arm);
  EXPECT_EQ(cell->arm->robot, "/cells/arms/arm.urdf");
  EXPECT_EQ(cell->arm->base, "base_link");
  EXPECT_EQ(cell->arm->tip, "tool0");
  EXPECT_EQ(cell->arm->camera_frame, "optical");
  EXPECT_TRUE(cell->arm->T_world_base->translation().isApprox(Eigen::Vector3d{1, 2, 3}));
  EXPECT_TRUE((*cell->arm->T_world_base * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d{1, 3, 3}));
  EXPECT_TRUE(cell->arm->T_flange_camera->translation().isApprox(Eigen::Vector3d{0.01, 0.02, 0.03}));
  EXPECT_EQ(cell->arm->packages.at("arm_description"), "/cells/meshes");
  EXPECT_TRUE(cell->arm->drop_beyond_tip);
  EXPECT_EQ(cell->arm->speed, 0.3);
  EXPECT_EQ(cell->camera.command, "python3 camera.py");
  EXPECT_EQ(cell->camera.timeout_s, 5.0);
  EXPECT_EQ(cell->camera_clock_offset_s, -0.035);
  EXPECT_EQ(cell->joints.command, "./joints");
  EXPECT_FALSE(cell->joints.timeout_s);
  EXPECT_EQ(cell->watch.tolerance, 0.02);
  EXPECT_EQ(cell->watch.lag_s, 0.1);
  EXPECT_EQ(cell->watch.watchdog_s, 0.5);
  EXPECT_EQ(cell->hand.command, "./hand");
  EXPECT_TRUE(cell->robot.command.empty());
  EXPECT_EQ(cell->tracking, "hint");
  ASSERT_EQ(cell->fixtures.size(), 1U);
  EXPECT_EQ(cell->fixtures[0].max, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(cell->free.size(), 1U);
}

TEST(Cell, ASceneAloneHasNoDevices) {
  const auto cell = parse_cell("scene: table\nworkspace: {min: [0, 0, 0], max: [1, 1, 1]}\n");
  ASSERT_TRUE(cell.ok());
  EXPECT_FALSE(cell->arm);
  EXPECT_TRUE(cell->camera.command.empty());
}

TEST(Cell, WhatIsWrongIsToldWithItsPlace) {
  const auto expect_refused = [](const std::string& yaml, const std::string& words) {
    const auto cell = parse_cell(yaml);
    ASSERT_FALSE(cell.ok()) << yaml;
    EXPECT_EQ(cell.error().code, Errc::corrupt_data);
    EXPECT_NE(cell.error().to_string().find(words), std::string::npos) << cell.error().to_string();
    EXPECT_NE(cell.error().to_string().find("line"), std::string::npos) << cell.error().to_string();
  };
  expect_refused("arm: {tip: tool0}", "urdf");
  expect_refused("arm: {urdf: a.urdf, speeed: 0.1}", "unknown key speeed in an arm");
  expect_refused("arm: {urdf: a.urdf, speed: 1.5}", "at most 1");
  expect_refused("arm: {urdf: a.urdf, T_flange_camera: [[2,0,0,0],[0,1,0,0],[0,0,1,0]]}", "not a rotation");
  expect_refused("arm: {urdf: a.urdf, base_at: [1, 2]}", "[x, y, z]");
  expect_refused("camera: {timeout: 3}", "needs the key command");
  expect_refused("camera: {command: ' '}", "the command is empty");
  expect_refused("camera: {command: c, timeout: 0}", "positive");
  expect_refused("joints: {command: j}", "joints need an arm that plans");
  expect_refused("arm: {urdf: a.urdf}\nrobot: {command: r}", "exclude each other");
  expect_refused("tracking: gps", "forced, hint, icp or rgbd");
  expect_refused("free: [{min: [0, 0, 0], max: [0, 1, 1]}]", "the box is empty");
  expect_refused("free: [{min: [0, 0, -1e20], max: [1, 1, 1]}]", "a box reaches to -1e+20 m");
  expect_refused("fixtures: [{min: [0, 0, 0], max: [1, 1001, 1]}]", "within 1000 m");
  expect_refused("arm: {urdf: a.urdf, base_at: [1e19, 0, 0]}", "farther than a kilometre");
  expect_refused("arm: {urdf: a.urdf, T_flange_camera: [[1,0,0,0],[0,1,0,-2000],[0,0,1,0]]}",
                 "farther than a kilometre");
  expect_refused("[1, 2", "line");
}

TEST(Cell, AFileIsNamed) {
  const test::TempFolder folder;
  EXPECT_EQ(read_cell(folder / "none.yaml").error().code, Errc::not_found);
  std::ofstream{folder / "cell.yaml"} << "tracking: gps\n";
  EXPECT_NE(read_cell(folder / "cell.yaml").error().to_string().find("cell.yaml"), std::string::npos);
}

}  // namespace
}  // namespace saccade
