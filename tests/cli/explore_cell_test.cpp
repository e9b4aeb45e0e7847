// SPDX-License-Identifier: Apache-2.0
// saccade explore with a cell: an arm that plans here and is moved by a program, and a camera behind another.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <functional>
#include <thread>

#include "report_page.hpp"
#include "run_program.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

constexpr const char* kBench{R"(cell: bench
workspace: {min: [-0.4, -0.4, -0.02], max: [0.4, 0.4, 0.3]}
scan:
  - {from: [0.0, -0.6, 0.5], look_at: [0, 0, 0.1]}
fixtures: [{min: [-0.6, -0.4, -0.1], max: [0.6, 0.4, -0.03]}]
arm: {robot: comau_smart_six}
)"};

class ExploreCell : public ::testing::Test {
 protected:
  /// Writes the cell with its programs.
  void write(const std::string& camera, const std::string& joints, const std::string& more = "") const {
    std::ofstream{cell()} << kBench << "camera: {command: \"" << camera << "\"}\njoints: {command: \"" << joints
                          << "\", watchdog: 2}\n"
                          << more;
  }
  static std::string python(const std::string& file) {
    return "python3 -B '" + (source_folder() / file).string() + "'";
  }
  static std::string ball() { return python("devices/camera.py"); }
  /// Eight times as fast as real ones. The folder is not read; it tells this test's programs from others.
  [[nodiscard]] std::string joints() const {
    return python("devices/joints.py") + " 8 '" + folder_.path().string() + "'";
  }
  [[nodiscard]] fs::path cell() const { return folder_ / "cell.yaml"; }
  [[nodiscard]] fs::path run() const { return folder_ / "run"; }
  [[nodiscard]] Arguments explore(const Arguments& more) const {
    return Arguments{"explore", cell().string(), "--out", run().string(), "--voxel-size", "0.02", "--max-views",
                     "2",       "--min-gain",    "1",     "--quiet",      "--no-pictures"} +
           more;
  }
  TempFolder folder_;
};

TEST_F(ExploreCell, AnArmBehindAProgramPlansAndExplores) {
  write(ball(), joints(), "tracking: hint\n");
  const Outcome outcome = run_program(explore({"--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("robot"), "comau_smart_six");
  ASSERT_EQ(result.at("views").size(), 2U);
  EXPECT_TRUE(result.at("final").at("coverage").is_null());
  for (const nlohmann::json& view : result.at("views")) {
    EXPECT_GT(view.at("motion_s").get<double>(), 0.1);
    EXPECT_GT(view.at("path_m").get<double>(), 0.01);
    EXPECT_EQ(view.at("q").size(), 6U);
    const nlohmann::json& tracking = view.at("tracking");
    EXPECT_EQ(tracking.at("tracked").get<int>() + tracking.at("refused").get<int>(), view.at("frames").get<int>());
    EXPECT_LT(tracking.at("correction_m").get<double>(), 0.02);  // the camera sees exactly what is there
  }
  EXPECT_LT(result.at("views")[1].at("unknown_left").get<int>(), result.at("initial").at("unknown_left").get<int>());

  // From its map another run goes on, without a scan.
  const Outcome more = run_program({"explore", cell().string(), "--out", (folder_ / "more").string(), "--voxel-size",
                                    "0.02", "--max-views", "1", "--min-gain", "1", "--quiet", "--no-pictures", "--json",
                                    "-", "--map", (run() / "map.sacmap").string()});
  ASSERT_TRUE(more.status == 0 || more.status == 5) << more.err;
  const nlohmann::json next = more.json().at("result");
  EXPECT_EQ(next.at("initial").at("views"), 0);
  EXPECT_LE(next.at("initial").at("unknown_left").get<int>(), result.at("final").at("unknown_left").get<int>());
  expect_failure(run_program({"explore", cell().string(), "--out", (folder_ / "finer").string(), "--quiet", "--map",
                              (run() / "map.sacmap").string()}),
                 3, "explore", {"map.sacmap", "20.00 mm", "--voxel-size"});
}

/// Programs of a simulated cell: the camera sits 8 mm and 2° off from where the description has it.
class SimulatedCell : public ExploreCell {
 protected:
  void write_simulated() const {
    const fs::path bin = fs::path{saccade_program()}.parent_path();
    const std::string scene = text_of(source_folder() / "scenes/tabletop-1.yaml");
    std::ofstream{cell()} << scene << "arm: {robot: comau_smart_six}\n"
                          << "joints: {command: \"'" << (bin / "saccade-simulated-arm").string()
                          << "' --state state --delay 0.02 --rate 4 --log log\", watchdog: 2}\n"
                          << "camera: {command: \"'" << (bin / "saccade-simulated-camera").string()
                          << "' --scene tabletop-1 --state state --width 160 --clock -0.035"
                          << " --mount 0.005,-0.004,0.0045,1.2,-1.2,1\"}\n";
  }
};

TEST_F(SimulatedCell, ACheckSaysWhatEachDeviceDelivers) {
  write_simulated();
  const Outcome outcome = run_program({"cell", "check", cell().string(), "--out", (folder_ / "check").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* words : {"arm      comau_smart_six, 6 joints", "joints   stand at", "scan     2 of 2 poses",
                            "camera   160 × 120 pixels", "mount    "}) {
    EXPECT_NE(outcome.out.find(words), std::string::npos) << words << '\n' << outcome.out;
  }
  EXPECT_TRUE(fs::exists(folder_ / "check/camera.png"));
  write("/nowhere/camera", joints());
  const Outcome broken = run_program({"cell", "check", cell().string(), "--json", "-"});
  EXPECT_EQ(broken.status, 5);
  const nlohmann::json result = broken.json().at("result");
  ASSERT_EQ(result.at("problems").size(), 1U) << broken.out;
  EXPECT_NE(result.at("problems")[0].get<std::string>().find("/nowhere/camera"), std::string::npos);
  EXPECT_EQ(result.at("q").size(), 6U);
}

TEST_F(SimulatedCell, ADryRunPlansAndDrawsAndMovesNothing) {
  write_simulated();
  const Arguments rehearsal{"explore",      cell().string(), "--dry-run", "--out",
                            run().string(), "--voxel-size",  "0.02",      "--quiet"};
  ASSERT_EQ(run_program(rehearsal).status, 0);
  const Outcome outcome = run_program(rehearsal);  // a rehearsal may be written over
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* words : {"dry run   nothing has moved", "scan      2 of 2 poses can be taken", "view      from ("}) {
    EXPECT_NE(outcome.out.find(words), std::string::npos) << words << '\n' << outcome.out;
  }
  const nlohmann::json result = nlohmann::json::parse(text_of(run() / "run.json")).at("result");
  EXPECT_TRUE(result.at("dry_run").get<bool>());
  EXPECT_EQ(result.at("views").size(), 1U);
  EXPECT_GT(result.at("views")[0].at("motion_s").get<double>(), 0.0);
  EXPECT_EQ(report_in(run() / "report.html").at("record").at("result").at("dry_run"), true);
  EXPECT_EQ(text_of(folder_ / "log").find("follow"), std::string::npos);
  expect_failure(run_program({"explore", cell().string(), "--dry-run", "--step", "--out", run().string()}), 2,
                 "explore", {"--dry-run"});
}

TEST_F(SimulatedCell, WhatWasSeenBeforeAnEarlyFailureIsKept) {
  write_simulated();
  const std::string works = text_of(cell());
  std::string broken = works;
  const std::string width = "--width 160";
  broken.replace(broken.find(width), width.size(),
                 width + " --fault error --after 3");  // out of the first pose's five frames
  std::ofstream{cell()} << broken;
  const Arguments explore{"explore",       cell().string(), "--out",       run().string(),
                          "--voxel-size",  "0.02",          "--max-views", "0",
                          "--no-pictures", "--quiet",       "--json",      "-"};
  expect_failure(run_program(explore), 4, "explore", {"the cable is loose", "is kept, add --resume"});
  std::string moved = works;
  moved.insert(moved.find("max: [") + 6, "1");
  std::ofstream{cell()} << moved;
  expect_failure(run_program(explore + Arguments{"--resume"}), 3, "explore", {"the interrupted run had", "start anew"});
  std::ofstream{cell()} << works;
  const Outcome outcome = run_program(explore + Arguments{"--resume"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("initial").at("views"), 2);
}

TEST_F(SimulatedCell, CalibrationFindsWhereTheCameraSits) {
  write_simulated();
  const Outcome outcome = run_program({"calibrate", cell().string(), "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  const Pose found = pose_from_json(result.at("T_flange_camera")).value();
  Pose off = Pose::Identity();
  off.translation() << 0.005, -0.004, 0.0045;
  off.linear() = (Eigen::AngleAxisd{to_rad(1.0), Eigen::Vector3d::UnitZ()} *
                  Eigen::AngleAxisd{to_rad(-1.2), Eigen::Vector3d::UnitY()} *
                  Eigen::AngleAxisd{to_rad(1.2), Eigen::Vector3d::UnitX()})
                     .toRotationMatrix();
  const Pose miss = (find_robot("comau").value().arm.description().T_flange_camera * off).inverse() * found;
  EXPECT_LT(miss.translation().norm(), 0.0015);
  EXPECT_LT(to_deg(Eigen::AngleAxisd{miss.linear()}.angle()), 0.2);
  EXPECT_LT(result.at("agreement_after").at("median_depth_m").get<double>(),
            result.at("agreement_before").at("median_depth_m").get<double>());
}

TEST_F(ExploreCell, WhatIsWrongWithTheFileIsSaidWithItsPlace) {
  std::ofstream{cell()} << kBench << "camera: {comand: x}\n";
  expect_failure(run_program(explore({})), 3, "explore", {"cell.yaml", "line 7", "command"});
}

/// A camera that answers until a number of frames was asked for, and hangs then.
std::string hanging_camera(const fs::path& script, int frames) {
  std::ofstream{script} << "import json, sys, time\n"
                           "hello = {'saccade': 1, 'width': 40, 'height': 30, 'fx': 40, 'fy': 40, 'cx': 19.5,\n"
                           "         'cy': 14.5, 'min_range_m': 0.1, 'max_range_m': 3, 'depth': 'uint16_mm',\n"
                           "         'color': 'none'}\n"
                           "for line in sys.stdin:\n"
                           "    r = json.loads(line)\n"
                           "    if r['request'] == 'hello': out = json.dumps(hello).encode() + b'\\n'\n"
                           "    elif r['number'] < "
                        << frames
                        << ": out = json.dumps({'number': r['number'], 'bytes': 2400}).encode() + b'\\n' +\\\n"
                           "        (700).to_bytes(2, 'little') * 1200\n"
                           "    else:\n"
                           "        open('hanging', 'w').close()\n"
                           "        time.sleep(1000)\n"
                           "    sys.stdout.buffer.write(out)\n"
                           "    sys.stdout.buffer.flush()\n";
  return "python3 -B '" + script.string() + "'";
}

/// Tells whether any process runs with the text in its command line.
bool runs(const std::string& text) {
  for (const auto& entry : fs::directory_iterator{"/proc"}) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file{entry.path() / "cmdline", std::ios::binary};
    const std::string line{std::istreambuf_iterator<char>{file}, {}};
    if (line.find(text) != std::string::npos && line.find("explore") == std::string::npos) return true;
  }
  return false;
}

bool comes_true(double longest_s, const std::function<bool()>& condition) {
  const Stopwatch watch;
  while (watch.elapsed_ms() < 1e3 * longest_s) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return condition();
}

TEST_F(ExploreCell, CtrlCEndsARunWhoseCameraHangsWithinASecond) {
  write(hanging_camera(folder_ / "camera.py", 7), joints());
  RunningProgram running{explore({})};
  ASSERT_TRUE(wait_for_file(folder_ / "hanging"));
  const Stopwatch watch;
  running.send(SIGINT);
  const Outcome outcome = running.finish();
  EXPECT_LT(watch.elapsed_ms(), 1000.0);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("--resume"), std::string::npos) << outcome.err;
  EXPECT_FALSE(runs(folder_.path().string()));
  EXPECT_TRUE(fs::exists(run() / "journal.json"));
  // With a camera that works, the run goes on.
  write(hanging_camera(folder_ / "camera.py", 100), joints());
  const Outcome resumed = run_program(explore({"--resume", "--json", "-"}));
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_GE(resumed.json().at("result").at("views").size(), 1U);
}

TEST_F(ExploreCell, NothingIsLeftOfItsProgramsWhenItIsKilled) {
  for (const int signal : {SIGKILL, SIGHUP}) {
    fs::remove(folder_ / "hanging");
    write(hanging_camera(folder_ / "camera.py", 3), joints());
    RunningProgram running{explore({"--force"})};
    ASSERT_TRUE(wait_for_file(folder_ / "hanging"));
    running.send(signal);
    static_cast<void>(running.finish());
    EXPECT_TRUE(comes_true(5.0, [&] { return !runs(folder_.path().string()); })) << signal;
  }
}

}  // namespace
}  // namespace saccade::test
