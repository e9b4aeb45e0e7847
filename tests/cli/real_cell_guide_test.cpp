// SPDX-License-Identifier: Apache-2.0
// Runs the commands of docs/guides/real-cell.md, one after the other, in the cell of examples/cell.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "run_program.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

/// Lines of code blocks that run the program.
std::vector<std::string> commands_of_guide() {
  std::vector<std::string> commands;
  std::istringstream page{text_of(source_folder() / "docs/guides/real-cell.md")};
  bool code = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) code = !code;
    if (code && line.starts_with("saccade ")) commands.push_back(line);
  }
  return commands;
}

/// The output of the calibration goes into the cell's file, as the guide says.
void enter_calibration(const fs::path& cell, const std::string& printed) {
  std::string text = text_of(cell);
  const auto after = [&](const std::string& key, const std::string& lines) {
    const std::size_t at = text.find("\n" + key + ":\n");
    ASSERT_NE(at, std::string::npos) << key;
    text.insert(at + key.size() + 3, lines);
  };
  const std::size_t mount = printed.find("  T_flange_camera:\n");
  const std::size_t camera = printed.find("camera:\n  clock_offset:");
  ASSERT_NE(mount, std::string::npos) << printed;
  ASSERT_NE(camera, std::string::npos) << printed;
  after("arm", printed.substr(mount, camera - mount));
  after("camera", printed.substr(camera + std::string{"camera:\n"}.size()));
  std::ofstream{cell} << text;
}

TEST(RealCellGuide, ItsTenCommandsRun) {
  const TempFolder folder;
  for (const char* file : {"cell.yaml", "scene.yaml", "scene-after.yaml"}) {
    fs::copy_file(source_folder() / "examples/cell" / file, folder / file);
  }
  fs::copy_file(source_folder() / "robots/ur_like.urdf", folder / "arm.urdf");
  const std::string programs = fs::path{saccade_program()}.parent_path().string();
  const std::vector<std::string> commands = commands_of_guide();
  ASSERT_EQ(commands.size(), 10U);
  for (const std::string& command : commands) {
    const std::string line =
        "cd '" + folder.path().string() + "' && PATH='" + programs + "':$PATH && " + command + " >said 2>&1 </dev/null";
    const int status = std::system(line.c_str());  // NOLINT(concurrency-mt-unsafe): the guide is for a shell
    const std::string said = text_of(folder / "said");
    ASSERT_EQ(status, 0) << command << '\n' << said;
    if (command.starts_with("saccade calibrate")) enter_calibration(folder / "cell.yaml", said);
  }
  for (const char* file : {"reach/reach.png", "check/camera.png", "rehearsal/report.html", "model/report.html",
                           "model/mesh.ply", "more/mesh.ply", "updates/report.html", "updates/task-1/report.html"}) {
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  }
}

}  // namespace
}  // namespace saccade::test
