// SPDX-License-Identifier: Apache-2.0
// Campaign::merge, Campaign::open_to_read and CampaignIndex.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "campaign_runs.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/trial/campaign_index.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::key_of;
using test::run_of;
using test::TempFolder;

const AcceptRun kAll = [](const StoredRun&) { return Status{}; };

fs::path shard(const TempFolder& folder, const std::string& name, std::uint64_t first, std::uint64_t last) {
  const fs::path path = folder / name;
  const auto campaign = Campaign::open(path);
  for (std::uint64_t seed = first; seed <= last; ++seed) EXPECT_TRUE(*campaign->add(run_of(key_of(seed), seed % 4)));
  return path;
}

TEST(CampaignMerge, EveryOrderGivesTheSameRunsOnce) {
  const TempFolder folder;
  const std::vector<fs::path> shards{shard(folder, "a", 1, 3), shard(folder, "b", 3, 7), shard(folder, "c", 8, 8)};
  std::vector<std::size_t> order{0, 1, 2};
  std::size_t orders = 0;
  do {
    const fs::path path = folder / ("campaign" + std::to_string(orders++));
    const Campaign campaign = Campaign::open(path).value();
    std::vector<fs::path> files;
    for (const std::size_t i : order) files.push_back(shards[i]);
    for (int round = 0; round < 2; ++round) {
      const auto merged = campaign.merge(files, kAll);
      ASSERT_TRUE(merged) << merged.error().to_string();
      EXPECT_EQ(merged->added, round == 0 ? 8U : 0U);
      EXPECT_EQ(merged->known, round == 0 ? 1U : 9U);
    }
    ASSERT_EQ(campaign.runs()->size(), 8U);
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const auto found = campaign.find(key_of(seed));
      ASSERT_TRUE(found && *found);
      test::expect_same(**found, run_of(key_of(seed), seed % 4));
    }
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(orders, 6U);
}

TEST(CampaignMerge, WhenARunWasStoredStays) {
  const TempFolder folder;
  const fs::path path = shard(folder, "a", 1, 1);
  ASSERT_TRUE(SqliteFile::open(path, 0)->run("UPDATE runs SET finished_at = '2001-02-03T04:05:06Z'"));
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  ASSERT_TRUE(campaign.merge(std::vector{path}, kAll));
  EXPECT_EQ(campaign.runs()->at(0).finished_at, "2001-02-03T04:05:06Z");
}

TEST(CampaignMerge, WhatCannotBeMergedLeavesTheCampaignAsItWas) {
  const TempFolder folder;
  const fs::path good = shard(folder, "good", 10, 12);
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  ASSERT_TRUE(*campaign.add(run_of(key_of(1))));
  const auto refused = [&](const fs::path& file, Errc code, const std::string& part, const AcceptRun& accept = kAll) {
    const auto merged = campaign.merge(std::vector{good, file}, accept);
    ASSERT_FALSE(merged) << file;
    EXPECT_EQ(merged.error().code, code);
    EXPECT_EQ(merged.error().context, file.string());
    EXPECT_NE(merged.error().message.find(part), std::string::npos) << merged.error().message;
    EXPECT_EQ(campaign.runs()->size(), 1U);
  };
  refused(folder / "nowhere", Errc::not_found, "no such file");
  folder.write("text", "hello");
  refused(folder / "text", Errc::corrupt_data, "not an SQLite file");
  ASSERT_TRUE(SqliteFile::open(folder / "other", 0)->run("CREATE TABLE songs (name TEXT)"));
  refused(folder / "other", Errc::invalid_argument, "another program");
  ASSERT_TRUE(Campaign::open(folder / "newer"));
  ASSERT_TRUE(SqliteFile::open(folder / "newer", 0)->run("PRAGMA user_version = 99"));
  refused(folder / "newer", Errc::unsupported, "newer Saccade");
  ASSERT_TRUE(SqliteFile::open(folder / "newer", 0)->run("PRAGMA user_version = 1"));
  refused(folder / "newer", Errc::unsupported, "older Saccade");
  const fs::path changed = shard(folder, "changed", 1, 2);
  ASSERT_TRUE(SqliteFile::open(changed, 0)->run("UPDATE views SET coverage = coverage + 1e-9"));
  refused(changed, Errc::invalid_argument, "seed 1 with other figures");
  refused(shard(folder, "odd", 20, 23), Errc::invalid_argument, "odd one", [](const StoredRun& run) {
    return run.key.seed == 22 ? Status{Error{Errc::invalid_argument, "odd one", {}}} : Status{};
  });
  EXPECT_EQ(campaign.merge(std::vector{good}, kAll)->added, 3U);
}

TEST(CampaignMerge, AFileThatWasCutShortIsFoundWhereverItWasCut) {
  const TempFolder folder;
  const std::string bytes = *read_text_file(shard(folder, "whole", 1, 60));
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  std::size_t cuts = 0;
  for (std::size_t cut = 1; cut < bytes.size(); cut += 3001, ++cuts) {
    folder.write("cut", bytes.substr(0, cut));
    const auto merged = campaign.merge(std::vector{folder / "cut"}, kAll);
    ASSERT_FALSE(merged) << cut;
    EXPECT_EQ(merged.error().code, Errc::corrupt_data) << cut << ' ' << merged.error().to_string();
    EXPECT_EQ(merged.error().context, (folder / "cut").string());
    EXPECT_TRUE(campaign.runs()->empty());
  }
  EXPECT_GT(cuts, 10U);
  folder.write("cut", "");  // a task that was killed before it made its tables
  EXPECT_EQ(campaign.merge(std::vector{folder / "cut"}, kAll)->added, 0U);
}

TEST(CampaignMerge, AFullDiskLosesNothing) {
  const TempFolder folder;
  const fs::path file = shard(folder, "a", 10, 80);
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  ASSERT_TRUE(*campaign.add(run_of(key_of(1))));
  auto* handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{fs::file_size(campaign.path()), before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  const auto merged = campaign.merge(std::vector{file}, kAll);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error().code, Errc::io_failure);
  EXPECT_EQ(merged.error().context, campaign.path().string());
  EXPECT_EQ(campaign.runs()->size(), 1U);
  EXPECT_EQ(campaign.merge(std::vector{file}, kAll)->added, 71U);
}

TEST(CampaignMerge, AShardIsReadWhileItsTaskWrites) {
  const TempFolder folder;
  const Campaign writing = Campaign::open(folder / "a").value();
  ASSERT_TRUE(*writing.add(run_of(key_of(1))));
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  EXPECT_EQ(campaign.merge(std::vector{folder / "a"}, kAll)->added, 1U);
  ASSERT_TRUE(*writing.add(run_of(key_of(2))));
  EXPECT_EQ(campaign.merge(std::vector{folder / "a"}, kAll)->added, 1U);
}

TEST(CampaignIndex, KnowsRunsByTheirWholeKey) {
  const TempFolder folder;
  CampaignIndex index;
  ASSERT_TRUE(index.add(Campaign::open_to_read(shard(folder, "a", 1, 5)).value()));
  EXPECT_EQ(index.size(), 5U);
  EXPECT_EQ(index.find(key_of(3)), 3U);
  EXPECT_EQ(index.find(key_of(4)), 0U);
  EXPECT_EQ(index.find(key_of(6)), std::nullopt);
  EXPECT_EQ(index.find(key_of(3, "random")), std::nullopt);
  for (std::string CampaignKey::*part : {&CampaignKey::scene, &CampaignKey::scene_hash, &CampaignKey::strategy,
                                         &CampaignKey::noise, &CampaignKey::settings}) {
    CampaignKey other = key_of(3);
    other.*part += "x";
    EXPECT_EQ(index.find(other), std::nullopt);
    index.add(other, 9);
    EXPECT_EQ(index.find(other), 9U);
    EXPECT_EQ(index.find(key_of(3)), 3U);
  }
}

}  // namespace
}  // namespace saccade
