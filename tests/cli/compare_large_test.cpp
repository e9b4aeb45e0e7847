// SPDX-License-Identifier: Apache-2.0
// saccade compare with many runs, which are made of a few by SQL.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "compare_runs.hpp"
#include "multiply_runs.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

/// Returns the processor time of all programs that were run and have ended. Unlike wall time, it does not grow with
/// other work on the machine.
double processor_s() {
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

TEST(CompareLarge, TenThousandRunsAreMergedInTenSeconds) {
  if (kSanitized) GTEST_SKIP() << "times mean nothing under sanitizers";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const fs::path one = folder / "one";
  ASSERT_EQ(run_program(compare(one, {"--seeds", "1", "--max-views", "3", "--quiet"})).status, 0);
  constexpr std::uint64_t kShards{10};
  constexpr std::uint64_t kSeeds{500};  // per shard, with two strategies
  for (std::uint64_t i = 0; i < kShards; ++i) {
    const fs::path shard = out / "shards" / (std::to_string(i) + "-of-10");
    fs::create_directories(shard);
    fs::copy_file(one / "campaign.sqlite", shard / "campaign.sqlite");
    multiply_runs(shard / "campaign.sqlite", 1001 + kSeeds * i, 1000 + kSeeds * (i + 1));
  }
  const Arguments wanted{"--seeds", "1001-6000", "--max-views", "3", "--merge", "--quiet", "--json", "-"};
  for (const bool again : {false, true}) {
    const double before = processor_s();
    const Outcome merged = run_program(compare(out, wanted));
    const double seconds = processor_s() - before;
    ASSERT_EQ(merged.status, 0) << merged.err;
    EXPECT_EQ(merged.json().at("result").at("runs").at(again ? "known" : "merged_now"), 10000);
    EXPECT_LT(seconds, 10.0) << "with tables, pictures and the page";
    std::cout << "10000 runs " << (again ? "known: " : "merged: ") << seconds << " s of the processor\n";
  }
}

TEST(CompareLargeEvidence, AMillionRowsAreOpenAndDrawnInFiveSeconds) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments settings{"--max-views", "9", "--min-gain", "0", "--quiet", "--json", "-"};
  ASSERT_EQ(run_program(compare(out, Arguments{"--seeds", "1"} + settings)).status, 0);
  std::uint64_t rows = 2;  // scans
  for (const CampaignEntry& run : runs_in(out)) rows += run.run.views.size();
  const std::uint64_t seeds = 1000000 / rows;
  multiply_runs(out / "campaign.sqlite", 2, seeds);
  const double before = processor_s();
  const Outcome drawn = run_program(compare(out, Arguments{"--seeds", "1-" + std::to_string(seeds)} + settings));
  const double seconds = processor_s() - before;
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(drawn.json().at("result").at("runs").at("done"), 2 * seeds);
  std::cout << rows * seeds << " rows: " << drawn.json().at("timings_ms").dump() << ", " << seconds
            << " s of the processor\n";
  EXPECT_LT(seconds, 5.0) << rows * seeds << " rows, with tables of some 380 MB";
}

}  // namespace
}  // namespace saccade::test
