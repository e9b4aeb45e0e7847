// SPDX-License-Identifier: Apache-2.0
// saccade benchmark: its list, its errors, and a small run that goes on after an end.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "compare_runs.hpp"
#include "report_page.hpp"
#include "saccade/io/files/json_io.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

TEST(BenchmarkCommand, ListsItsProtocols) {
  const Outcome listed = run_program({"benchmark"});
  ASSERT_EQ(listed.status, 0) << listed.err;
  for (const char* name : {"view-sphere", "one-shot", "tabletop-arm", "household"}) {
    EXPECT_NE(listed.out.find(name), std::string::npos) << listed.out;
  }
  EXPECT_EQ(std::count(listed.out.begin(), listed.out.end(), '\n'), 4);
  const Outcome json = run_program({"benchmark", "--json", "-"});
  EXPECT_EQ(json.json().at("result").at("benchmarks").size(), 4U);
}

TEST(BenchmarkCommand, SaysWhatIsWrong) {
  const TempFolder folder;
  const std::string out = (folder / "out").string();
  const Outcome unknown = run_program({"benchmark", "view-spere", "--out", out});
  EXPECT_EQ(unknown.status, 2) << unknown.err;
  EXPECT_NE(unknown.err.find("view-sphere, one-shot, tabletop-arm, household"), std::string::npos) << unknown.err;
  EXPECT_NE(run_program({"benchmark", "view-sphere"}).err.find("--out"), std::string::npos);
  const Outcome strategy = run_program({"benchmark", "one-shot", "--strategies", "surfaces", "--out", out});
  EXPECT_EQ(strategy.status, 2);
  EXPECT_NE(strategy.err.find("surface-one-shot"), std::string::npos) << strategy.err;
  const Outcome object = run_program({"benchmark", "view-sphere", "--only", "rabbit", "--out", out});
  EXPECT_NE(object.status, 0);
  EXPECT_NE(object.err.find("figure, hare, coil"), std::string::npos) << object.err;

  std::ofstream{folder / "BunnyMesh.ply"} << "abc";
  const Outcome mesh = run_program({"benchmark", "view-sphere", "--objects", folder.path().string(), "--out", out});
  EXPECT_NE(mesh.status, 0);
  for (const char* part : {"BunnyMesh.ply", "900150983cd24fb0d6963f7d28e17f72", "568f871d1a221ba6627569f1e6f9a3f2",
                           "Stanford 3D Scanning Repository"}) {
    EXPECT_NE(mesh.err.find(part), std::string::npos) << mesh.err;
  }
  EXPECT_FALSE(fs::exists(out));
}

TEST(BenchmarkCommand, RunsAndGoesOnWhereItStopped) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const auto with = [&](const std::string& strategies) {
    return run_program({"benchmark", "household", "--only", "hare", "--strategies", strategies, "--out", out.string(),
                        "--quiet", "--json", (folder / "result.json").string()});
  };
  const Outcome first = with("random");
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_NE(first.out.find("STAND-INS"), std::string::npos) << first.out;
  const Outcome second = with("random,random-contours");
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_NE(second.out.find("1 done now, 1 found"), std::string::npos) << second.out;

  const nlohmann::json result = read_json(folder / "result.json")->at("result");
  EXPECT_EQ(result.at("runs").at("done"), 2);
  const nlohmann::json& benchmark = result.at("benchmark");
  EXPECT_EQ(benchmark.at("name"), "household");
  EXPECT_EQ(benchmark.at("stand_ins"), true);
  ASSERT_EQ(benchmark.at("table").size(), 2U);
  for (const nlohmann::json& row : benchmark.at("table")) {
    EXPECT_EQ(row.at("views"), 6.0);
    EXPECT_GT(row.at("of_visible").at("mean").get<double>(), row.at("of_all").at("mean").get<double>());
    EXPECT_GT(row.at("of_all").at("mean").get<double>(), 0.1);
  }
  // Each run has a line for each of six views; the table one for each strategy.
  const auto lines_in = [&](const char* file) {
    const std::string text = text_of(out / file);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines_in("curves.csv"), 1 + 2 * 6);
  EXPECT_EQ(lines_in("table.csv"), 1 + 2);
  const std::vector<CampaignEntry> runs = runs_in(out);
  ASSERT_EQ(runs.size(), 2U);
  for (const CampaignEntry& run : runs) EXPECT_GT(run.run.views.size(), 2U) << run.key.strategy;
  EXPECT_EQ(report_in(out / "index.html").at("record").at("result").at("benchmark"), benchmark);
}

}  // namespace
}  // namespace saccade::test
