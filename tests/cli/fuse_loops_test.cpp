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

}  // namespace
}  // namespace saccade::test
