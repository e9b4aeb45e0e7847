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

const AcceptRun kAll = [](const StoredRun&) { return MergeChoice{}; };

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
  ASSERT_TRUE(SqliteFile::open(changed, 0)
                  ->run("UPDATE views SET coverage = coverage + 1e-9;"
                        "UPDATE runs SET coverage = coverage + 1e-9"));
  refused(changed, Errc::invalid_argument, "seed 1 with other figures");
  refused(shard(folder, "odd", 20, 23), Errc::invalid_argument, "odd one", [](const StoredRun& run) {
    return run.key.seed == 22 ? Result<MergeChoice>{Error{Errc::invalid_argument, "odd one", {}}} : MergeChoice{};
  });
  EXPECT_EQ(campaign.merge(std::vector{good}, kAll)->added, 3U);
}

TEST(CampaignMerge, ValuesThatNoRunCanHaveAreNamedAndTheCampaignStays) {
  const TempFolder folder;
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  ASSERT_TRUE(*campaign.add(run_of(key_of(1))));
  const std::string good = *read_text_file(shard(folder, "shard", 2, 3));
  struct Spoiled {
    std::string sql;
    std::string part;
  };
  const std::vector<Spoiled> all{
      {"UPDATE runs SET stopped_because = 'x'", "unknown reason to stop"},
      {"UPDATE views SET T_world_camera = '[['", "cannot read the run jug, sphere, kinect-v1, seed 2"},
      {"UPDATE views SET T_world_camera = '[1, 2]'", "cannot read the run"},
      {"UPDATE runs SET refused_at_end = '{\"no_ik\": -1}'", "refusals"},
      {"UPDATE runs SET scan_refused = '{'", "cannot read the run"},
      {"UPDATE views SET refused = '7'", "refusals"},
      {"UPDATE runs SET seconds = 'long' WHERE seed = 3", "seconds that the run jug, sphere, kinect-v1, seed 3"},
      {"UPDATE runs SET seconds = 9e999", "value of seconds"},
      {"UPDATE views SET path_m = x'00'", "value of path_m"},
      {"UPDATE views SET gain = -9e999", "value of gain "},
      {"UPDATE views SET candidates = -1", "value of candidates"},
      {"UPDATE views SET coverage = 1.7", "value of coverage"},
      {"UPDATE runs SET coverage = -0.1", "value of coverage"},
      {"UPDATE runs SET initial_coverage = 'x'", "value of initial_coverage"},
      {"UPDATE runs SET f_score = 'x'", "value of f_score"},
      {"UPDATE runs SET seed = 'x' WHERE seed = 3", "value of seed"},
      {"UPDATE runs SET scene = x'4a'", "value of scene"},
      {"DELETE FROM views WHERE run = 1", "lacks views"},
      {"DELETE FROM views WHERE number = 1", "lacks views"},
      {"UPDATE views SET number = 0 WHERE number = 1", "lacks views"},
      {"UPDATE views SET number = number + 10 WHERE run = 2", "lacks views"},
      {"UPDATE runs SET views = 7", "lacks views"},
      {"UPDATE runs SET coverage = coverage + 1e-9", "other figures for the end of the run"},
      {"UPDATE runs SET unknown_left = 5", "other figures for the end of the run"},
      {"UPDATE runs SET chamfer_m = NULL", "other figures for the end of the run"}};
  for (const Spoiled& spoiled : all) {
    folder.write("shard", good);
    ASSERT_TRUE(SqliteFile::open(folder / "shard", 0)->run(spoiled.sql)) << spoiled.sql;
    const auto merged = campaign.merge(std::vector{folder / "shard"}, kAll);
    ASSERT_FALSE(merged) << spoiled.sql;
    EXPECT_EQ(merged.error().code, Errc::corrupt_data) << spoiled.sql << ' ' << merged.error().to_string();
    EXPECT_EQ(merged.error().context.find((folder / "shard").string()), 0U) << merged.error().to_string();
    EXPECT_NE(merged.error().message.find(spoiled.part), std::string::npos) << merged.error().to_string();
    EXPECT_EQ(campaign.runs()->size(), 1U);
  }
  folder.write("shard", good);
  EXPECT_EQ(campaign.merge(std::vector{folder / "shard"}, kAll)->added, 2U);
}

TEST(CampaignMerge, RunsThatDoNotBelongAreLeftOutAndCounted) {
  const TempFolder folder;
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  const std::vector files{shard(folder, "a", 1, 4), shard(folder, "b", 5, 6)};
  const AcceptRun odd = [](const StoredRun& run) {
    return run.key.seed % 2 == 1 ? MergeChoice{} : MergeChoice{false, "even"};
  };
  const auto merged = campaign.merge(files, odd);
  ASSERT_TRUE(merged) << merged.error().to_string();
  EXPECT_EQ(merged->added, 3U);
  EXPECT_EQ(merged->left_out, 3U);
  EXPECT_EQ(campaign.find(key_of(2)).value(), std::nullopt);
  test::expect_same(*campaign.find(key_of(3)).value(), run_of(key_of(3), 3));
  const auto again = campaign.merge(files, odd);
  EXPECT_EQ(again->known, 3U);
  EXPECT_EQ(again->left_out, 3U);

  // A file with nothing that belongs is an error, and what came before it is undone.
  const auto refused = campaign.merge(std::vector{shard(folder, "c", 7, 7), shard(folder, "d", 8, 8)}, odd);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().to_string(), (folder / "d").string() + ": even");
  EXPECT_EQ(campaign.runs()->size(), 3U);
}

TEST(CampaignMerge, WhatCannotBeReadNamesTheRunAndTheFile) {
  const TempFolder folder;
  const Campaign campaign = Campaign::open(folder / "campaign").value();
  ASSERT_TRUE(*campaign.add(run_of(key_of(1))));
  const auto expect_named = [&](const Error& error) {
    EXPECT_EQ(error.code, Errc::corrupt_data);
    EXPECT_NE(error.to_string().find(campaign.path().string()), std::string::npos) << error.to_string();
    EXPECT_NE(error.to_string().find("the run jug, sphere, kinect-v1, seed 1"), std::string::npos) << error.to_string();
  };
  ASSERT_TRUE(SqliteFile::open(campaign.path(), 0)->run("UPDATE views SET refused = '['"));
  expect_named(campaign.runs().error());
  expect_named(campaign.find(key_of(1)).error());
  expect_named(campaign.figures([](const CampaignKey&) { return true; }).error());
  ASSERT_TRUE(SqliteFile::open(campaign.path(), 0)->run("UPDATE runs SET stopped_because = 'x'"));
  expect_named(campaign.figures([](const CampaignKey&) { return false; }).error());
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
