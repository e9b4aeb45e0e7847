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
  EXPECT_EQ(result.at("left_open"), "none");
}

/// Seven joints whose axes point along z and y by turns, the last one `beside` metres from the one before.
std::string seven_joints(const std::string& beside) {
  std::string urdf = "<robot name=\"seven\"><link name=\"l0\"/>";
  const std::string origins[]{"0 0 0.3", "0 0 0", "0 0 0", "0 0 0.4", "0 0 0", "0 0 0.4", beside + " 0 0"};
  for (int i = 0; i < 7; ++i) {
    const std::string n = std::to_string(i + 1);
    urdf += "<link name=\"l" + n + "\"/><joint name=\"j" + n + "\" type=\"revolute\"><parent link=\"l" +
            std::to_string(i) + "\"/><child link=\"l" + n + "\"/><origin xyz=\"" +
            origins[static_cast<std::size_t>(i)] + "\"/><axis xyz=\"" + (i % 2 == 0 ? "0 0 1" : "0 1 0") +
            "\"/><limit lower=\"-2.5\" upper=\"2.5\" velocity=\"1\" effort=\"1\"/></joint>";
  }
  return urdf + "</robot>";
}

TEST(RobotCommand, SaysWhatAPoseLeavesOpen) {
  const TempFolder folder;
  const auto left_open = [&folder](const std::string& beside, const std::string& text) {
    const std::string file = folder.write("arm.urdf", seven_joints(beside)).string();
    const Outcome people = run_program({"robot", "check", file});
    EXPECT_NE(people.out.find("closed form; a pose leaves one value open, which is sampled: " + text),
              std::string::npos)
        << people.out;
    return run_program({"robot", "check", file, "--json", "-"}).json().at("result").at("left_open");
  };
  EXPECT_EQ(left_open("0", "the swivel of the elbow"), "swivel");
  EXPECT_EQ(left_open("0.09", "joint j7"), "last joint");
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
  expect_failure(
      run_program({"robot", "check", "comau_smart_six", "--package-path", folder.path().string() + ":/nowhere"}), 2,
      "robot", {"--package-path", "there is no folder /nowhere"});
  expect_failure(run_program({"robot"}), 2, "robot", {"name what to do: check or reach"});
  const Outcome fine = run_program({"robot", "check", file(with_axis("1")), "--json", "-"});
  EXPECT_EQ(fine.status, 0) << fine.err;
  EXPECT_EQ(fine.err, "");
  EXPECT_EQ(fine.json().at("result").at("inverse_kinematics"), "numeric");
  EXPECT_TRUE(fine.json().at("result").at("joints").at(0).at("upper").is_null());
  EXPECT_EQ(fine.json().at("result").at("notes").size(), 4U) << fine.out;
}

}  // namespace
}  // namespace saccade::test
