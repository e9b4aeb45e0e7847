// SPDX-License-Identifier: Apache-2.0
// saccade compare in slices that do not all succeed: the page while they run, time limits, damaged shards, full disks.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "campaign_bits.hpp"
#include "compare_runs.hpp"
#include "multiply_runs.hpp"
#include "report_page.hpp"
#include "saccade/io/files/sqlite_file.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

Arguments run_part(const fs::path& out, const Arguments& wanted, const std::string& of) {
  return compare(out, wanted + Arguments{"--shard", of});
}

nlohmann::json page_result(const fs::path& out) { return report_in(out / "index.html").at("record").at("result"); }

TEST(CompareUnderWay, ThePageShowsHowFarTheSlicesAre) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1", "--quiet"};
  ASSERT_EQ(run_program(run_part(out, wanted, "1/2")).status, 0);
  nlohmann::json result = page_result(out);
  EXPECT_EQ(result.at("runs").dump(), R"({"done":0,"in_shards":1,"planned":2})");
  EXPECT_EQ(result.at("slices").at(0).at("state"), "waiting");
  EXPECT_EQ(result.at("slices").at(1).at("state"), "done");
  const Outcome merged = run_program(compare(out, wanted + Arguments{"--merge"}));  // although the page is there
  ASSERT_EQ(merged.status, 0) << merged.err;

  std::ofstream{shard_file(out, "1-of-2"), std::ios::trunc};  // damaged after it was merged
  EXPECT_EQ(run_program(run_part(out, wanted, "0/2")).status, 0);
  result = page_result(out);
  EXPECT_EQ(result.at("runs").dump(), R"({"done":1,"in_shards":1,"planned":2})");
  EXPECT_EQ(result.at("summaries").size(), 1U);
  ASSERT_EQ(result.at("unreadable").size(), 1U);
  EXPECT_NE(result.at("unreadable").at(0).get<std::string>().find("is empty"), std::string::npos) << result;

  // A folder that is no campaign gets no page.
  const Outcome refused = run_program(run_part(folder.path(), wanted, "0/2"));
  EXPECT_EQ(refused.status, 3) << refused.err;
  EXPECT_FALSE(fs::exists(folder / "index.html"));
}

TEST(CompareUnderWay, ATimeLimitKeepsWhatIsDone) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1-20", "--jobs", "1"};
  const auto record = [&](const std::string& key) {
    return nlohmann::json::parse(text_of(out / "shards/0-of-1/shard.json")).at(key).get<std::string>();
  };
  const auto stopped_at = [&](const Arguments& command, const std::string& stage) {
    RunningProgram program{command};
    EXPECT_TRUE(program.wait_for(stage)) << program.err();
    program.send(SIGUSR2);
    return program.finish();
  };
  const Arguments slow{"compare",      "--scenes", tiny_cell_file(), "--strategies", "sphere",  "--seeds", "1",
                       "--voxel-size", "0.004",    "--out",          out.string(),   "--shard", "0/1"};
  const Outcome none = stopped_at(slow, "sphere, seed 1");
  EXPECT_EQ(none.status, 3) << none.err;  // the script for Slurm does not try it again
  EXPECT_NE(none.err.find("the time limit came before a run was done"), std::string::npos) << none.err;
  EXPECT_EQ(record("state"), "failed");
  EXPECT_NE(record("error").find("give tasks more time"), std::string::npos);
  {
    RunningProgram twice{slow};  // Slurm and a user may both warn
    ASSERT_TRUE(twice.wait_for("sphere, seed 1"));
    twice.send(SIGUSR2);
    twice.send(SIGUSR2);
    EXPECT_EQ(twice.finish().status, 3);
  }
  const Outcome some = stopped_at(run_part(out, wanted, "0/1"), "sphere, seed 3");
  EXPECT_EQ(some.status, 140) << some.err;
  EXPECT_NE(some.err.find("interrupted after"), std::string::npos) << some.err;
  EXPECT_EQ(record("state"), "interrupted");
}

TEST(CompareUnderWay, DamagedShardsAreSetAside) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1-2", "--quiet"};
  for (const char* of : {"0/4", "1/4", "2/4", "3/4"}) ASSERT_EQ(run_program(run_part(out, wanted, of)).status, 0);
  const std::string good = text_of(shard_file(out, "1-of-4"));
  const auto damage = [&](const std::string& name) {
    std::ofstream{shard_file(out, name), std::ios::binary} << good.substr(0, good.size() / 2);
  };
  damage("1-of-4");
  ASSERT_TRUE(SqliteFile::open(shard_file(out, "2-of-4"), 1000)->run("DROP VIEW curves; DROP TABLE views"));
  expect_failure(run_program(compare(out, wanted + Arguments{"--merge"})), 3, "compare",
                 {"1-of-4/campaign.sqlite", "--set-aside moves it away"});
  EXPECT_FALSE(fs::exists(out / "campaign.sqlite"));
  EXPECT_EQ(page_result(out).at("slices").size(), 4U);  // a merge that fails leaves a page as well
  const Outcome merged = run_program(compare(out, Arguments{"--seeds", "1-2", "--merge", "--set-aside"}));
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_NE(merged.out.find("2 merged now, 0 known, 2 of 4 in the campaign"), std::string::npos) << merged.out;
  for (const char* name : {"1-of-4", "2-of-4"}) {
    EXPECT_NE(merged.err.find("set aside as " + (out / "set-aside" / name).string()), std::string::npos) << merged.err;
  }
  EXPECT_EQ(names_in(out / "set-aside"), (std::vector<std::string>{"1-of-4", "2-of-4"}));
  EXPECT_EQ(page_result(out).at("set_aside").dump(), R"(["1-of-4","2-of-4"])");
  // Their slices are done again, and a second shard of the same name is set aside beside the first.
  ASSERT_EQ(run_program(run_part(out, wanted, "2/4")).status, 0);
  ASSERT_EQ(run_program(run_part(out, wanted, "1/4")).status, 0);
  damage("1-of-4");
  ASSERT_EQ(run_program(compare(out, wanted + Arguments{"--merge", "--set-aside"})).status, 0);
  EXPECT_EQ(names_in(out / "set-aside"), (std::vector<std::string>{"1-of-4", "1-of-4.2", "2-of-4"}));
  ASSERT_EQ(run_program(run_part(out, wanted, "1/4")).status, 0);
  ASSERT_EQ(run_program(compare(out, wanted + Arguments{"--merge", "--set-aside"})).status, 0);
  ASSERT_EQ(run_program(compare(folder / "whole", wanted)).status, 0);
  EXPECT_EQ(bits_of(out), bits_of(folder / "whole"));
  expect_failure(run_program(compare(out, wanted + Arguments{"--set-aside"})), 2, "compare", {"--merge"});
  expect_failure(run_program(compare(out, wanted + Arguments{"--merge", out.string(), "--set-aside"})), 2, "compare",
                 {"own shards"});
}

TEST(CompareUnderWay, ACampaignWhoseOnlyShardWasSetAsideGoesOn) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1", "--quiet"};
  ASSERT_EQ(run_program(run_part(out, wanted, "0/1")).status, 0);
  std::ofstream{shard_file(out, "0-of-1"), std::ios::trunc};
  EXPECT_EQ(run_program(compare(out, wanted + Arguments{"--merge"})).status, 3);  // it leaves a page
  const Outcome empty = run_program(compare(out, wanted + Arguments{"--merge", "--set-aside"}));
  EXPECT_EQ(empty.status, 3) << empty.err;
  EXPECT_NE(empty.err.find("no shards to merge"), std::string::npos) << empty.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"index.html", "set-aside", "shards"}));
  const Outcome again = run_program(run_part(out, wanted, "0/1"));
  EXPECT_EQ(again.status, 0) << again.err;
}

TEST(CompareUnderWay, TasksAreWarnedOfLimitsOfFiveMinutesAndMore) {
  const TempFolder folder;
  const auto is_warned = [&](const std::string& time) {
    const Arguments limit = time.empty() ? Arguments{} : Arguments{"--time", time};
    const Outcome shown =
        run_program(compare(folder / "out", Arguments{"--seeds", "1", "--slurm", "--dry-run"} + limit));
    EXPECT_EQ(shown.status, 0) << shown.err;
    return shown.out.find("#SBATCH --signal=B:USR2@60\n") != std::string::npos;
  };
  for (const char* time : {"", "5", "5:30", "1:00:00", "0:05:00", "0-1", "1-0", "0-0:05", "0", "UNLIMITED"})
    EXPECT_TRUE(is_warned(time)) << time;
  for (const char* time : {"4", "4:59", "0:30", "0:04:00", "0-0:04", "0-0:04:59"})
    EXPECT_FALSE(is_warned(time)) << time;
}

TEST(CompareUnderWay, AFullDiskLeavesShardsAndCampaignAsTheyWere) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const fs::path shard = shard_file(out, "0-of-1");
  ASSERT_EQ(run_program(run_part(out, {"--seeds", "1", "--quiet"}, "0/1")).status, 0);
  multiply_runs(shard, 2, 2000);
  const std::string before = text_of(shard);
  ASSERT_GT(before.size(), std::size_t{2} << 20U);

  // A run more: there is no place for it in the shard.
  const Outcome slice_full =
      run_program(run_part(out, {"--seeds", "1-2003", "--quiet"}, "0/1"), static_cast<rlim_t>(before.size()));
  EXPECT_EQ(slice_full.status, 3) << slice_full.err;
  EXPECT_NE(slice_full.err.find("0-of-1/campaign.sqlite"), std::string::npos) << slice_full.err;
  EXPECT_EQ(bits_of(shard.parent_path()).at(0).size(), 4000U);

  // A merge, of which half fits.
  const Arguments merge{"--seeds", "1-2000", "--merge", "--quiet"};
  const auto merge_full = [&] { return run_program(compare(out, merge), static_cast<rlim_t>(before.size() / 2)); };
  expect_failure(merge_full(), 3, "compare", {"campaign.sqlite"});
  EXPECT_FALSE(fs::exists(out / "campaign.sqlite"));
  ASSERT_EQ(run_program(compare(out, {"--seeds", "2001", "--quiet", "--shard", "0/2"})).status, 0);
  ASSERT_EQ(
      run_program(compare(out, {"--seeds", "2001", "--quiet", "--merge", (out / "shards/0-of-2").string()})).status, 0);
  const std::string campaign = text_of(out / "campaign.sqlite");
  expect_failure(merge_full(), 3, "compare", {"campaign.sqlite"});
  EXPECT_TRUE(text_of(out / "campaign.sqlite") == campaign) << "changed by a merge that failed";
  EXPECT_FALSE(fs::exists(out / "campaign.sqlite-journal"));
  const Outcome merged = run_program(compare(out, merge));
  EXPECT_NE(merged.out.find("4000 merged now"), std::string::npos) << merged.out << merged.err;
}

}  // namespace
}  // namespace saccade::test
