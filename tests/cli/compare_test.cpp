// SPDX-License-Identifier: Apache-2.0
// saccade compare, on small images and large voxels.
#include <gtest/gtest.h>

#include <algorithm>

#include "run_program.hpp"
#include "saccade/io/campaign.hpp"
#include "saccade/io/json_io.hpp"

namespace saccade::test {
namespace {

const Arguments kCoarse{"--image-size", "96,72", "--voxel-size", "0.03"};

Arguments compare(const fs::path& out, const Arguments& more) {
  return Arguments{"compare", "--scenes", "clutter:5", "--out", out.string(), "--max-views", "1"} + kCoarse +
         (std::count(more.begin(), more.end(), "--min-gain") > 0 ? more : more + Arguments{"--min-gain", "1"});
}

std::vector<CampaignRun> runs_in(const fs::path& out) {
  const auto campaign = Campaign::open(out / "campaign.sqlite");
  EXPECT_TRUE(campaign);
  const auto runs = campaign ? campaign->runs() : Result<std::vector<CampaignRun>>{campaign.error()};
  EXPECT_TRUE(runs);
  return runs ? *runs : std::vector<CampaignRun>{};
}

std::ptrdiff_t lines_of(const fs::path& path) {
  const std::string text = text_of(path);
  return std::count(text.begin(), text.end(), '\n');
}

TEST(CompareCommand, GoesOnWhereItStopped) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Outcome first = run_program(compare(out, {"--seeds", "1", "--quiet", "--json", "-"}));
  ASSERT_EQ(first.status, 0) << first.err;
  expect_envelope(first.json(), "compare");
  EXPECT_EQ(first.json().at("result").at("runs").dump(), R"({"done":2,"done_now":2,"planned":2})");
  const std::vector<CampaignRun> before = runs_in(out);
  ASSERT_EQ(before.size(), 2U);

  const Outcome second = run_program(compare(out, {"--seeds", "1-2", "--json", (folder / "result.json").string()}));
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_NE(second.err.find("2 of 4 runs found"), std::string::npos) << second.err;
  EXPECT_NE(second.out.find("2 done now, 2 found"), std::string::npos) << second.out;
  EXPECT_NE(second.out.find("sphere - random: "), std::string::npos) << second.out;
  const std::vector<CampaignRun> after = runs_in(out);
  ASSERT_EQ(after.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(after[i].key, before[i].key);
    EXPECT_EQ(after[i].seconds, before[i].seconds);  // it was not run again
  }
  const nlohmann::json result = read_json(folder / "result.json")->at("result");
  ASSERT_EQ(result.at("summaries").size(), 2U);
  const nlohmann::json& sphere = result.at("summaries")[0].at("coverage");
  EXPECT_EQ(sphere.at("n"), 2);
  EXPECT_NEAR(sphere.at("mean").get<double>(), 0.5 * (after[0].final().coverage + after[2].final().coverage), 1e-12);
  EXPECT_LT(sphere.at("low").get<double>(), sphere.at("mean").get<double>());
  EXPECT_EQ(result.at("gaps").at(0).at("coverage").at("n"), 2);
  EXPECT_EQ(names_in(out),
            (Arguments{"campaign.sqlite", "coverage-clutter-5.svg", "runs.csv", "summary.csv", "views.csv"}));
  EXPECT_EQ(lines_of(out / "runs.csv"), 5);
  EXPECT_EQ(lines_of(out / "views.csv"), 9);  // the scan and one view of each run
  EXPECT_EQ(lines_of(out / "summary.csv"), 3);
  EXPECT_TRUE(text_of(out / "coverage-clutter-5.svg").starts_with("<svg "));

  // Other settings are other runs.
  const Outcome listed = run_program(compare(out, {"--seeds", "1-2", "--list", "--no-noise", "--json", "-"}));
  ASSERT_EQ(listed.status, 0) << listed.err;
  const nlohmann::json planned = listed.json();
  for (const nlohmann::json& run : planned.at("result").at("runs")) EXPECT_EQ(run.at("found"), false);
}

TEST(CompareCommand, AnInterruptionKeepsWhatIsDone) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  RunningProgram program{compare(out, {"--seeds", "1-1000"})};
  ASSERT_TRUE(program.wait_for("sphere, seed 2"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("the same command goes on"), std::string::npos) << outcome.err;
  const std::vector<CampaignRun> runs = runs_in(out);
  EXPECT_GE(runs.size(), 2U);
  EXPECT_LT(runs.size(), 20U);
  EXPECT_EQ(lines_of(out / "runs.csv"), static_cast<std::ptrdiff_t>(runs.size()) + 1);
  const Outcome listed = run_program(compare(out, {"--seeds", "1-1000", "--list"}));
  EXPECT_NE(listed.out.find("2000 runs, " + std::to_string(runs.size()) + " of them done"), std::string::npos);
}

TEST(CompareCommand, HasTheFiguresOfExplore) {
  const TempFolder folder;
  const Outcome compared =
      run_program(compare(folder / "out", {"--seeds", "3", "--strategies", "random", "--quiet", "--threads", "1"}));
  ASSERT_EQ(compared.status, 0) << compared.err;
  const std::vector<CampaignRun> runs = runs_in(folder / "out");
  ASSERT_EQ(runs.size(), 1U);
  const Outcome explored = run_program(
      Arguments{"explore", "clutter:5", "--out", (folder / "run").string(), "--quiet", "--robot", "free", "--seed", "3",
                "--strategy", "random", "--max-views", "1", "--min-gain", "1", "--no-pictures", "--json", "-"} +
      kCoarse);
  ASSERT_EQ(explored.status, 0) << explored.err;
  const nlohmann::json result = explored.json().at("result");
  EXPECT_EQ(runs[0].initial.coverage, result.at("initial").at("coverage").get<double>());
  EXPECT_EQ(runs[0].stopped_because, result.at("stopped_because").get<std::string>());
  ASSERT_EQ(runs[0].views.size(), 1U);
  ASSERT_EQ(result.at("views").size(), 1U);
  const CampaignView& view = runs[0].views[0];
  const auto T_world_camera = pose_from_json(result.at("views")[0].at("T_world_camera"));
  ASSERT_TRUE(T_world_camera);
  EXPECT_LT((view.T_world_camera.matrix() - T_world_camera->matrix()).norm(), 1e-12);
  EXPECT_EQ(view.after.unknown_left, result.at("views")[0].at("unknown_left").get<std::size_t>());
  EXPECT_EQ(view.points_at_object, result.at("views")[0].at("points_at_object").get<bool>());
  const nlohmann::json& final = result.at("final");
  EXPECT_EQ(runs[0].final().coverage, final.at("coverage").get<double>());
  EXPECT_EQ(runs[0].final().unknown_near_objects, final.at("unknown_near_objects").get<std::size_t>());
  EXPECT_EQ(runs[0].final().f_score.value(), final.at("f_score").get<double>());
  EXPECT_EQ(runs[0].final().accuracy_m.value(), final.at("accuracy_m").get<double>());
}

TEST(CompareCommand, RandomGetsAsManyViewsAsSphereTook) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  // Nothing gains that much: sphere takes no view.
  const Arguments choosy{"--seeds", "1", "--min-gain", "1e9", "--quiet", "--no-noise"};
  ASSERT_EQ(run_program(compare(out, choosy)).status, 0);
  std::vector<CampaignRun> runs = runs_in(out);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].key.strategy, "sphere");
  EXPECT_TRUE(runs[0].views.empty() && runs[1].views.empty());
  ASSERT_EQ(run_program(compare(out, choosy + Arguments{"--no-equal-views"})).status, 0);
  runs = runs_in(out);
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[2].key.strategy, "random");
  EXPECT_EQ(nlohmann::json::parse(runs[2].key.settings).at("max_views"), 1);
}

TEST(CompareCommand, RefusesWhatItCannotDo) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const auto refused = [&out](const Arguments& more, int status, const Arguments& parts) {
    expect_failure(run_program(Arguments{"compare", "--out", out.string()} + more), status, "compare", parts);
    EXPECT_FALSE(fs::exists(out));
  };
  refused({}, 2, {"--scenes"});
  refused({"--scenes", "jug,,jug"}, 2, {"--scenes"});
  refused({"--scenes", "atrium"}, 3, {"no such scene"});
  refused({"--scenes", "jug", "--strategies", "best"}, 2, {"--strategies", "sphere"});
  for (const char* seeds : {"", "x", "3-1", "1-", "-1", "1,,2", "9223372036854775808", "0-9223372036854775807"})
    refused({"--scenes", "jug", "--seeds", seeds}, 2, {"--seeds"});
  refused({"--scenes", "jug", "--voxel-size", "0"}, 2, {"--voxel-size"});

  const Outcome listed = run_program(compare(out, {"--list"}));
  EXPECT_EQ(listed.status, 0) << listed.err;
  EXPECT_NE(listed.out.find("20 runs, 0 of them done"), std::string::npos) << listed.out;
  EXPECT_FALSE(fs::exists(out));

  folder.write("foreign/notes.txt", "mine");
  expect_failure(run_program(compare(folder / "foreign", {})), 3, "compare", {"holds other files", "--force"});
  folder.write("text/campaign.sqlite", "mine");
  expect_failure(run_program(compare(folder / "text", {})), 3, "compare", {"campaign.sqlite", "not an SQLite file"});
  EXPECT_EQ(text_of(folder / "text/campaign.sqlite"), "mine");
}

}  // namespace
}  // namespace saccade::test
