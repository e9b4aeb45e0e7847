// SPDX-License-Identifier: Apache-2.0
// saccade explore with cameras and robots that are programs of their own.
#include <gtest/gtest.h>

#include <fstream>

#include "report_page.hpp"
#include "run_program.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

constexpr const char* kCell{R"(scene: cell
workspace: {min: [-0.4, -0.4, -0.02], max: [0.4, 0.4, 0.3]}
scan:
  - {from: [0.0, -0.6, 0.5], look_at: [0, 0, 0.1]}
)"};

std::string example(const std::string& name) {
  return "python3 '" + (source_folder() / "examples" / name).string() + "'";
}

std::string camera_py() { return "python3 '" + (source_folder() / "devices/camera.py").string() + "'"; }

class ExploreProcesses : public ::testing::Test {
 protected:
  ExploreProcesses() { std::ofstream{cell()} << kCell; }
  [[nodiscard]] fs::path cell() const { return folder_ / "cell.yaml"; }
  [[nodiscard]] fs::path run() const { return folder_ / "run"; }
  [[nodiscard]] Outcome explore(const Arguments& more) const {
    return run_program(Arguments{"explore", cell().string(), "--out", run().string(), "--voxel-size", "0.02",
                                 "--max-views", "2", "--min-gain", "5", "--quiet"} +
                       more);
  }
  TempFolder folder_;
};

TEST_F(ExploreProcesses, ACameraAndARobotThatAreProgramsBuildAMap) {
  const Outcome outcome = explore({"--camera-command", camera_py(), "--robot-command", example("external_robot.py"),
                                   "--radius", "0.6", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("robot"), "external");
  EXPECT_EQ(result.at("camera").at("width"), 160);
  ASSERT_EQ(result.at("views").size(), 2U);
  EXPECT_TRUE(result.at("final").at("coverage").is_null());  // there is no truth
  EXPECT_LT(result.at("views")[1].at("unknown_left").get<int>(), result.at("initial").at("unknown_left").get<int>());
  const auto map = load_map(run() / "map.sacmap");
  ASSERT_TRUE(map);
  EXPECT_EQ(map->grid.state(voxel_at({0.2, -0.2, 0.2}, 0.02)), VoxelState::empty);
  EXPECT_EQ(map->grid.state(voxel_at({0.2, -0.2, -0.005}, 0.02)), VoxelState::occupied);  // the plane
  EXPECT_EQ(report_in(run() / "report.html").at("record").at("result"), result);

  // No command writes over the frames of a program, unless told so.
  const Arguments simulated{"explore", "bottle",  "--robot", "free",        "--max-views",
                            "0",       "--quiet", "--out",   run().string()};
  const Arguments programs{"--camera-command", camera_py(), "--robot-command", example("external_robot.py")};
  for (const Outcome& again : {run_program(simulated), explore(programs), explore(programs + Arguments{"--dry-run"})}) {
    expect_failure(again, 3, "explore", {run().string(), "real camera", "--force"});
  }
  EXPECT_EQ(report_in(run() / "report.html").at("record").at("result"), result);
  for (const char* other : {"[]", "{\"result\": [1]}", "{\"result\": {\"unrepeatable\": \"x\"}}", "{"}) {
    std::ofstream{run() / "run.json"} << other;
    EXPECT_EQ(run_program(simulated).status, 0) << other;
  }
}

TEST_F(ExploreProcesses, ACameraThatFailsIsOneLineAndWhatWasSeenIsKept) {
  const auto camera = [&](const std::string& body, const char* timeout_s = "60") {
    const fs::path script = folder_ / "camera.py";
    std::ofstream{script}
        << "import json, sys\n"
           "hello = {'saccade': 1, 'width': 40, 'height': 30, 'fx': 40, 'fy': 40, 'cx': 19.5,\n"
           "         'cy': 14.5, 'min_range_m': 0.1, 'max_range_m': 3, 'depth': 'uint16_mm',\n"
           "         'color': 'none'}\n"
           "def say(message, data=b''):\n"
           "    sys.stdout.buffer.write(json.dumps(message).encode() + b'\\n' + data)\n"
           "    sys.stdout.buffer.flush()\n"
           "depth = (700).to_bytes(2, 'little') * 1200\n"
           "for line in sys.stdin:\n"
           "    request = json.loads(line)\n"
           "    if request['request'] == 'hello': say(hello)\n"
           "    elif request['number'] < 7: say({'number': request['number'], 'bytes': 2400}, depth)\n"
           "    else: "
        << body << "\n";
    return explore(
        {"--camera-command", "python3 '" + script.string() + "'", "--process-timeout", timeout_s, "--force"});
  };
  const auto kept = [&] {
    EXPECT_TRUE(fs::exists(run() / "journal.json"));  // with the scan, and the way to go on
    EXPECT_TRUE(load_map(run() / "checkpoint-0.sacmap"));
  };
  expect_failure(camera("sys.exit('the cable is out')"), 3, "explore", {"camera", "the cable is out", "--resume"});
  kept();
  expect_failure(camera("import time; time.sleep(100)", "5"), 3, "explore", {"camera", "5 s"});
  kept();
  expect_failure(camera("print('hello world', flush=True)"), 3, "explore", {"camera", "hello world"});
  kept();
  expect_failure(camera("say({'number': request['number'], 'bytes': 12}, b'x' * 12)"), 3, "explore", {"camera", "12"});
  kept();
  expect_failure(camera("say({'error': 'too warm'})"), 4, "explore", {"camera", "too warm"});
  kept();
  std::string moved = text_of(cell());
  moved.insert(moved.find("max: [") + 6, "1");
  std::ofstream{cell()} << moved;
  const std::string same = "python3 '" + (folder_ / "camera.py").string() + "'";
  expect_failure(explore({"--camera-command", same, "--resume"}), 3, "explore", {"had workspace", "start anew"});
  std::ofstream{cell()} << kCell;
  expect_failure(explore({"--camera-command", "/nowhere/camera", "--force"}), 3, "explore", {"/nowhere/camera"});
}

TEST_F(ExploreProcesses, ARobotAloneMovesTheSimulatedCamera) {
  const Outcome outcome = run_program({"explore", tiny_cell_file(), "--out", run().string(), "--image-size", "96,72",
                                       "--voxel-size", "0.015", "--max-views", "1", "--no-pictures", "--quiet",
                                       "--json", "-", "--robot-command", example("external_robot.py")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_GT(result.at("initial").at("views"), 0);
  EXPECT_EQ(result.at("views").size(), 1U);
  EXPECT_GT(result.at("final").at("coverage"), result.at("initial").at("coverage"));
}

}  // namespace
}  // namespace saccade::test
