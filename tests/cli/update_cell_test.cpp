// SPDX-License-Identifier: Apache-2.0
// saccade update with a cell whose camera, joints and hand are programs of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "report_page.hpp"
#include "run_program.hpp"
#include "saccade/io/files/json_io.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

using nlohmann::json;

/// A table on which a hand puts a bottle down.
class UpdateCell : public ::testing::Test {
 protected:
  UpdateCell() {
    // How the hand moves, from the simulation of the task.
    const Outcome simulated =
        run_program({"update", "--scene", "bottle", "--out", (folder_ / "simulated").string(), "--robot", "free",
                     "--max-views", "0", "--image-size", "80,60", "--voxel-size", "0.02", "--no-pictures", "--quiet"});
    EXPECT_TRUE(fs::exists(folder_ / "simulated/hand.csv")) << simulated.err;
    // A tracker that plays it at once, once; the bottle is there when the hand has left.
    std::ofstream{folder_ / "hand.py"} << "import csv, json, sys\n"
                                          "rows = iter(list(csv.reader(open('simulated/hand.csv')))[1:])\n"
                                          "for line in sys.stdin:\n"
                                          "    r = json.loads(line)\n"
                                          "    if r['request'] == 'hello': print('{\"saccade\": 1}', flush=True)\n"
                                          "    else:\n"
                                          "        row = next(rows, None)\n"
                                          "        if row is None: open('put-down', 'w').close()\n"
                                          "        said = {'end': True} if row is None else {'time_s': float(row[0]),\n"
                                          "            'position': [float(x) for x in row[1:4]]}\n"
                                          "        print(json.dumps({'number': r['number'], **said}), flush=True)\n";
  }
  [[nodiscard]] fs::path cell() const { return folder_ / "cell.yaml"; }
  void write(const std::string& hand) const {
    const fs::path bin = fs::path{saccade_program()}.parent_path();
    std::ofstream{cell()} << text_of(source_folder() / "scenes/bottle-before.yaml") << "arm: {robot: comau_smart_six}\n"
                          << "joints: {command: \"'" << (bin / "saccade-simulated-arm").string()
                          << "' --state state --rate 8 --log log\", watchdog: 2}\n"
                          << "camera: {command: \"'" << (bin / "saccade-simulated-camera").string()
                          << "' --scene bottle-before --then bottle --when put-down --state state --width 160\"}\n"
                          << hand;
  }
  [[nodiscard]] Arguments update(const Arguments& more) const {
    return Arguments{"update",  cell().string(), "--out", (folder_ / "run").string(), "--voxel-size", "0.01",
                     "--quiet", "--json",        "-"} +
           more;
  }
  /// Tells whether the arm was ever told to move.
  [[nodiscard]] bool moved() const { return text_of(folder_ / "log").find("follow") != std::string::npos; }
  TempFolder folder_;
};

TEST_F(UpdateCell, TheRobotLooksAgainWhereTheHandHasPutSomethingDown) {
  write("hand: {command: python3 -B hand.py}\n");
  const Outcome outcome = run_program(update({}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json result = outcome.json().at("result");
  ASSERT_EQ(result.at("tasks").size(), 1U);
  const json& task = result.at("tasks")[0];
  EXPECT_GT(task.at("samples").at("total").get<int>(), 50);
  EXPECT_EQ(task.at("stopped_because"), "regions_done");
  EXPECT_TRUE(task.at("back").at("at_stand_by").get<bool>());
  ASSERT_GE(task.at("regions").size(), 1U);
  EXPECT_EQ(task.at("regions").size(), task.at("actions").size());
  for (const json& region : task.at("regions")) {
    EXPECT_EQ(region.at("end"), "done");
    const json& unknown = region.at("unknown");  // after the task, then after each view
    ASSERT_EQ(unknown.size(), task.at("views").size() + 1);
    EXPECT_LT(unknown.back().get<double>(), 0.4 * unknown.front().get<double>());
  }
  EXPECT_GE(task.at("views").size(), 1U);
  for (const char* file : {"map.sacmap", "mesh.ply", "update.json", "map.png", "task-1/hand.csv", "task-1/hand.png",
                           "task-1/regions.png", "task-1/view-01-map.png"}) {
    EXPECT_TRUE(fs::exists(folder_ / "run" / file)) << file;
  }
  const json page = report_in(folder_ / "run/report.html");
  ASSERT_EQ(page.at("record").at("result").at("tasks").size(), 1U);
  EXPECT_EQ(page.at("record").at("result").at("tasks")[0], task);
  const json& files = page.at("files");
  EXPECT_NE(std::find(files.begin(), files.end(), "task-1/view-01-map.png"), files.end());
  const json of_task = report_in(folder_ / "run/task-1/report.html");
  EXPECT_EQ(of_task.at("record").at("result").at("cell"), "bottle-before");
  EXPECT_EQ(of_task.at("record").at("result").at("task_number"), 1);
  EXPECT_EQ(of_task.at("record").at("result").at("views"), task.at("views"));
  EXPECT_GT(of_task.at("details").at("speed").at("time_s").size(), 1U);
}

TEST_F(UpdateCell, ARecordingStandsInForTheTracker) {
  write("");
  const Arguments recorded{"--trajectory", (folder_ / "simulated/hand.csv").string(), "--max-views", "1"};
  const Outcome outcome = run_program(update(recorded));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("tasks").size(), 1U);
  expect_failure(run_program({"update", cell().string(), "--out", (folder_ / "none").string(), "--quiet"}), 3, "update",
                 {"nothing tracks the hand", "--hand-command"});
  expect_failure(run_program({"update", cell().string(), "--scene", "bottle", "--quiet"}), 2, "update", {"--scene"});
}

TEST_F(UpdateCell, RegionsThatAFailureLeftAreLookedAtWhenTheRunGoesOn) {
  write("hand: {command: python3 -B hand.py}\n");
  const std::string cell_as_it_works = text_of(cell());
  std::string broken = cell_as_it_works;
  const std::string width = "--width 160";  // the scan has 40 frames; the first view of the task is taken
  broken.replace(broken.find(width), width.size(), width + " --fault error --after 47");
  std::ofstream{cell()} << broken;
  const Outcome failed = run_program(update({}));
  expect_failure(failed, 4, "update", {"the cable is loose", "is kept, add --resume"});
  const json before = json::parse(text_of(folder_ / "run/update.json")).at("result");
  ASSERT_EQ(before.at("tasks").size(), 1U);
  EXPECT_EQ(before.at("tasks")[0].at("stopped_because"), "device_failed");
  EXPECT_EQ(before.at("tasks")[0].at("views").size(), 1U);
  // What is no run of ours is refused, and stays as it is.
  const std::string kept = text_of(folder_ / "run/update.json");
  for (const char* wrong : {"{\"result\": {\"scanned\": true, \"tasks\": [5]}}",
                            "{\"result\": {\"scanned\": true, \"tasks\": [{}]}}", "{\"result\": {}}", "{"}) {
    std::ofstream{folder_ / "run/update.json"} << wrong;
    expect_failure(run_program(update({"--resume"})), 3, "update", {"update.json"});
    EXPECT_EQ(text_of(folder_ / "run/update.json"), wrong);
  }
  std::ofstream{folder_ / "run/update.json"} << kept;
  // The devices work again, and the hand does not come back.
  std::ofstream{cell()} << cell_as_it_works;
  std::ofstream{folder_ / "hand.py"} << "import sys\n"
                                        "for said in ('{\"saccade\": 1}', '{\"number\": 0, \"end\": true}'):\n"
                                        "    sys.stdin.readline()\n"
                                        "    print(said, flush=True)\n";
  const Outcome outcome = run_program(update({"--resume"}));
  ASSERT_TRUE(outcome.status == 0) << outcome.err;
  const json result = outcome.json().at("result");
  ASSERT_EQ(result.at("tasks").size(), 2U);
  const json& after = result.at("tasks")[1];
  EXPECT_EQ(after.at("regions_left_before"), before.at("tasks")[0].at("regions").size());
  EXPECT_EQ(after.at("stopped_because"), "regions_done");
  EXPECT_GE(after.at("views").size(), 1U);
  expect_failure(run_program({"update", "--scene", "bottle", "--resume", "--quiet"}), 2, "update", {"--resume"});
}

TEST_F(UpdateCell, AKillWhileTheRobotLooksLosesNoRegion) {
  write("hand: {command: python3 -B hand.py}\n");
  RunningProgram looking{update({})};
  const fs::path file = folder_ / "run/update.json";
  const auto has_task = [&] {
    const json document = fs::exists(file) ? json::parse(text_of(file), nullptr, false) : json{};
    return document.is_object() && !document.at("result").at("tasks").empty();
  };
  for (int i = 0; i < 600 && !has_task(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds{50});
  looking.send(SIGKILL);
  static_cast<void>(looking.finish());
  ASSERT_TRUE(has_task());
  const json task = json::parse(text_of(file)).at("result").at("tasks")[0];
  ASSERT_GE(task.at("regions").size(), 1U);
  EXPECT_EQ(task.at("stopped_because"), "interrupted");
  for (const json& region : task.at("regions")) EXPECT_EQ(region.at("end"), "not_begun");
}

TEST_F(UpdateCell, AKillWhileTheHandIsWaitedForLosesNoScan) {
  std::ofstream{folder_ / "hand.py"}
      << "import sys, time\nsys.stdin.readline()\nprint('{\"saccade\": 1}', flush=True)\n"
         "sys.stdin.readline()\ntime.sleep(60)\n";
  write("hand: {command: python3 -B hand.py}\n");
  RunningProgram waiting{update({})};
  const fs::path file = folder_ / "run/update.json";
  for (int i = 0; i < 600 && !fs::exists(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds{50});
  waiting.send(SIGKILL);
  static_cast<void>(waiting.finish());
  ASSERT_TRUE(fs::exists(file));
  EXPECT_TRUE(json::parse(text_of(file)).at("result").at("scanned").get<bool>());
  std::ofstream{folder_ / "hand.py"}
      << "import sys\nfor said in ('{\"saccade\": 1}', '{\"number\": 0, \"end\": true}'):\n"
         "    sys.stdin.readline()\n    print(said, flush=True)\n";
  const std::string before = text_of(folder_ / "run/map.sacmap");
  const Outcome outcome = run_program(update({"--resume"}));
  EXPECT_TRUE(outcome.status == 0 || outcome.status == 5) << outcome.err;
  EXPECT_EQ(text_of(folder_ / "run/map.sacmap"), before);  // nothing was looked at anew
}

TEST_F(UpdateCell, ADryRunPlansForTheTaskAndMovesNothing) {
  write("hand: {command: python3 -B hand.py}\n");
  const Outcome outcome = run_program(update({"--dry-run"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json result = outcome.json().at("result");
  EXPECT_TRUE(result.at("dry_run").get<bool>());
  ASSERT_EQ(result.at("tasks").size(), 1U);
  EXPECT_EQ(result.at("tasks")[0].at("views").size(), 1U);  // planned
  EXPECT_TRUE(fs::exists(folder_ / "run/task-1/view-01-map.png"));
  EXPECT_FALSE(moved());
  expect_failure(run_program({"update", "--scene", "bottle", "--dry-run", "--quiet"}), 2, "update", {"--dry-run"});
}

}  // namespace
}  // namespace saccade::test
