// SPDX-License-Identifier: Apache-2.0
// A cell of programs in devices/, looked at by the command line; how long the ones to start from are.
#include "cli/run_program.hpp"
#include "device_programs.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade::test {
namespace {

TEST(CellOfDevices, AFolderAndTheJointsExampleMakeACell) {
  const TempFolder folder;
  folder.write("camera-intrinsics.txt", "40 0 19.5\n0 40 14.5\n0 0 1\n");
  ASSERT_TRUE(write_png16(folder / "a.depth.png", Image16{40, 30, 1234}));
  std::ostringstream pose;
  pose << look_at({0.0, -0.6, 0.5}, {0.0, 0.0, 0.1}).matrix();
  folder.write("a.pose.txt", pose.str());
  const auto write_cell = [&](const std::string& camera) {
    folder.write("cell.yaml",
                 "cell: bench\nworkspace: {min: [-0.4, -0.4, -0.02], max: [0.4, 0.4, 0.3]}\n"
                 "scan: [{from: [0.0, -0.6, 0.5], look_at: [0, 0, 0.1]}]\narm: {robot: comau_smart_six}\n"
                 "joints: {command: \"" +
                     device_command("joints-example", "", "") + "\"}\ncamera: {command: \"" + camera + "\"}\n");
    return run_program({"cell", "check", (folder / "cell.yaml").string(), "--json", "-"});
  };
  // Where the joints stand in the beginning, the camera is far from where the frame was taken.
  const Outcome far = write_cell(device_command("folder-camera", "", "."));
  EXPECT_EQ(far.status, 5) << far.err;
  const nlohmann::json problems = far.json().at("result").at("problems");
  ASSERT_EQ(problems.size(), 1U) << far.out;
  EXPECT_NE(problems[0].get<std::string>().find("m from the pose asked for"), std::string::npos) << problems;
  EXPECT_EQ(far.json().at("result").at("q").size(), 6U);
  fs::remove(folder / "a.pose.txt");
  const Outcome checked = write_cell(device_command("folder-camera", "", ". --in-order"));
  EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
}

TEST(DevicesToStartFrom, HaveNoMoreThanEightyLines) {
  for (const char* name : {"camera.py", "hand.py", "joints.py", "joints.cpp"}) {
    std::ifstream file{source_folder() / "devices" / name};
    const auto lines = std::count(std::istreambuf_iterator<char>{file}, {}, '\n');
    EXPECT_GT(lines, 20) << name;
    EXPECT_LE(lines, 80) << name;
  }
}

}  // namespace
}  // namespace saccade::test
