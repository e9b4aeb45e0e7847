// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/campaign.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "campaign_runs.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/trial/campaign_summary.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::expect_same;
using test::key_of;
using test::run_of;
using test::TempFolder;
using test::times_of;

TEST(Campaign, GivesBackWhatWasStoredAfterReopening) {
  const TempFolder folder;
  const fs::path path = folder / "campaign.sqlite";
  {
    const auto campaign = Campaign::open(path);
    ASSERT_TRUE(campaign) << campaign.error().to_string();
    EXPECT_FALSE(*campaign->has(key_of(1)));
    EXPECT_TRUE(*campaign->add(run_of(key_of(1))));
    EXPECT_TRUE(*campaign->add(run_of(key_of(2), 0)));
  }
  const auto campaign = Campaign::open(path);
  ASSERT_TRUE(campaign);
  const auto runs = campaign->runs();
  ASSERT_TRUE(runs) << runs.error().to_string();
  ASSERT_EQ(runs->size(), 2U);
  expect_same((*runs)[0], run_of(key_of(1)));
  expect_same((*runs)[1], run_of(key_of(2), 0));
  EXPECT_EQ((*runs)[0].finished_at.size(), std::string{"2024-06-30T12:00:00Z"}.size());
  const auto found = campaign->find(key_of(2));
  ASSERT_TRUE(found && *found);
  expect_same(**found, run_of(key_of(2), 0));
  EXPECT_FALSE(*campaign->find(key_of(3)));
  // One file, and nothing beside it.
  EXPECT_EQ(std::distance(fs::directory_iterator{folder.path()}, fs::directory_iterator{}), 1);
}

TEST(Campaign, EveryPartOfTheKeyTellsRunsApart) {
  const TempFolder folder;
  const auto campaign = Campaign::open(folder / "c");
  ASSERT_TRUE(campaign);
  ASSERT_TRUE(*campaign->add(run_of(key_of(1))));
  CampaignEntry again = run_of(key_of(1), 1);
  EXPECT_FALSE(*campaign->add(again));  // the first one stays
  EXPECT_EQ((**campaign->find(key_of(1))).run.views.size(), 2U);
  std::vector<CampaignKey> others(6, key_of(1));
  others[0].scene = "Jug";
  others[1].scene_hash += "0";
  others[2].strategy = "random";
  others[3].seed = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  others[4].settings = R"({"max_views":3,"voxel_size_m":0.0100001})";
  others[5].noise = "none";
  others[5].settings = R"({"max_views":3,"noise":"none","voxel_size_m":0.01})";
  for (const CampaignKey& other : others) {
    EXPECT_FALSE(*campaign->has(other));
    EXPECT_TRUE(*campaign->add(run_of(other)));
    EXPECT_EQ((**campaign->find(other)).key, other);
  }
  EXPECT_EQ(campaign->runs()->size(), 7U);
}

TEST(Campaign, RefusesWhatItCannotKeep) {
  const TempFolder folder;
  const auto campaign = Campaign::open(folder / "c");
  ASSERT_TRUE(campaign);
  CampaignEntry run = run_of(key_of(std::uint64_t{1} << 63U));
  EXPECT_EQ(campaign->add(run).error().code, Errc::invalid_argument);
  EXPECT_EQ(campaign->has(run.key).error().code, Errc::invalid_argument);
  run = run_of(key_of(1));
  run.run.views[1].measures.f_score = std::nan("");
  EXPECT_EQ(campaign->add(run).error().code, Errc::invalid_argument);
  EXPECT_TRUE(campaign->runs()->empty());
}

TEST(Campaign, ForeignFilesAreLeftAsTheyAre) {
  const TempFolder folder;
  const auto content = [](const fs::path& path) { return fs::is_directory(path) ? "" : *read_text_file(path); };
  const auto refused = [&](const std::string& name, Errc code, const std::string& part) {
    const fs::path path = folder / name;
    const std::string before = content(path);
    const auto campaign = Campaign::open(path);
    ASSERT_FALSE(campaign) << name;
    EXPECT_EQ(campaign.error().code, code) << name;
    EXPECT_EQ(campaign.error().context, path.string());
    EXPECT_NE(campaign.error().message.find(part), std::string::npos) << campaign.error().message;
    EXPECT_EQ(content(path), before);
  };
  folder.write("short", "hello");
  refused("short", Errc::corrupt_data, "not an SQLite file");
  folder.write("long", std::string(20000, 'x'));
  refused("long", Errc::corrupt_data, "not an SQLite file");
  fs::create_directory(folder / "folder");
  refused("folder", Errc::invalid_argument, "is a folder");
  ASSERT_TRUE(SqliteFile::open(folder / "other", 0)->run("CREATE TABLE songs (name TEXT)"));
  refused("other", Errc::invalid_argument, "another program");
  ASSERT_TRUE(SqliteFile::open(folder / "tagged", 0)->run("PRAGMA application_id = 7"));
  refused("tagged", Errc::invalid_argument, "another program");
  ASSERT_TRUE(Campaign::open(folder / "newer"));
  ASSERT_TRUE(SqliteFile::open(folder / "newer", 0)->run("PRAGMA user_version = 99"));
  refused("newer", Errc::unsupported, "newer Saccade");
  const auto nowhere = Campaign::open(folder / "no/such/folder/c");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, Errc::io_failure);
  EXPECT_NE(nowhere.error().message.find("No such file"), std::string::npos) << nowhere.error().message;
}

TEST(Campaign, DamagedFilesAreErrorsNotCrashes) {
  const TempFolder folder;
  const fs::path whole = folder / "whole";
  {
    const auto campaign = Campaign::open(whole);
    for (std::uint64_t seed = 1; seed <= 40; ++seed) ASSERT_TRUE(*campaign->add(run_of(key_of(seed))));
  }
  const std::string bytes = *read_text_file(whole);
  ASSERT_GT(bytes.size(), 20000U);
  int errors = 0;
  for (std::size_t cut = 1000; cut < bytes.size(); cut += 1777) {
    folder.write("cut", bytes.substr(0, cut));
    const auto campaign = Campaign::open(folder / "cut");
    const auto runs = campaign ? campaign->runs() : Result<std::vector<CampaignEntry>>{campaign.error()};
    errors += runs ? 0 : 1;
    EXPECT_TRUE(runs || runs.error().code == Errc::corrupt_data) << cut << ' ' << runs.error().to_string();
  }
  EXPECT_GT(errors, 5);
}

TEST(Campaign, AFullDiskIsOneErrorAndLosesNothing) {
  const TempFolder folder;
  const fs::path path = folder / "c";
  const auto campaign = Campaign::open(path);
  ASSERT_TRUE(campaign);
  ASSERT_TRUE(*campaign->add(run_of(key_of(1))));
  auto* handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{fs::file_size(path), before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  const auto stored = campaign->add(run_of(key_of(2), 500));
  const auto created = Campaign::open(folder / "another");
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(stored);
  EXPECT_EQ(stored.error().code, Errc::io_failure);
  EXPECT_EQ(stored.error().context, path.string());
  EXPECT_NE(stored.error().message.find("cannot be written"), std::string::npos) << stored.error().message;
  EXPECT_TRUE(*campaign->has(key_of(1)));
  EXPECT_FALSE(*campaign->has(key_of(2)));
  EXPECT_TRUE(*campaign->add(run_of(key_of(2), 500)));
  EXPECT_EQ((**campaign->find(key_of(2))).run.views.size(), 500U);
}

/// Adds runs with the seeds first, first + step, … until `count` or for ever; for use in a child process.
[[noreturn]] void add_runs(const fs::path& path, std::uint64_t first, std::uint64_t step, int count) {
  const auto campaign = Campaign::open(path);
  for (int i = 0; campaign && (count == 0 || i < count); ++i) {
    const auto added = campaign->add(run_of(key_of(first + step * static_cast<std::uint64_t>(i)), 30));
    if (!added || !*added) ::_exit(2);
  }
  ::_exit(campaign ? 0 : 1);
}

TEST(Campaign, AKilledProcessLosesNoFinishedRunAndLeavesNoHalfOne) {
  const TempFolder folder;
  const fs::path path = folder / "c";
  std::size_t stored = 0;
  for (int round = 0; round < 5; ++round) {
    const pid_t child = ::fork();
    if (child == 0) add_runs(path, 1000U * static_cast<std::uint64_t>(round) + 1, 1, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds{60 + 23 * round});
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const auto campaign = Campaign::open(path);
    ASSERT_TRUE(campaign) << campaign.error().to_string();
    const auto runs = campaign->runs();
    ASSERT_TRUE(runs) << runs.error().to_string();
    EXPECT_GE(runs->size(), stored);
    stored = runs->size();
    for (const CampaignEntry& run : *runs) {
      EXPECT_EQ(run.run.views.size(), 30U);
      EXPECT_TRUE(*campaign->has(run.key));
    }
  }
  EXPECT_GT(stored, 0U);
}

TEST(Campaign, TwoProcessesShareAFile) {
  const TempFolder folder;
  const fs::path path = folder / "c";
  constexpr int kRuns{40};
  const pid_t odd = ::fork();
  if (odd == 0) add_runs(path, 1, 2, kRuns);
  const pid_t even = ::fork();
  if (even == 0) add_runs(path, 2, 2, kRuns);
  for (const pid_t child : {odd, even}) {
    int status{-1};
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  const auto campaign = Campaign::open(path);
  ASSERT_TRUE(campaign);
  EXPECT_EQ(campaign->runs()->size(), 2U * kRuns);
  EXPECT_EQ(SqliteFile::open(path, 0)
                ->integer("SELECT count(*) FROM pragma_integrity_check WHERE integrity_check = 'ok'")
                .value(),
            1);
  EXPECT_EQ(SqliteFile::open(path, 0)->integer("SELECT count(*) FROM curves").value(), 2 * kRuns * 31);
}

TEST(Campaign, AFileOfTheFirstVersionIsBroughtUpToDate) {
  const TempFolder folder;
  const fs::path path = folder / "c";
  {
    const SqliteFile file = SqliteFile::open(path, 0).value();
    ASSERT_TRUE(file.run(*read_text_file(test::source_folder() / "tests/unit/trial/campaign_version_1.sql")));
  }
  for (int round = 0; round < 2; ++round) {  // the second time there is nothing to do
    const auto campaign = Campaign::open(path);
    ASSERT_TRUE(campaign) << campaign.error().to_string();
    const auto runs = campaign->runs();
    ASSERT_TRUE(runs) << runs.error().to_string();
    ASSERT_EQ(runs->size(), 4U + static_cast<std::size_t>(round));
    EXPECT_EQ((*runs)[0].key.noise, "kinect-v1");
    EXPECT_EQ((*runs)[1].key.noise, "kinect-v2");
    EXPECT_EQ((*runs)[2].key.noise, "none");
    EXPECT_EQ((*runs)[3].key.noise, "kinect-v1");  // its settings are not JSON
    const CampaignEntry& old = runs->front();
    EXPECT_EQ(old.key.scene, "jug");
    EXPECT_EQ(old.run.scan.measures.coverage, 0.25);
    ASSERT_EQ(old.run.views.size(), 1U);
    EXPECT_EQ(old.run.views[0].candidates, 960U);
    EXPECT_EQ(old.run.views[0].refused.total(), 0U);
    EXPECT_EQ(old.run.views[0].times, times_of({0.0, 0.5, 0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 7.0}));
    EXPECT_EQ(*campaign->add(run_of(key_of(77))), round == 0);
    expect_same(**campaign->find(key_of(77)), run_of(key_of(77)));
  }
  const SqliteFile file = SqliteFile::open(path, 0).value();
  EXPECT_EQ(file.integer("SELECT count(*) FROM curves WHERE noise = 'kinect-v1' AND number = 1").value(), 2);
}

TEST(Campaign, TablesAreQuotedAndLeaveOutWhatIsNotThere) {
  CampaignEntry run = run_of(key_of(7), 1);
  run.key.scene = "a \"jug\", large";
  const TempFolder folder;
  ASSERT_TRUE(write_runs_csv(folder / "runs.csv", {&run, 1}, 3));
  ASSERT_TRUE(write_views_csv(folder / "views.csv", {&run, 1}));
  const std::string text = read_text_file(folder / "runs.csv").value();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_NE(text.find("\n\"a \"\"jug\"\", large\",00ff00ff00ff00ff,sphere,kinect-v1,7,views_used_up,0.25,0.507,"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find(R"("{""max_views"":3,""voxel_size_m"":0.01}")"), std::string::npos) << text;
  const std::string views = read_text_file(folder / "views.csv").value();
  EXPECT_NE(views.find(",sphere,kinect-v1,7,0,,,,,,,,,,,,,,,,,,,,,0.25,1000,100,,,\n"), std::string::npos) << views;
  EXPECT_NE(
      views.find(
          ",sphere,kinect-v1,7,1,0,321.5,300.25,960,700,260,5,1,0,1.5,2.25,0.5,0.1,3,4,1.25,20.25,2,0,7,0.507,900,"
          "90,0.0012,0.0034,0.9\n"),
      std::string::npos)
      << views;
  run.key.scene = "jug";
  const std::string summary = summary_csv(summarize({&run, 1}, 3)).text();
  EXPECT_NE(summary.find("\njug,sphere,kinect-v1,coverage,1,0.507,,\n"), std::string::npos) << summary;
  EXPECT_NE(summary.find("\njug,sphere,kinect-v1,views_to_90,0,,,\n"), std::string::npos) << summary;
}

TEST(Campaign, TablesAreWrittenInParts) {
  const std::vector<CampaignEntry> many(3000, run_of(key_of(7), 1));
  const TempFolder folder;
  const auto lines = [&](const std::string& name) {
    const std::string text = read_text_file(folder / name).value();
    std::vector<std::string> found;
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
      found.push_back(text.substr(at, text.find('\n', at) - at));
    }
    return found;
  };
  ASSERT_TRUE(write_runs_csv(folder / "runs.csv", many, 3));
  ASSERT_TRUE(write_views_csv(folder / "views.csv", many));
  const std::vector<std::string> runs = lines("runs.csv");
  const std::vector<std::string> views = lines("views.csv");
  ASSERT_EQ(runs.size(), 1 + many.size());
  ASSERT_EQ(views.size(), 1 + 2 * many.size());
  EXPECT_EQ(std::count(runs.begin(), runs.end(), runs[1]), 3000);
  EXPECT_EQ(std::count(views.begin(), views.end(), views[1]), 3000);
  EXPECT_EQ(std::count(views.begin(), views.end(), views[2]), 3000);
  EXPECT_FALSE(write_runs_csv(folder / "missing" / "runs.csv", many, 3));
}

}  // namespace
}  // namespace saccade
