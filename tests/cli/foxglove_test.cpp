// SPDX-License-Identifier: Apache-2.0
// --foxglove of explore and update: where Foxglove connects, and a run that stays as it is.
#include <gtest/gtest.h>

#include "run_program.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

Arguments explore_for_foxglove(const fs::path& out, const Arguments& more) {
  return Arguments{"explore", tiny_cell_file(), "--out", out.string(), "--quiet", "--image-size",
                   "96,72",   "--voxel-size",   "0.015", "--robot",    "free",    "--max-views",
                   "1",       "--no-pictures"} +
         more;
}

TEST(FoxgloveOption, SaysWhereAndLeavesTheRunAsItIs) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const Outcome shown = run_program(explore_for_foxglove(folder / "a", {"--foxglove", "0"}));
  ASSERT_EQ(shown.status, 0) << shown.err;
  EXPECT_TRUE(shown.err.starts_with("Foxglove connects to ws://localhost:")) << shown.err;
  EXPECT_TRUE(shown.err.ends_with("/foxglove\n")) << shown.err;
  ASSERT_EQ(run_program(explore_for_foxglove(folder / "b", {})).status, 0);
  EXPECT_EQ(text_of(folder / "a/map.sacmap"), text_of(folder / "b/map.sacmap"));
}

TEST(FoxgloveOption, BeyondThisMachineTheAddressHasAToken) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const Outcome open = run_program(explore_for_foxglove(folder / "a", {"--foxglove", "0.0.0.0:0"}));
  ASSERT_EQ(open.status, 0) << open.err;
  EXPECT_NE(open.err.find("/foxglove?token="), std::string::npos) << open.err;
  EXPECT_NE(open.err.find("nothing is encrypted"), std::string::npos) << open.err;
}

TEST(FoxgloveOption, WhatIsNoPlaceIsSaidBeforeTheRun) {
  const TempFolder folder;
  for (const char* wrong : {"tabletop-1", "65536", "-1", "localhost:x", "1.2.3.4:", "[::1]:99999", ":"}) {
    expect_failure(run_program(explore_for_foxglove(folder / "a", {std::string{"--foxglove="} + wrong})), 2, "explore",
                   {"--foxglove", wrong});
  }
  expect_failure(
      run_program({"update", "--scene", "jug", "--out", (folder / "a").string(), "--quiet", "--foxglove", "tabletop"}),
      2, "update", {"--foxglove", "tabletop"});
  expect_failure(run_program(explore_for_foxglove(folder / "a", {"--foxglove", "203.0.113.7:0"})), 4, "explore",
                 {"203.0.113.7"});
}

}  // namespace
}  // namespace saccade::test
