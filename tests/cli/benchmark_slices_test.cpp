// SPDX-License-Identifier: Apache-2.0
// saccade benchmark in slices: shards, their merge, what is refused, and the script for Slurm.
#include <gtest/gtest.h>

#include "campaign_bits.hpp"
#include "report_page.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

/// Random views of the protocol that takes least time.
Arguments benchmark(const fs::path& out, const Arguments& more = {}, const std::string& protocol = "view-sphere") {
  return Arguments{"benchmark", protocol, "--out", out.string()} + more;
}
const Arguments kOne{"--only", "figure", "--strategies", "random", "--quiet"};

/// Merges, and expects what one run of everything wrote: the runs to the bit, and every table of the protocol.
nlohmann::json merged(const fs::path& out, const fs::path& whole, const Arguments& wanted) {
  const Outcome done = run_program(benchmark(out, wanted + Arguments{"--merge", "--json", "-"}));
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(bits_of(out), bits_of(whole));
  for (const char* file : {"table.csv", "curves.csv"}) EXPECT_EQ(text_of(out / file), text_of(whole / file)) << file;
  nlohmann::json result = done.json().at("result");
  const nlohmann::json one = report_in(whole / "index.html").at("record").at("result");
  EXPECT_EQ(result.at("benchmark"), one.at("benchmark"));
  EXPECT_EQ(report_in(out / "index.html").at("record").at("result").at("benchmark"), one.at("benchmark"));
  return result;
}

TEST(BenchmarkSlices, MergedTheyEqualOneMachineAndOthersAreRefused) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const fs::path out = folder / "sliced";
  ASSERT_EQ(run_program(benchmark(folder / "whole", kOne)).status, 0);
  for (const char* of : {"0/2", "1/2"}) {  // there is one run, and the first slice is empty
    const Outcome done = run_program(benchmark(out, kOne + Arguments{"--shard", of}));
    ASSERT_EQ(done.status, 0) << done.err;
  }
  EXPECT_FALSE(fs::exists(out / "table.csv"));  // a shard has its runs alone
  EXPECT_EQ(names_in(out / "shards/1-of-2"), (std::vector<std::string>{"campaign.sqlite", "shard.json"}));
  const Outcome status = run_program(benchmark(out, kOne + Arguments{"--status"}));
  EXPECT_NE(status.out.find("1 runs: 0 in the campaign, 1 in shards, 0 to be done"), std::string::npos) << status.out;

  // Shards of another protocol, of other objects, and of other strategies are named, and there is no campaign then.
  const auto refused = [&](const Arguments& more, const std::string& protocol, const Arguments& parts) {
    expect_failure(run_program(benchmark(out, more + Arguments{"--merge"}, protocol)), 3, "benchmark",
                   parts + Arguments{"1-of-2/campaign.sqlite", "figure", "nothing was merged"});
    EXPECT_FALSE(fs::exists(out / "campaign.sqlite"));
  };
  refused(kOne, "household", {"the scene's content is another one"});
  refused({"--only", "coil", "--strategies", "random"}, "view-sphere", {"the scene is not among its scenes"});
  refused({"--only", "figure", "--strategies", "surface"}, "view-sphere", {"the strategy is not among its strategies"});

  const nlohmann::json result = merged(out, folder / "whole", kOne);
  EXPECT_EQ(result.at("runs").dump(), R"({"done":1,"known":0,"merged_now":1,"planned":1,"shards":2})");
  ASSERT_EQ(result.at("slices").size(), 2U);
  EXPECT_EQ(result.at("slices")[0].at("planned"), 0);
  EXPECT_EQ(result.at("slices")[1].at("done"), 1);
}

TEST(BenchmarkSlicesEvidence, ThreeInAnyOrderEqualOneMachine) {
  const TempFolder folder;
  const fs::path out = folder / "sliced";
  const Arguments wanted{"--only", "figure,hare", "--strategies", "random,surface", "--seeds", "1-2", "--quiet"};
  ASSERT_EQ(run_program(benchmark(folder / "whole", wanted)).status, 0);
  for (const char* of : {"2/3", "0/3", "1/3"}) {
    ASSERT_EQ(run_program(benchmark(out, wanted + Arguments{"--shard", of})).status, 0);
  }
  EXPECT_EQ(merged(out, folder / "whole", wanted).at("runs").at("merged_now"), 6);  // surface once, random twice each
}

TEST(BenchmarkSlices, TheScriptForSlurmIsShown) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Outcome shown =
      run_program(benchmark(out, {"--only", "figure,hare", "--strategies", "surface,random", "--seeds", "1-2",
                                  "--slurm", "--dry-run", "--partition", "long", "--time", "2:00:00", "--cpus", "4"}));
  ASSERT_EQ(shown.status, 0) << shown.err;
  for (const char* part : {"#SBATCH --array=0-5\n", "#SBATCH --partition=long\n", "#SBATCH --time=2:00:00\n",
                           " benchmark view-sphere --only figure,hare --strategies surface,random --seeds 1-2 "
                           "--threads 4 --out ",
                           " --shard auto/6 ", " --merge\n"}) {
    EXPECT_NE(shown.out.find(part), std::string::npos) << part << '\n' << shown.out;
  }
  EXPECT_FALSE(fs::exists(out));

  const Outcome listed = run_program(benchmark(out, {"--only", "hare", "--seeds", "1-2", "--list"}));
  EXPECT_NE(listed.out.find("13 runs, 0 of them done\n"), std::string::npos) << listed.out << listed.err;
  const auto refused = [&](const Arguments& arguments, const Arguments& parts) {
    expect_failure(run_program(arguments), 2, "benchmark", parts);
  };
  refused(benchmark(out, {"--dry-run"}), {"--slurm"});
  refused(benchmark(out, {"--slurm", "--shard", "0/3"}), {"cannot be given with --shard"});
  refused(benchmark(out, {"--merge", "--list"}), {"--merge", "cannot be given with --list"});
  refused(benchmark(out, {"--shard", "3/3"}), {"--shard", "0/10"});
  refused({"benchmark", "--out", out.string(), "--merge", "view-sphere"},
          {"a protocol is needed: view-sphere, one-shot"});
}

}  // namespace
}  // namespace saccade::test
