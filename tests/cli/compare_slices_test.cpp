// SPDX-License-Identifier: Apache-2.0
// saccade compare in slices: shards, their merge, how far they are, and the script for Slurm.
#include <gtest/gtest.h>

#include <cstdlib>

#include "campaign_bits.hpp"
#include "compare_runs.hpp"
#include "report_page.hpp"
#include "saccade/io/files/sqlite_file.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

/// The columns of a table that are no times.
std::string figures_of(const fs::path& csv) {
  std::string kept;
  std::istringstream lines{text_of(csv)};
  for (std::string line; std::getline(lines, line);) {
    if (line.find("_ms,") == std::string::npos && line.find("seconds,") == std::string::npos) kept += line + '\n';
  }
  return kept;
}

Arguments slice(const fs::path& out, const Arguments& wanted, const std::string& of) {
  return compare(out, wanted + Arguments{"--shard", of, "--quiet"});
}

TEST(CompareSlices, ThreeInAnyOrderEqualOneMachine) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  for (const Arguments& how : {Arguments{}, Arguments{"--equal-views", "--max-views", "2"}}) {
    const TempFolder folder;
    const fs::path out = folder / "sliced";
    const Arguments wanted = Arguments{"--seeds", "1-3"} + how;
    ASSERT_EQ(run_program(compare(folder / "whole", wanted + Arguments{"--quiet"})).status, 0);
    for (const char* of : {"2/3", "0/3", "1/3"}) {
      const Outcome done = run_program(slice(out, wanted, of));
      ASSERT_EQ(done.status, 0) << done.err;
      EXPECT_NE(done.out.find("2 done now, 0 found"), std::string::npos) << done.out;
    }
    const Outcome merged = run_program(compare(out, wanted + Arguments{"--merge", "--quiet", "--json", "-"}));
    ASSERT_EQ(merged.status, 0) << merged.err;
    const nlohmann::json result = merged.json().at("result");
    EXPECT_EQ(result.at("runs").dump(), R"({"done":6,"known":0,"merged_now":6,"planned":6,"shards":3})");
    EXPECT_EQ(bits_of(out), bits_of(folder / "whole"));
    EXPECT_EQ(bits_of(out).at(0).size(), 6U);
    EXPECT_GE(bits_of(out).at(1).size(), 6U);
    EXPECT_EQ(figures_of(out / "summary.csv"), figures_of(folder / "whole/summary.csv"));
    EXPECT_EQ(report_in(out / "index.html").at("record").at("result").at("slices").size(), 3U);
    for (const nlohmann::json& slice : result.at("slices")) {
      EXPECT_EQ(slice.at("state"), "done");
      EXPECT_EQ(slice.at("done"), 2);
      EXPECT_EQ(slice.at("tries"), 1);
    }

    // A second merge, and the slices themselves, find everything done.
    const Outcome again =
        run_program(compare(out, wanted + Arguments{"--merge", (out / "shards").string(), "--quiet"}));
    EXPECT_NE(again.out.find("0 merged now, 6 known, 6 of 6 in the campaign"), std::string::npos)
        << again.out << again.err;
    EXPECT_EQ(bits_of(out), bits_of(folder / "whole"));
    const Outcome more = run_program(slice(out, wanted, "0/1"));
    EXPECT_NE(more.out.find("0 done now, 6 found"), std::string::npos) << more.out << more.err;
  }
}

TEST(CompareSlices, AKilledSliceIsTakenAgainAndADuplicateIsRefused) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1-6", "--jobs", "1"};
  {
    RunningProgram program{compare(out, wanted + Arguments{"--shard", "0/2"})};
    ASSERT_TRUE(program.wait_for("seed 2"));
    expect_failure(run_program(slice(out, wanted, "0/2")), 3, "compare", {"0-of-2", "another run is writing"});
    Outcome status = run_program(compare(out, wanted + Arguments{"--status"}));
    EXPECT_NE(status.out.find("running"), std::string::npos) << status.out << status.err;
    program.send(SIGKILL);
    EXPECT_EQ(program.finish().status, -1);
  }
  const Outcome status = run_program(compare(out, wanted + Arguments{"--status", "--json", "-"}));
  ASSERT_EQ(status.status, 0) << status.err;
  const nlohmann::json slices = status.json().at("result").at("slices");
  ASSERT_EQ(slices.size(), 2U);
  EXPECT_EQ(slices[0].at("state"), "killed");
  EXPECT_GE(slices[0].at("done").get<int>(), 1);
  EXPECT_EQ(slices[1].at("state"), "waiting");
  EXPECT_FALSE(fs::exists(out / "campaign.sqlite"));  // a look writes nothing
  ASSERT_EQ(run_program(slice(out, wanted, "0/2")).status, 0);
  ASSERT_EQ(run_program(slice(out, wanted, "1/2")).status, 0);
  const Outcome merged = run_program(compare(out, wanted + Arguments{"--merge", "--quiet", "--json", "-"}));
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(merged.json().at("result").at("slices")[0].at("tries"), 2);
  ASSERT_EQ(run_program(compare(folder / "whole", wanted + Arguments{"--quiet"})).status, 0);
  EXPECT_EQ(bits_of(out), bits_of(folder / "whole"));
}

TEST(CompareSlices, ShardsThatDoNotFitAreNamedAndTheCampaignStays) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1-2"};
  ASSERT_EQ(run_program(compare(out, {"--seeds", "1", "--quiet"})).status, 0);
  ASSERT_EQ(run_program(slice(out, wanted, "0/1")).status, 0);
  const std::string before = text_of(out / "campaign.sqlite");
  const fs::path shard = shard_file(out, "0-of-1");
  const std::string good = text_of(shard);
  const auto refused = [&](const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(compare(out, more + Arguments{"--merge"})), 3, "compare", parts);
    EXPECT_EQ(text_of(out / "campaign.sqlite"), before);
  };
  refused({"--seeds", "1"}, {"0-of-1/campaign.sqlite", "seed 2", "not among its seeds"});
  refused(wanted + Arguments{"--min-gain", "2"}, {"0-of-1", "not of this comparison", "min_gain is 1.0, not 2.0"});
  refused(wanted + Arguments{"--strategies", "sphere"}, {"0-of-1", "random", "not among its strategies"});
  refused(wanted + Arguments{"--merge", (folder / "nowhere").string()}, {"nowhere", "no campaign.sqlite"});

  const auto change = [&shard](const std::string& sql) { ASSERT_TRUE(SqliteFile::open(shard, 1000)->run(sql)); };
  change("UPDATE runs SET program_version = '0.0.9'");
  refused(wanted, {"0-of-1", "made by Saccade 0.0.9"});
  std::ofstream{shard, std::ios::binary} << good;
  change("PRAGMA user_version = 99");
  refused(wanted, {"0-of-1", "newer Saccade"});
  for (const double share : {0.95, 0.6, 0.3}) {
    std::ofstream{shard, std::ios::binary}
        << good.substr(0, static_cast<std::size_t>(share * static_cast<double>(good.size())));
    refused(wanted, {"0-of-1/campaign.sqlite", "damaged"});
  }
  const Outcome status = run_program(compare(out, wanted + Arguments{"--status"}));
  EXPECT_EQ(status.status, 0) << status.err;
  EXPECT_NE(status.out.find("unreadable: "), std::string::npos) << status.out;
  std::ofstream{shard, std::ios::binary} << good;
  const Outcome merged = run_program(compare(out, wanted + Arguments{"--merge", "--quiet"}));
  EXPECT_NE(merged.out.find("2 merged now, 0 known"), std::string::npos) << merged.out << merged.err;
}

TEST(CompareSlices, TheNumberOfATaskIsTheSlice) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const auto refused = [&](const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(compare(out, more)), 2, "compare", parts);
    EXPECT_FALSE(fs::exists(out));
  };
  for (const char* wrong : {"3", "3/3", "/3", "0/0", "-1/3", "x/3", "1/3/5", "0/1000000"})
    refused({"--shard", wrong}, {"--shard", "0/10 and the last 9/10"});
  for (const char* name : {"SLURM_ARRAY_TASK_ID", "OMPI_COMM_WORLD_RANK", "PMI_RANK", "JOB_COMPLETION_INDEX"})
    ::unsetenv(name);
  refused({"--shard", "auto/3"}, {"--shard", "SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"});
  ::setenv("OMPI_COMM_WORLD_RANK", "7", 1);
  refused({"--shard", "auto/3"}, {"'7/3'"});
  ::setenv("SLURM_ARRAY_TASK_ID", "2", 1);
  const Outcome done = run_program(compare(out, {"--seeds", "1", "--shard", "auto/3", "--quiet"}));
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_TRUE(fs::exists(shard_file(out, "2-of-3")));
  ::unsetenv("SLURM_ARRAY_TASK_ID");
  ::unsetenv("OMPI_COMM_WORLD_RANK");
}

TEST(CompareSlices, TheScriptForSlurmIsShown) {
  const TempFolder folder;
  const fs::path out = folder / "a campaign's";
  const Outcome shown = run_program(compare(out, {"--seeds", "1-5", "--slurm", "--dry-run", "--partition", "long",
                                                  "--time=2:00:00", "--cpus", "4", "--tasks", "5", "--threads", "1"}));
  ASSERT_EQ(shown.status, 0) << shown.err;
  for (const char* line : {"#!/bin/bash\n", "#SBATCH --array=0-4\n", "#SBATCH --cpus-per-task=4\n",
                           "#SBATCH --partition=long\n", "#SBATCH --time=2:00:00\n", "#SBATCH --requeue\n",
                           " --seeds 1-5 ", " --threads 4 ", "a campaign'\\''s'", " --shard auto/5 "})
    EXPECT_NE(shown.out.find(line), std::string::npos) << line << '\n' << shown.out;
  for (const char* part : {"--dry-run", "--slurm", "--cpus ", "--tasks"})
    EXPECT_EQ(shown.out.find(part), std::string::npos) << part << '\n' << shown.out;
  EXPECT_FALSE(fs::exists(out));
  const auto refused = [&](const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(compare(out, more)), 2, "compare", parts);
  };
  refused({"--dry-run"}, {"--slurm"});
  refused({"--cpus", "2"}, {"--slurm"});
  refused({"--slurm", "--partition", "a b"}, {"--partition", "letters"});
  refused({"--slurm", "--shard", "0/3"}, {"cannot be given with --shard"});
  refused({"--merge", "--status"}, {"cannot be given with --status"});
}

}  // namespace
}  // namespace saccade::test
