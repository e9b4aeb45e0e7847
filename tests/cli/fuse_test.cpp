// SPDX-License-Identifier: Apache-2.0
// saccade fuse as a user runs it: results, JSON, run folders, continuing, interrupting.
#include <gtest/gtest.h>

#include "cli/run_program.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

const std::vector<std::string> kAllFiles{"fusion-first.png", "fusion-last.png", "fusion-middle.png", "map.sacmap",
                                         "mesh.ply",         "run.json",        "ternary.png",       "trajectory.txt"};

class Fuse : public ::testing::Test {
 protected:
  void SetUp() override { make_sample(folder_ / "frames", 21); }
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  [[nodiscard]] fs::path run() const { return folder_ / "run"; }
  nlohmann::json fused(const Arguments& more, const std::string& out = "run") const {
    const Outcome outcome = run_program(fuse(frames(), folder_ / out, more + Arguments{"--json", "-"}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    nlohmann::json document = outcome.json();
    expect_envelope(document, "fuse");
    return document;
  }
  TempFolder folder_;
};

TEST_F(Fuse, ForcedPosesGiveAllResults) {
  const nlohmann::json document = fused({"--tracking", "forced"});
  const nlohmann::json& result = document.at("result");
  EXPECT_EQ(result.at("tracking"), "forced");
  EXPECT_EQ(result.at("frames"), 21);
  EXPECT_EQ(result.at("lost"), 0);
  EXPECT_TRUE(result.at("skipped").empty());
  EXPECT_TRUE(result.at("lost_frames").empty());
  EXPECT_LT(result.at("depth_residual_m").at("median").get<double>(), 0.004);
  EXPECT_GT(result.at("depth_residual_m").at("median").get<double>(), 0.0);
  EXPECT_GT(result.at("depth_residual_m").at("share").get<double>(), 0.9);
  EXPECT_LE(result.at("depth_residual_m").at("share").get<double>(), 1.0);
  EXPECT_EQ(result.at("depth_residual_m").at("frames"), 3);
  EXPECT_TRUE(result.at("trajectory_error_m").is_null());
  EXPECT_GT(result.at("ms_per_frame").at("integrate").at("median").get<double>(), 0.0);
  EXPECT_GT(result.at("ms_per_frame").at("raycast").at("median").get<double>(), 0.0);
  EXPECT_TRUE(result.at("ms_per_frame").at("track").at("median").is_number());
  EXPECT_GT(result.at("map").at("bricks").get<int>(), 100);
  EXPECT_GT(result.at("map").at("bytes").get<int>(), 10000);
  EXPECT_GT(result.at("peak_rss_bytes").get<std::size_t>(), std::size_t{1} << 20U);

  EXPECT_EQ(names_in(run()), kAllFiles);
  EXPECT_EQ(nlohmann::json::parse(text_of(run() / "run.json")), document);
  const auto mesh = read_mesh(run() / "mesh.ply");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->triangles.size(), result.at("mesh").at("triangles").get<std::size_t>());
  EXPECT_GT(mesh->triangles.size(), 1000U);
  EXPECT_EQ(mesh->colors.size(), mesh->vertices.size());
  EXPECT_TRUE(load_map(run() / "map.sacmap"));
  const auto trajectory = read_tum_trajectory(run() / "trajectory.txt");
  ASSERT_TRUE(trajectory);
  EXPECT_EQ(trajectory->size(), 21U);
  for (const char* name : {"fusion-first.png", "fusion-middle.png", "fusion-last.png", "ternary.png"}) {
    const auto picture = read_color(run() / name);
    ASSERT_TRUE(picture) << name;
    EXPECT_GT(picture->width(), 300) << name;
  }
}

TEST_F(Fuse, IcpFollowsTheCameraWithoutPoses) {
  const nlohmann::json result = fused({"--tracking", "icp", "--every", "1"}).at("result");
  EXPECT_EQ(result.at("frames"), 21);
  EXPECT_EQ(result.at("lost"), 0);
  EXPECT_GT(result.at("trajectory_error_m").at("aligned_rmse").get<double>(), 0.0);
  EXPECT_LT(result.at("trajectory_error_m").at("aligned_rmse").get<double>(), 0.02);
  EXPECT_LT(result.at("trajectory_error_m").at("first_pose_rmse").get<double>(), 0.05);
  EXPECT_GE(result.at("trajectory_error_m").at("max").get<double>(),
            result.at("trajectory_error_m").at("aligned_rmse").get<double>());
  EXPECT_GT(result.at("ms_per_frame").at("track").at("median").get<double>(), 0.0);
}

TEST_F(Fuse, HintsAndTheDefaultTracking) {
  const nlohmann::json hint = fused({"--tracking", "hint", "--no-pictures", "--no-mesh"}).at("result");
  EXPECT_EQ(hint.at("frames"), 21);
  EXPECT_LT(hint.at("trajectory_error_m").at("aligned_rmse").get<double>(), 0.02);
  EXPECT_EQ(names_in(run()), (std::vector<std::string>{"map.sacmap", "run.json", "trajectory.txt"}));
  EXPECT_EQ(fused({"--no-pictures"}).at("result").at("tracking"), "forced");
  for (const std::string& name : names_in(frames())) {
    if (name.ends_with(".pose.txt")) fs::remove(frames() / name);
  }
  const nlohmann::json icp = fused({"--no-pictures", "--count", "3"}).at("result");
  EXPECT_EQ(icp.at("tracking"), "icp");
  EXPECT_EQ(icp.at("frames"), 3);
  EXPECT_TRUE(icp.at("trajectory_error_m").is_null());
}

TEST_F(Fuse, TheDirectionOfGravityGoesAlongWithTheWorldOfThePoses) {
  const std::string direction{"0.1 0 -0.9\n"};
  std::ofstream{frames() / "gravity-direction.txt"} << direction;
  const Arguments brief{"--no-pictures", "--no-mesh", "--count", "3"};
  static_cast<void>(fused(Arguments{"--tracking", "forced"} + brief));
  EXPECT_EQ(text_of(run() / "gravity-direction.txt"), direction);
  // ICP alone begins a world of its own; the earlier run's direction would be wrong in it.
  static_cast<void>(fused(Arguments{"--tracking", "icp"} + brief));
  EXPECT_EQ(names_in(run()), (std::vector<std::string>{"map.sacmap", "run.json", "trajectory.txt"}));
  // Among the frames the file is the user's.
  const Outcome beside = run_program(fuse(frames(), frames(), Arguments{"--tracking", "icp", "--force"} + brief));
  EXPECT_EQ(text_of(frames() / "gravity-direction.txt"), direction) << beside.err;
}

TEST_F(Fuse, PrintsASummaryForPeople) {
  const Outcome outcome = run_program(fuse(frames(), run(), {"--no-pictures"}));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* part : {"21 fused, 0 lost, 0 skipped", "forced (the folder has poses)", "mm median over", "MiB"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  }
}

TEST_F(Fuse, NeedsThreePosesForAnErrorOfTheTrajectory) {
  const auto text_with = [&](const char* count) {
    const Outcome outcome =
        run_program(fuse(frames(), run(), {"--tracking", "icp", "--no-pictures", "--no-mesh", "--count", count}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_EQ(text_with("1").find("RMSE"), std::string::npos);
  EXPECT_NE(text_with("3").find("RMSE aligned"), std::string::npos);
}

TEST_F(Fuse, WhatIsNotThereIsNoFolder) {
  const std::string bag = (folder_ / "nothere.bag").string();
  expect_failure(run_program({"fuse", bag, "--depth", "/depth", "--out", run().string()}), 3, "fuse",
                 {bag, "there is no such file or folder"});
}

TEST_F(Fuse, SaysWhereFramesWereTracked) {
  const nlohmann::json info = run_program({"info", "--json", "-"}).json().at("result");
  const Arguments brief{"--no-pictures", "--no-mesh", "--count", "3", "--backend"};
  const auto with = [&](const Arguments& more) { return run_program(fuse(frames(), run(), brief + more)); };
  expect_failure(with({"cuda", "--tracking", "forced"}), 3, "fuse", {"--backend", "--tracking forced"});
  expect_failure(with({"cuda", "--tracking", "icp", "--map-memory", "1MiB"}), 2, "fuse", {"--map-memory"});
  if (info.at("backends").at("cuda")) GTEST_SKIP() << "there is a GPU";
  expect_failure(with({"cuda", "--tracking", "icp"}), 4, "fuse", {info.at("cuda").at("absent_because")});
  const nlohmann::json compute =
      fused(Arguments{"--tracking", "icp"} + brief + Arguments{"auto"}).at("result").at("compute");
  EXPECT_EQ(compute, (nlohmann::json{{"wanted", "auto"}, {"used", "cpu"}, {"problem", nullptr}}));
}

TEST_F(Fuse, ProgressGoesToStandardErrorAsLines) {
  const Outcome outcome =
      run_program({"fuse", frames().string(), "--out", run().string(), "--voxel-size", "0.01", "--no-pictures"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("fusing\n"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("fusing: 21/21\n"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\033'), std::string::npos);
}

TEST_F(Fuse, ThreadsDoNotChangeTheMap) {
  fused({"--threads", "1", "--tracking", "icp", "--no-pictures"}, "one");
  fused({"--threads", "4", "--tracking", "icp", "--no-pictures"}, "four");
  const std::string map = text_of(folder_ / "one" / "map.sacmap");
  EXPECT_GT(map.size(), 10000U);
  EXPECT_TRUE(map == text_of(folder_ / "four" / "map.sacmap"));
  EXPECT_TRUE(text_of(folder_ / "one" / "mesh.ply") == text_of(folder_ / "four" / "mesh.ply"));
}

TEST_F(Fuse, ContinuingEqualsOneRun) {
  if (kSanitized) GTEST_SKIP() << "takes long under sanitizers; the next test goes on with a map, too";
  const Arguments plain{"--tracking", "forced", "--no-pictures", "--no-mesh"};
  fused(plain, "whole");
  fused(plain + Arguments{"--count", "9"}, "parts");
  const fs::path half = folder_ / "parts" / "map.sacmap";
  const Outcome outcome = run_program({"fuse", frames().string(), "--first", "9", "--continue", half.string(), "--out",
                                       (folder_ / "parts").string(), "--quiet", "--no-pictures", "--no-mesh"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(text_of(half) == text_of(folder_ / "whole" / "map.sacmap"));
  const nlohmann::json tracked = fused({"--tracking", "icp", "--first", "9", "--count", "5"}).at("result");
  EXPECT_EQ(tracked.at("frames"), 5);
}

TEST_F(Fuse, ContinuingWithIcpStartsAtTheFirstPose) {
  if (kSanitized) GTEST_SKIP() << "takes long under sanitizers; ContinuingEqualsOneRun goes on with a map, too";
  fused({"--tracking", "icp", "--no-pictures", "--count", "12"});
  const Outcome outcome =
      run_program({"fuse", frames().string(), "--tracking", "icp", "--first", "12", "--continue",
                   (run() / "map.sacmap").string(), "--out", (folder_ / "more").string(), "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("frames"), 9);
  EXPECT_EQ(outcome.json().at("result").at("lost"), 0);
}

TEST_F(Fuse, ContinuingWithoutPosesStartsAtTheLastTrackedPose) {
  for (const auto& file : fs::directory_iterator{frames()}) {
    if (file.path().string().ends_with(".pose.txt")) fs::remove(file);
  }
  fused({"--tracking", "icp", "--no-pictures", "--no-mesh", "--count", "18"});
  const auto went_on = [&](const fs::path& map) {
    const Outcome outcome =
        run_program({"fuse", frames().string(), "--first", "18", "--continue", map.string(), "--out",
                     (folder_ / "more").string(), "--quiet", "--no-pictures", "--json", "-", "--force", "--no-mesh"});
    const nlohmann::json document = outcome.json();  // none where no frame is tracked
    return document.is_object() ? document.at("result").at("frames").get<int>() : 0;
  };
  EXPECT_EQ(went_on(run() / "map.sacmap"), 3);
  fs::copy_file(run() / "map.sacmap", folder_ / "alone.sacmap");  // without its trajectory, from the first pose
  EXPECT_LT(went_on(folder_ / "alone.sacmap"), 3);
}

TEST_F(Fuse, AnEmptyFirstFrameTellsNothingOfTheOthers) {
  ASSERT_TRUE(write_png16(frames() / "frame-000000.depth.png", Image16{160, 120, 0}));
  const nlohmann::json result = fused({"--count", "3", "--no-mesh", "--no-pictures"}).at("result");
  EXPECT_EQ(result.at("frames"), 3);
  EXPECT_GT(result.at("depth_residual_m").at("valid_pixels").get<int>(), 0);
  EXPECT_GT(result.at("depth_residual_m").at("share").get<double>(), 0.5);
}

TEST_F(Fuse, MaskAndRangeAndWorkspaceReachTheMap) {
  const auto pixels = [&](const Arguments& more) {
    return fused(Arguments{"--no-pictures", "--no-mesh", "--count", "1"} + more)
        .at("result")
        .at("depth_residual_m")
        .at("valid_pixels")
        .get<int>();
  };
  const int all = pixels({});
  EXPECT_LT(pixels({"--mask", "-1,-1;80,-1;80,120;-1,120"}), all);
  EXPECT_LT(pixels({"--max-range", "0.8"}), all);
  const nlohmann::json colourless = fused({"--no-color", "--no-pictures", "--workspace", "-1,-1,-1,1,1,1"});
  EXPECT_TRUE(colourless.at("result").at("frames") == 21);
  const auto map = load_map(run() / "map.sacmap");
  ASSERT_TRUE(map);
  EXPECT_FALSE(map->config.color);
  ASSERT_TRUE(map->config.workspace.has_value());
  EXPECT_EQ(map->config.workspace->min.x(), -1.0);
}

TEST_F(Fuse, AFolderWithOtherFilesIsLeftAlone) {
  folder_.write("mine/notes.txt", "keep");
  const fs::path mine = folder_ / "mine";
  expect_failure(run_program(fuse(frames(), mine)), 3, "fuse", {mine.string(), "other files", "--force"});
  EXPECT_EQ(names_in(mine), std::vector<std::string>{"notes.txt"});
  const Outcome forced = run_program(fuse(frames(), mine, {"--force", "--no-pictures"}));
  EXPECT_EQ(forced.status, 0) << forced.err;
  EXPECT_EQ(text_of(mine / "notes.txt"), "keep");
  EXPECT_EQ(run_program(fuse(frames(), mine, {"--no-pictures"})).status, 0);  // it holds a run now
}

class FuseInterrupted : public ::testing::Test {
 protected:
  /// Hundreds of frames, the fourth of them corrupt: its note says that three frames are done and many are to come.
  void SetUp() override {
    make_sample(frames(), 8);
    for (int i = 8; i < 1200; ++i) {
      for (const char* kind : {".depth.png", ".color.png", ".pose.txt"}) {
        fs::create_symlink(frames() / (name(i % 8) + kind), frames() / (name(i) + kind));
      }
    }
    fs::remove(frames() / (name(3) + ".depth.png"));
    folder_.write("frames/" + name(3) + ".depth.png", "no image");
  }
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  static std::string name(int i) { return "frame-" + std::to_string(1000000 + i).substr(1); }
  [[nodiscard]] Arguments arguments() const {
    return {"fuse", frames().string(), "--out", (folder_ / "run").string(), "--voxel-size", "0.01"};
  }
  TempFolder folder_;
};

TEST_F(FuseInterrupted, KeepsWhatWasDone) {
  RunningProgram program{arguments()};
  ASSERT_TRUE(program.wait_for(name(3) + ": skipped")) << program.err();
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted after"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find((folder_ / "run").string()), std::string::npos) << outcome.err;
  const std::string go_on = " --continue " + (folder_ / "run" / "map.sacmap").string();
  const nlohmann::json document = nlohmann::json::parse(text_of(folder_ / "run" / "run.json"), nullptr, false);
  expect_envelope(document, "fuse");
  const nlohmann::json& result = document.at("result");
  EXPECT_EQ(result.at("interrupted"), true);
  EXPECT_GE(result.at("frames").get<int>(), 3);
  EXPECT_LT(result.at("frames").get<int>(), 1199);
  const std::size_t done = result.at("frames").get<std::size_t>() + result.at("skipped").size();
  EXPECT_NE(outcome.err.find("go on with --first " + std::to_string(done) + go_on), std::string::npos) << outcome.err;
  ASSERT_GE(result.at("skipped").size(), 1U);
  EXPECT_EQ(result.at("skipped").at(0).at("frame"), name(3));
  EXPECT_TRUE(load_map(folder_ / "run" / "map.sacmap"));
  EXPECT_TRUE(read_mesh(folder_ / "run" / "mesh.ply"));
}

TEST_F(FuseInterrupted, TheSecondSignalEndsAtOnce) {
  RunningProgram program{arguments()};
  ASSERT_TRUE(program.wait_for(name(3) + ": skipped")) << program.err();
  program.send(SIGINT);
  program.send(SIGTERM);
  const Outcome outcome = program.finish();
  EXPECT_TRUE(outcome.status == 130 || outcome.status == 143) << outcome.status;
  EXPECT_FALSE(fs::exists(folder_ / "run" / "run.json"));
}

TEST(FuseRecorded, FiveFramesOfALivingRoom) {
  const fs::path data = shared_data() / "rgbd_open3d5" / "RGBD";
  if (!fs::exists(data)) GTEST_SKIP() << data << " is not there";
  const TempFolder folder;
  for (const char* tracking : {"forced", "icp", "hint"}) {
    const Outcome outcome =
        run_program({"fuse", data.string(), "--tracking", tracking, "--out", (folder / tracking).string(), "--quiet",
                     "--voxel-size", "0.012", "--no-pictures", "--json", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json result = outcome.json().at("result");
    EXPECT_EQ(result.at("frames"), 5);
    EXPECT_EQ(result.at("lost"), 0);
    EXPECT_LT(result.at("depth_residual_m").at("median").get<double>(), 0.008) << tracking;
    EXPECT_GT(result.at("depth_residual_m").at("share").get<double>(), 0.9) << tracking;
  }
}

TEST(FuseRecorded, ColorsLaidOnTheDepthsTrackTheKitchen) {
  const fs::path data = shared_data() / "rgbd_redkitchen";
  if (!fs::exists(data)) GTEST_SKIP() << data << " is not there";
  if (kSanitized) GTEST_SKIP() << "tracking by colours takes minutes with sanitizers; release does it";
  const TempFolder folder;
  const auto residual_m = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"fuse",         data.string(),
                                       "--tracking",   "rgbd",
                                       "--out",        (folder / "run").string(),
                                       "--force",      "--quiet",
                                       "--no-mesh",    "--no-pictures",
                                       "--count",      "40",
                                       "--voxel-size", "0.012",
                                       "--json",       "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result").at("depth_residual_m").at("median").get<double>();
  };
  EXPECT_LT(residual_m({"--color-camera", "525,525,320,240", "--color-at", "0.025,0,0"}), residual_m({}));
}

TEST(FuseRecorded, KitchenFitsItsMapWithinEightMillimetres) {
  const fs::path data = shared_data() / "rgbd_redkitchen";
  if (!fs::exists(data)) GTEST_SKIP() << data << " is not there";
  if (kSanitized) GTEST_SKIP() << "two hundred frames take minutes with sanitizers; release fuses them";
  const TempFolder folder;
  std::vector<double> residuals_m;
  for (const char* clearing : {"50", "100"}) {
    const Outcome outcome =
        run_program({"fuse", data.string(), "--tracking", "forced", "--out", (folder / clearing).string(), "--quiet",
                     "--clearing", clearing, "--no-color", "--no-mesh", "--no-pictures", "--json", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json residual = outcome.json().at("result").at("depth_residual_m");
    residuals_m.push_back(residual.at("median").get<double>());
    EXPECT_GE(residual.at("share").get<double>(), 0.9);
  }
  EXPECT_LE(residuals_m[0], 0.008);
  EXPECT_LT(residuals_m[0], residuals_m[1]) << "why fuse clears by half: docs/decisions/0021-clearing.md";
}

TEST_F(Fuse, NamesTheFileOfThePoses) {
  ASSERT_EQ(run_program(fuse(frames(), run(), {"--count", "3", "--no-pictures", "--no-mesh"})).status, 0);
  const std::string poses = (run() / "trajectory.txt").string();
  const Outcome outcome =
      run_program(fuse(frames(), folder_ / "again", {"--count", "3", "--no-pictures", "--no-mesh", "--poses", poses}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("(" + poses + " has poses)"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace saccade::test
