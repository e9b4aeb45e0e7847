// SPDX-License-Identifier: Apache-2.0
// saccade robot check.
#include <gtest/gtest.h>

#include "run_program.hpp"

namespace saccade::test {
namespace {

TEST(RobotCommand, SaysWhatItUnderstood) {
  const Outcome people = run_program({"robot", "check", "comau_smart_six"});
  EXPECT_EQ(people.status, 0) << people.err;
  for (const char* part : {"comau_smart_six, 6 joints", "-120.0 to 54.9°", "closed form", "camera_optical_frame"}) {
    EXPECT_NE(people.out.find(part), std::string::npos) << part << "\n" << people.out;
  }
  EXPECT_EQ(people.out.find("note"), std::string::npos) << people.out;
  const Outcome machine = run_program({"robot", "check", "comau_smart_six", "--json", "-"});
  expect_envelope(machine.json(), "robot");
  const auto result = machine.json().at("result");
  EXPECT_EQ(result.at("joints").size(), 6U);
  EXPECT_EQ(result.at("links").size(), 7U);
  EXPECT_EQ(result.at("inverse_kinematics"), "closed form");
}

TEST(RobotCommand, SaysWhatIsWrong) {
  const TempFolder folder;
  const auto file = [&folder](const std::string& content) { return folder.write("arm.urdf", content).string(); };
  const std::string arm = R"(<robot name="a"><link name="b"/><link name="c"/><joint name="j" type="continuous">
    <parent link="b"/><child link="c"/><axis xyz="0 0 AXIS"/></joint></robot>)";
  const auto with_axis = [&arm](const std::string& axis) {
    return std::string{arm}.replace(arm.find("AXIS"), 4, axis);
  };
  expect_failure(run_program({"robot", "check", file(with_axis("0"))}), 3, "robot",
                 {"arm.urdf, joint j: its axis has no length"});
  expect_failure(run_program({"robot", "check", file("hello")}), 3, "robot", {"no XML"});
  expect_failure(run_program({"robot", "check", file(with_axis("1")), "--camera-frame", "eye"}), 3, "robot",
                 {"eye: there is no such link to be the camera's frame"});
  expect_failure(run_program({"robot", "check", "hal"}), 3, "robot", {"no such robot; there are comau_smart_six"});
  expect_failure(run_program({"robot", "check", "comau_smart_six", "--package", "a"}), 2, "robot", {"NAME=FOLDER"});
  expect_failure(run_program({"robot"}), 2, "robot", {"subcommand"});
  const Outcome fine = run_program({"robot", "check", file(with_axis("1")), "--json", "-"});
  EXPECT_EQ(fine.status, 0) << fine.err;
  EXPECT_EQ(fine.err, "");
  EXPECT_EQ(fine.json().at("result").at("inverse_kinematics"), "numeric");
  EXPECT_TRUE(fine.json().at("result").at("joints").at(0).at("upper").is_null());
  EXPECT_EQ(fine.json().at("result").at("notes").size(), 3U) << fine.out;
}

}  // namespace
}  // namespace saccade::test
