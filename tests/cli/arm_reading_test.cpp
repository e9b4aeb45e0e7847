// SPDX-License-Identifier: Apache-2.0
// --base, --base-at, --tip and their like in the commands that let an arm carry the camera.
#include <gtest/gtest.h>

#include <algorithm>

#include "run_program.hpp"
#include "saccade/arm/urdf.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

void replace_in(std::string& text, const std::string& from, const std::string& to) {
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
}

/// The built-in arm's description with another name for its camera's frame.
std::string urdf_with_eye(const std::string& eye) {
  std::string urdf{std::find_if(builtin_robots().begin(), builtin_robots().end(), [](const BuiltinRobot& robot) {
                     return robot.name == "comau_smart_six";
                   })->urdf};
  replace_in(urdf, "camera_optical_frame", eye);
  return urdf;
}

/// Such a description with a second chain as long, so that nothing tells which is the arm; its base lies in the world's
/// origin.
std::string ambiguous_urdf() {
  std::string urdf = urdf_with_eye("eye");
  replace_in(urdf, "xyz=\"-0.5 -0.75 0.4\" rpy=\"0 0 0.5235987755982988\"", "xyz=\"0 0 0\"");
  replace_in(urdf, "</robot>",
             "<link name=\"pointer\"/><joint name=\"joint_7\" type=\"revolute\"><parent link=\"link_5\"/>"
             "<child link=\"pointer\"/><axis xyz=\"0 0 1\"/>"
             "<limit lower=\"-1\" upper=\"1\" effort=\"0\" velocity=\"1\"/></joint></robot>");
  return urdf;
}

Outcome look_once(const fs::path& out, const Arguments& more) {
  return run_program(Arguments{"explore", tiny_cell_file(), "--out", out.string(), "--image-size", "96,72",
                               "--voxel-size", "0.015", "--max-views", "1", "--quiet"} +
                     more);
}

TEST(ArmReading, AnArmThatNeedsToBeToldIsTheOneThatNeedsNothing) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const std::string urdf = folder.write("arm.urdf", ambiguous_urdf()).string();
  expect_failure(look_once(folder / "untold", {"--robot", urdf}), 3, "explore",
                 {"name a tip: --tip flange (6 joints), --tip pointer (6 joints)"});

  const Arguments told{"--robot", urdf,     "--tip", "flange",    "--camera-frame",
                       "eye",     "--base", "base",  "--base-at", "-0.5,-0.75,0.4,30"};
  const Outcome outcome = look_once(folder / "told", told + Arguments{"--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Outcome plain = look_once(folder / "plain", {"--no-pictures", "--json", "-"});
  ASSERT_EQ(plain.status, 0) << plain.err;
  const nlohmann::json result = outcome.json().at("result");
  const nlohmann::json& view = result.at("views").at(0);
  const nlohmann::json expected = plain.json().at("result").at("views").at(0);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      EXPECT_NEAR(view.at("T_world_camera").at(row).at(column).get<double>(),
                  expected.at("T_world_camera").at(row).at(column).get<double>(), 1e-6);
    }
  }
  EXPECT_EQ(result.at("arm_reading").at("tip"), "flange") << "so that saccade show draws the same arm";
  EXPECT_EQ(result.at("arm_reading").at("camera_frame"), "eye");
  EXPECT_EQ(plain.json().at("result").at("arm_reading"), nlohmann::json::object());
}

TEST(ArmReading, EveryCommandWithAnArmHasTheOptions) {
  for (const Arguments& command : {Arguments{"robot", "check"},
                                   {"robot", "reach"},
                                   {"explore"},
                                   {"update"},
                                   {"compare"},
                                   {"cell", "check"},
                                   {"calibrate"}}) {
    const Outcome outcome = run_program(command + Arguments{"--help"});
    EXPECT_EQ(outcome.status, 0);
    for (const char* option : {"--base LINK", "--base-at X", "--tip LINK", "--camera-frame LINK", "--package NAME",
                               "--package-path DIR", "--drop-beyond-tip"}) {
      EXPECT_NE(outcome.out.find(option), std::string::npos) << command.back() << ": " << option << "\n" << outcome.out;
    }
  }
}

TEST(ArmReading, ACellHasKeysForThem) {
  const TempFolder folder;
  folder.write("arm.urdf", ambiguous_urdf());
  const auto check = [&folder](const std::string& keys, const Arguments& more = {}) {
    const std::string cell = folder
                                 .write("cell.yaml", R"(cell: bench
workspace: {min: [-0.4, -0.4, -0.02], max: [0.4, 0.4, 0.3]}
scan: [{from: [0.0, -0.6, 0.5], look_at: [0, 0, 0.1]}]
arm: {urdf: arm.urdf)" + keys + "}\n")
                                 .string();
    return run_program(Arguments{"cell", "check", cell, "--json", "-"} + more);
  };
  const std::string place =
      ", base: base, base_at: [-0.5, -0.75, 0.4, 30], camera_frame: eye, packages: {p: folder}, "
      "package_paths: [folder], drop_beyond_tip: true";
  const Outcome told = check(place + ", tip: flange");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_EQ(told.json().at("result").at("scan").at("reached"), 1) << told.out;
  EXPECT_EQ(told.json().at("result").at("arm_choices"), nlohmann::json::array());
  EXPECT_NE(check(place + ", tip: hook").out.find("hook: there is no such link"), std::string::npos);
  EXPECT_EQ(check(place + ", tip: hook", {"--tip", "flange"}).status, 0) << "an option goes before the key";
  const std::string untold = check("").out;
  EXPECT_NE(untold.find("--tip flange (6 joints), --tip pointer (6 joints)"), std::string::npos) << untold;
}

TEST(ArmReading, WhatWasChosenIsSaid) {
  const TempFolder folder;
  const std::string urdf = folder.write("arm.urdf", urdf_with_eye("camera_depth_optical_frame")).string();
  const std::string said = "camera_depth_optical_frame is taken for the camera's optical frame";
  const Outcome check = run_program({"robot", "check", urdf});
  EXPECT_NE(check.out.find(said), std::string::npos) << check.out;
  const Arguments reach{"robot", "reach", urdf, "--step", "0.3", "--out", (folder / "reach").string(), "--force"};
  EXPECT_NE(run_program(reach).err.find("arm: " + said), std::string::npos);
  EXPECT_EQ(run_program(reach + Arguments{"--quiet"}).err, "");
  EXPECT_EQ(run_program(reach + Arguments{"--camera-frame", "camera_depth_optical_frame"}).err.find(said),
            std::string::npos);
  expect_failure(run_program({"robot", "check", urdf, "--camera-frame", "camera_depth_frame"}), 3, "robot",
                 {"camera_depth_frame: there is no such link", "names like it: camera_depth_optical_frame"});
}

TEST(ArmReading, IsForArms) {
  const TempFolder folder;
  expect_failure(look_once(folder / "free", {"--robot", "free", "--tip", "flange"}), 2, "explore", {"--tip", "an arm"});
  expect_failure(look_once(folder / "free", {"--robot", "free", "--drop-beyond-tip"}), 2, "explore",
                 {"--drop-beyond-tip", "an arm"});
  expect_failure(look_once(folder / "x", {"--base-at", "1,2"}), 2, "explore", {"--base-at", "X,Y,Z"});
  expect_failure(look_once(folder / "x", {"--tip", "hook"}), 3, "explore", {"hook"});
  expect_failure(run_program({"compare", "--scenes", "jug", "--out", (folder / "c").string(), "--base", "base"}), 2,
                 "compare", {"--base", "an arm"});
  expect_failure(run_program({"compare", "--scenes", "jug", "--out", (folder / "c").string(), "--robot", "comau",
                              "--tip", "hook"}),
                 3, "compare", {"hook"});
  expect_failure(run_program({"update", "--scene", "jug", "--out", (folder / "u").string(), "--tip", "hook"}), 3,
                 "update", {"hook"});
}

}  // namespace
}  // namespace saccade::test
