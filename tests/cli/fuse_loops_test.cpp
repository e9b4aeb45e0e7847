// SPDX-License-Identifier: Apache-2.0
// saccade fuse --loops as a user runs it.
#include <gtest/gtest.h>

#include "cli/run_program.hpp"

namespace saccade::test {
namespace {

class FuseLoops : public ::testing::Test {
 protected:
  void SetUp() override { make_sample(folder_ / "frames", 21); }
  [[nodiscard]] Outcome loops(const Arguments& more) const {
    return run_program(fuse(folder_ / "frames", folder_ / "run", more + Arguments{"--json", "-"}));
  }
  /// info says null where this build lacks Ceres.
  [[nodiscard]] static nlohmann::json solver() {
    return run_program({"info", "--json", "-"}).json().at("result").at("loops");
  }
  TempFolder folder_;
};

TEST_F(FuseLoops, AWayThatDoesNotReturnHasNone) {
  if (solver().is_null()) GTEST_SKIP() << "this build lacks libceres-dev";
  for (const std::string mode : {"end", "online"}) {
    const Outcome outcome = loops({"--tracking", "icp", "--loops", mode, "--force"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json result = outcome.json().at("result");
    const nlohmann::json& found = result.at("loops");
    EXPECT_EQ(found.at("mode"), mode);
    EXPECT_EQ(found.at("solver"), solver());
    EXPECT_EQ(found.at("closed"), 0);
    EXPECT_EQ(found.at("exchanges"), 0);
    EXPECT_GE(found.at("keyframes"), 1);
    EXPECT_EQ(found.at("delay_ms_max").is_null(), mode == "end");
    EXPECT_EQ(result.at("frames"), 21);
    EXPECT_LT(result.at("trajectory_error_m").at("last_pose").get<double>(), 0.05);
  }
}

TEST_F(FuseLoops, SurfelsAreFusedOnceWhereNothingCloses) {
  if (solver().is_null()) GTEST_SKIP() << "this build lacks libceres-dev";
  const auto surfels = [&](const std::string& mode, const std::string& out) {
    return run_program({"surfels", (folder_ / "frames").string(), "--tracking", "icp", "--mode-filter", "off",
                        "--loops", mode, "--quiet", "--out", (folder_ / out).string(), "--json", "-"});
  };
  const Outcome closed = surfels("end", "closed.ply");
  ASSERT_EQ(closed.status, 0) << closed.err;
  EXPECT_EQ(closed.json().at("result").at("loops").at("closed"), 0);
  ASSERT_EQ(surfels("off", "open.ply").status, 0);
  EXPECT_EQ(text_of(folder_ / "closed.ply"), text_of(folder_ / "open.ply"));
  const Outcome given = run_program({"surfels", (folder_ / "frames").string(), "--loops", "end", "--mode-filter", "off",
                                     "--out", (folder_ / "given.ply").string()});
  EXPECT_EQ(given.status, 3);
  EXPECT_NE(given.err.find("--tracking icp"), std::string::npos) << given.err;
}

TEST_F(FuseLoops, SurfelsAreTrackedAgainstTheMapOfFuse) {
  const Arguments six{"--count", "6", "--quiet"};
  const auto surfels = [&](const Arguments& tracking, const std::string& out) {
    return run_program(
        Arguments{"surfels", (folder_ / "frames").string(), "--mode-filter", "off", "--out", (folder_ / out).string()} +
        tracking + six);
  };
  ASSERT_EQ(surfels({"--tracking", "icp"}, "tracked.ply").status, 0);
  ASSERT_EQ(run_program(Arguments{"fuse", (folder_ / "frames").string(), "--tracking", "icp", "--no-mesh",
                                  "--no-pictures", "--out", (folder_ / "run").string()} +
                        six)
                .status,
            0);
  ASSERT_EQ(
      surfels({"--tracking", "forced", "--poses", (folder_ / "run" / "trajectory.txt").string()}, "given.ply").status,
      0);
  EXPECT_TRUE(text_of(folder_ / "tracked.ply") == text_of(folder_ / "given.ply"));
}

TEST_F(FuseLoops, GivenPosesAreNotCorrected) {
  if (solver().is_null()) {
    const Outcome refused = loops({"--tracking", "icp", "--loops", "end"});
    EXPECT_NE(refused.status, 0);
    EXPECT_NE(refused.err.find("libceres-dev"), std::string::npos) << refused.err;
    return;
  }
  const Outcome outcome = loops({"--loops", "end"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.err.find("--tracking icp"), std::string::npos) << outcome.err;
}

/// A small room whose loop closes, in the colours of which frames are tracked.
class FuseClosedLoops : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run_program({"info", "--json", "-"}).json().at("result").at("loops").is_null()) {
      GTEST_SKIP() << "this build lacks libceres-dev";
    }
    make_loop("80,60");
  }
  void make_loop(const std::string& size) const {
    const Outcome made =
        run_program({"scene", "sequence", "loop:1", "--image-size", size, "--frames", "60", "--pose-noise", "off",
                     "--depth-noise", "off", "--color-noise", "off", "--quiet", "--out", frames().string()});
    ASSERT_EQ(made.status, 0) << made.err;
  }
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  [[nodiscard]] Arguments fused(const std::string& name, const Arguments& more) const {
    return Arguments{"fuse", frames().string(), "--out",        (folder_ / name).string(), "--voxel-size",
                     "0.03", "--no-mesh",       "--no-pictures"} +
           more;
  }
  [[nodiscard]] Arguments surfels(const std::string& name, const std::string& loops) const {
    return {"surfels", frames().string(), "--tracking", "rgbd", "--loops", loops, "--out", (folder_ / name).string()};
  }
  /// Fusing the frames along the trajectory of a run gives its map.
  void expect_map_of_trajectory(const std::string& name) const {
    const Outcome again = run_program(
        fused("again", {"--tracking", "forced", "--poses", (folder_ / name / "trajectory.txt").string(), "--force"}));
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_TRUE(text_of(folder_ / "again" / "map.sacmap") == text_of(folder_ / name / "map.sacmap"));
  }
  void expect_whole_after_interruption(const std::string& loops) const {
    RunningProgram program{fused("run", {"--tracking", "rgbd", "--loops", loops})};
    ASSERT_TRUE(program.wait_for("fusing along corrected poses")) << program.err();
    program.send(SIGINT);
    const Outcome outcome = program.finish();
    const nlohmann::json result = nlohmann::json::parse(text_of(folder_ / "run" / "run.json")).at("result");
    EXPECT_GT(result.at("loops").at("closed"), 0);
    if (!result.at("loops").at("applied").get<bool>()) {
      EXPECT_EQ(outcome.status, 130) << outcome.err;
      EXPECT_NE(outcome.out.find("interrupted before"), std::string::npos) << outcome.out;
    }
    expect_map_of_trajectory("run");
  }
  TempFolder folder_;
};

TEST_F(FuseClosedLoops, AnInterruptionLeavesMapAndTrajectoryTogether) { expect_whole_after_interruption("end"); }

TEST_F(FuseClosedLoops, BesideTheFramesToo) { expect_whole_after_interruption("online"); }

/// Surfels are compared in voxels of 5.8 mm, whatever their images: some 20 s.
class FuseClosedLoopsEvidence : public FuseClosedLoops {};

TEST_F(FuseClosedLoopsEvidence, AnInterruptionLosesNoSurfels) {
  make_loop("128,96");
  ASSERT_EQ(run_program(surfels("open.ply", "off")).status, 0);
  ASSERT_EQ(run_program(surfels("closed.ply", "end")).status, 0);
  EXPECT_NE(text_of(folder_ / "open.ply"), text_of(folder_ / "closed.ply"));
  RunningProgram program{surfels("cut.ply", "end")};
  ASSERT_TRUE(program.wait_for("fusing surfels along corrected poses")) << program.err();
  program.send(SIGINT);
  EXPECT_NE(program.finish().status, 3);
  const std::string cut = text_of(folder_ / "cut.ply");
  EXPECT_TRUE(cut == text_of(folder_ / "open.ply") || cut == text_of(folder_ / "closed.ply"));
}

TEST_F(FuseClosedLoops, FramesThatCannotBeReadAgainLeaveTheMap) {
  RunningProgram program{fused("run", {"--tracking", "rgbd", "--loops", "end"})};
  ASSERT_TRUE(program.wait_for("looking for loops")) << program.err();
  fs::rename(frames(), folder_ / "away");
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("map.sacmap"), std::string::npos) << outcome.err;
  fs::rename(folder_ / "away", frames());
  EXPECT_FALSE(fs::exists(folder_ / "run" / "run.json"));
  expect_map_of_trajectory("run");
}

}  // namespace
}  // namespace saccade::test
