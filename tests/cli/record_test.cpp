// SPDX-License-Identifier: Apache-2.0
// saccade explore --record: an MCAP file beside a run that stays as it is. --publish: what is wrong with it.
#include <gtest/gtest.h>

#include <fstream>

#include "run_program.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

Arguments explore_tiny(const fs::path& out, const Arguments& more) {
  return Arguments{"explore", tiny_cell_file(), "--out", out.string(), "--quiet", "--image-size",
                   "96,72",   "--voxel-size",   "0.015", "--robot",    "free",    "--max-views",
                   "1",       "--no-pictures"} +
         more;
}

TEST(Record, ARunIsRecordedAndStaysAsItIs) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const Outcome recorded = run_program(explore_tiny(folder / "a", {"--record", (folder / "run.mcap").string()}));
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  ASSERT_EQ(run_program(explore_tiny(folder / "b", {})).status, 0);
  EXPECT_EQ(text_of(folder / "a/map.sacmap"), text_of(folder / "b/map.sacmap"));
  const std::string file = text_of(folder / "run.mcap");
  ASSERT_GT(file.size(), 1000U);
  EXPECT_EQ(file.substr(1, 4), "MCAP");
  EXPECT_EQ(file.substr(file.size() - 7, 4), "MCAP");
  for (const char* topic : {"/saccade/occupied", "/saccade/candidates", "/saccade/depth/image_raw", "/tf"}) {
    EXPECT_NE(file.find(topic), std::string::npos) << topic;  // in the summary, which is not compressed
  }
}

TEST(Record, AFileThatCannotBeWrittenIsSaidBeforeTheRun) {
  const TempFolder folder;
  expect_failure(run_program(explore_tiny(folder / "a", {"--record", "/nowhere/run.mcap"})), 3, "explore",
                 {"/nowhere/run.mcap"});
  std::ofstream{folder / "old.mcap"} << "kept";
  expect_failure(run_program(explore_tiny(folder / "b", {"--record", (folder / "old.mcap").string()})), 3, "explore",
                 {"old.mcap", "another name"});
  EXPECT_EQ(text_of(folder / "old.mcap"), "kept");
}

TEST(Publish, AVersionOfRosThatIsNoneIsSaidBeforeTheRun) {
  const TempFolder folder;
  expect_failure(run_program(explore_tiny(folder / "a", {"--publish", "ros,ros3"})), 2, "explore",
                 {"--publish", "ros or ros2", "'ros3'"});
  EXPECT_FALSE(fs::exists(folder / "a"));
}

}  // namespace
}  // namespace saccade::test
