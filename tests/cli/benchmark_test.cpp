// SPDX-License-Identifier: Apache-2.0
// saccade benchmark: its list, its errors, and a small campaign that goes on after it was interrupted and killed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "compare_runs.hpp"
#include "report_page.hpp"
#include "saccade/io/files/json_io.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

/// Both shares of a run after one of its views, by curves.csv.
struct Shares {
  double of_visible{0.0};
  double of_all{0.0};
};
Shares shares_in(const fs::path& curves, const std::string& run_and_view) {
  std::ifstream file{curves};
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(run_and_view + ",")) continue;
    const std::size_t all = line.find(',', run_and_view.size() + 1) + 1;
    return {std::stod(line.substr(run_and_view.size() + 1)), std::stod(line.substr(all))};
  }
  ADD_FAILURE() << curves << " has no " << run_and_view;
  return {};
}

std::vector<std::string> csv_lines(const fs::path& path) {
  std::ifstream file{path};
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// Expects mean and interval of the differences of two objects. For one degree of freedom t is tan(0.95 π/2), 12.7062.
void expect_difference_of_two(const nlohmann::json& told, double a, double b) {
  const double mean = 0.5 * (a + b);
  const double half = 12.7062047361747 * 0.5 * std::abs(a - b);
  EXPECT_EQ(told.at("n"), 2);
  EXPECT_NEAR(told.at("mean"), mean, 1e-9);
  EXPECT_NEAR(told.at("low"), mean - half, 1e-9);
  EXPECT_NEAR(told.at("high"), mean + half, 1e-9);
  EXPECT_EQ(told.at("excludes_0"), std::abs(mean) > half);
}

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
  const auto only = [&out](const std::string& protocol, const std::string& names, const Arguments& parts) {
    expect_failure(run_program({"benchmark", protocol, "--only", names, "--out", out}), 2, "benchmark", parts);
  };
  only("view-sphere", "rabbit", {"--only", "figure, hare, coil"});
  only("view-sphere", "hare@4", {"--only", "hare@4"});  // it begins from one view
  only("one-shot", "jug,hare@5", {"hare@5", "one first view of an object is such as figure@4", "did you mean hare@4?"});

  std::ofstream{folder / "BunnyMesh.ply"} << "abc";
  const Outcome mesh = run_program({"benchmark", "view-sphere", "--objects", folder.path().string(), "--out", out});
  EXPECT_NE(mesh.status, 0);
  for (const char* part : {"BunnyMesh.ply", "900150983cd24fb0d6963f7d28e17f72", "568f871d1a221ba6627569f1e6f9a3f2",
                           "Stanford 3D Scanning Repository"}) {
    EXPECT_NE(mesh.err.find(part), std::string::npos) << mesh.err;
  }
  EXPECT_FALSE(fs::exists(out));
}

TEST(BenchmarkCommand, TakesObjectsAndSingleFirstViewsByTheNamesThatItLists) {
  const TempFolder folder;
  const auto listed = [&](const std::string& names) {
    const Outcome runs = run_program({"benchmark", "one-shot", "--only", names, "--strategies", "random", "--out",
                                      (folder / "out").string(), "--list", "--json", "-"});
    EXPECT_EQ(runs.status, 0) << runs.err;
    const nlohmann::json document = runs.json();
    Arguments scenes;
    for (const nlohmann::json& run : document.at("result").at("runs")) scenes.push_back(run.at("scene"));
    return scenes;
  };
  EXPECT_EQ(listed("jug,hare@12"), (Arguments{"hare@12", "jug@4", "jug@12", "jug@20", "jug@28"}));
  EXPECT_EQ(listed("hare@12,hare@4"), (Arguments{"hare@4", "hare@12"}));
}

TEST(BenchmarkCommand, TakesAnyMeshesAndSaysThatTheyAreNotThePublishedOnes) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const std::string out = (folder / "out").string();
  fs::create_directory(folder / "own");
  const std::string box{
      "OFF\n8 6 0\n0 0 0\n80 0 0\n80 60 0\n0 60 0\n0 0 90\n80 0 90\n80 60 90\n0 60 90\n"
      "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n"};
  for (const char* name : {"box.off", "crate.off"}) std::ofstream{folder / "own" / name} << box;
  const Arguments wanted{"benchmark", "household", "--meshes",     (folder / "own").string(),
                         "--only",    "crate",     "--strategies", "random",
                         "--out",     out};
  expect_failure(run_program(wanted), 3, "benchmark", {"80 x 60 x 90 m", "0.001 (millimetres)", "--mesh-scale"});
  EXPECT_FALSE(fs::exists(out));
  const Outcome done = run_program(wanted + Arguments{"--mesh-scale", "0.001", "--json", (folder / "r.json").string()});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_NE(done.out.find("OTHER OBJECTS"), std::string::npos) << done.out;
  const nlohmann::json benchmark = read_json(folder / "r.json")->at("result").at("benchmark");
  EXPECT_EQ(benchmark.at("objects"), (Arguments{"crate"}));
  EXPECT_EQ(benchmark.at("objects_from"), "own");
  EXPECT_GT(benchmark.at("table")[0].at("of_all").at("mean").get<double>(), 0.3);

  const auto refused = [&](const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(Arguments{"benchmark", "household", "--strategies", "random", "--out", out} + more), 2,
                   "benchmark", parts);
  };
  refused({"--meshes", "own", "--objects", "own"}, {"--meshes", "--objects"});
  refused({"--meshes", "no.txt"}, {"--meshes", "no.txt", "PLY, STL"});
  refused({"--mesh-scale", "0.1"}, {"--mesh-scale", "goes with --meshes"});
  refused({"--mesh-up", "y"}, {"--mesh-up", "goes with --meshes"});
  refused({"--meshes", folder.path().string()}, {"--meshes", "holds no mesh"});
  refused({"--meshes", (folder / "own").string(), "--only", "hare"}, {"--only", "box, crate"});
}

TEST(BenchmarkCommand, RefusesTheSeedThatCampaignsDoNotUse) {
  const TempFolder folder;
  const std::string out = (folder / "out").string();
  expect_failure(run_program({"benchmark", "one-shot", "--seed", "3", "--out", out}), 2, "benchmark",
                 {"--seed:", "--seeds 3"});
  expect_failure(run_program({"--seed", "3", "compare", "--scenes", "tabletop-1", "--out", out}), 2, "compare",
                 {"--seed:", "--seeds 3"});
  EXPECT_FALSE(fs::exists(out));
}

TEST(BenchmarkEvidence, CountsObjectsNotFirstViews) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const Outcome done = run_program({"benchmark", "one-shot", "--only", "hare@4,hare@12", "--strategies", "random",
                                    "--out", (folder / "out").string(), "--quiet", "--json", "-"});
  ASSERT_EQ(done.status, 0) << done.err;
  const nlohmann::json benchmark = done.json().at("result").at("benchmark");
  EXPECT_EQ(benchmark.at("objects"), (Arguments{"hare"}));
  EXPECT_EQ(benchmark.at("scenes"), (Arguments{"hare@4", "hare@12"}));
  EXPECT_EQ(benchmark.at("complete"), true);
  std::size_t ours = 0;
  for (const nlohmann::json& row : benchmark.at("table")) {
    if (row.at("published") == true) {
      EXPECT_EQ(row.at("same_object"), false);
      continue;
    }
    ++ours;
    EXPECT_EQ(row.at("of_all").at("n"), 1);  // two starts of one object are no sample of objects
    EXPECT_TRUE(row.at("of_all").at("low").is_null());
    EXPECT_GT(row.at("views_taken").at("mean"), 1.0);
    EXPECT_LE(row.at("views_taken").at("mean"), row.at("views"));
  }
  EXPECT_EQ(ours, 2U);                                              // after 10 views, and after 12
  EXPECT_EQ(benchmark.at("differences"), nlohmann::json::array());  // there is one strategy
  EXPECT_EQ(csv_lines(folder / "out/differences.csv").size(), 1U);
  // Shortfalls come before figures that are reached.
  const auto lines = benchmark.at("beside_published").get<Arguments>();
  EXPECT_EQ(lines.size(), 3U);
  EXPECT_TRUE(std::is_partitioned(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("short of it") != std::string::npos;
  }));
}

TEST(BenchmarkCommand, InterruptedItsTableIsOverTheSameObjectsForAllStrategies) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const fs::path out = folder / "out";
  RunningProgram program{{"benchmark", "household", "--only", "hare,jug", "--strategies", "random,random-contours",
                          "--jobs", "1", "--out", out.string()}};
  ASSERT_TRUE(program.wait_for("hare, random-contours"));  // three of four runs are done
  program.send(SIGINT);
  const Outcome interrupted = program.finish();
  EXPECT_EQ(interrupted.status, 130) << interrupted.err;
  EXPECT_NE(interrupted.out.find("INCOMPLETE: 3 of 4 runs so far"), std::string::npos) << interrupted.out;
  EXPECT_NE(interrupted.out.find("the table has 1 run of each strategy"), std::string::npos) << interrupted.out;
  const nlohmann::json benchmark = report_in(out / "index.html").at("record").at("result").at("benchmark");
  EXPECT_EQ(benchmark.at("complete"), false);
  EXPECT_EQ(benchmark.at("runs").dump(), R"({"done":3,"each_strategy":1,"planned":4})");
  ASSERT_EQ(benchmark.at("table").size(), 2U);
  for (const nlohmann::json& row : benchmark.at("table")) EXPECT_EQ(row.at("of_all").at("n"), 1);
  // The row of random is that of the jug alone, though its run of the hare is done.
  const Shares jug = shares_in(out / "curves.csv", "jug,random,1,6");
  EXPECT_NEAR(benchmark.at("table")[0].at("of_visible").at("mean"), jug.of_visible, 1e-9);
  EXPECT_GT(jug.of_visible, 0.1);
  // So is the difference, and one object has no interval.
  const Shares jug_of_contours = shares_in(out / "curves.csv", "jug,random-contours,1,6");
  ASSERT_EQ(benchmark.at("differences").size(), 1U);
  const nlohmann::json one = benchmark.at("differences")[0];
  EXPECT_EQ(one.at("objects"), 1);
  EXPECT_NEAR(one.at("of_all").at("mean"), jug.of_all - jug_of_contours.of_all, 1e-9);
  for (const char* none : {"low", "high", "excludes_0"}) EXPECT_TRUE(one.at("of_all").at(none).is_null()) << none;
  EXPECT_NE(interrupted.out.find("(1 object); one object has no interval"), std::string::npos) << interrupted.out;
}

TEST(BenchmarkEvidence, DifferencesAreOverObjects) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"benchmark", "household", "--only", "hare,jug", "--strategies", "random,random-contours",
                         "--out",     out.string()};
  const Outcome done = run_program(wanted + Arguments{"--quiet", "--json", (folder / "result.json").string()});
  ASSERT_EQ(done.status, 0) << done.err;
  const nlohmann::json whole = read_json(folder / "result.json")->at("result").at("benchmark");
  ASSERT_EQ(whole.at("differences").size(), 1U);
  const nlohmann::json two = whole.at("differences")[0];
  EXPECT_EQ(two.at("method"), "random");
  EXPECT_EQ(two.at("beside"), "random-contours");
  EXPECT_EQ(two.at("views"), 6);
  EXPECT_EQ(two.at("objects"), 2);
  const Shares jug = shares_in(out / "curves.csv", "jug,random,1,6");
  const Shares jug_of_contours = shares_in(out / "curves.csv", "jug,random-contours,1,6");
  const Shares hare = shares_in(out / "curves.csv", "hare,random,1,6");
  const Shares hare_of_contours = shares_in(out / "curves.csv", "hare,random-contours,1,6");
  EXPECT_NE(hare.of_all, hare_of_contours.of_all);
  expect_difference_of_two(two.at("of_visible"), jug.of_visible - jug_of_contours.of_visible,
                           hare.of_visible - hare_of_contours.of_visible);
  expect_difference_of_two(two.at("of_all"), jug.of_all - jug_of_contours.of_all,
                           hare.of_all - hare_of_contours.of_all);
  for (const char* share : {"of_visible", "of_all"}) {  // it is that of the table's means
    const double apart = whole.at("table")[0].at(share).at("mean").get<double>() -
                         whole.at("table")[1].at(share).at("mean").get<double>();
    EXPECT_NEAR(two.at(share).at("mean"), apart, 1e-9) << share;
  }
  EXPECT_NE(done.out.find("random beside random-contours, by object: "), std::string::npos) << done.out;
  EXPECT_EQ(done.out.find("not corrected"), std::string::npos) << done.out;  // there is one comparison
  const std::vector<std::string> lines = csv_lines(out / "differences.csv");
  ASSERT_EQ(lines.size(), 2U);
  const std::string about{"household,2,stand-ins,yes,random,random-contours,6,2,"};
  ASSERT_TRUE(lines[1].starts_with(about)) << lines[1];
  EXPECT_NEAR(std::stod(lines[1].substr(about.size())), two.at("of_visible").at("mean").get<double>(), 1e-12);
  EXPECT_EQ(std::count(lines[1].begin(), lines[1].end(), ','), std::count(lines[0].begin(), lines[0].end(), ','));
}

TEST(BenchmarkEvidence, ARunThatNoSeedChangesStandsForAllSeeds) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const auto seeds = [&](const char* list) {
    return run_program({"benchmark", "household", "--only", "hare", "--strategies", "random,standard", "--seeds", list,
                        "--out", out.string(), "--quiet", "--json", (folder / "result.json").string()});
  };
  ASSERT_EQ(seeds("1").status, 0);
  const Shares of_standard = shares_in(out / "curves.csv", "hare,standard,1,6");
  const Outcome more = seeds("1-2");
  ASSERT_EQ(more.status, 0) << more.err;
  EXPECT_NE(more.out.find("1 done now, 2 found"), std::string::npos) << more.out;
  const Shares one = shares_in(out / "curves.csv", "hare,random,1,6");
  const Shares two = shares_in(out / "curves.csv", "hare,random,2,6");
  EXPECT_NE(one.of_all, two.of_all);
  const nlohmann::json told = read_json(folder / "result.json")->at("result").at("benchmark");
  EXPECT_EQ(told.at("complete"), true);
  EXPECT_EQ(told.at("runs").dump(), R"({"done":3,"each_strategy":2,"planned":3})");
  EXPECT_NEAR(told.at("table")[0].at("of_all").at("mean"), 0.5 * (one.of_all + two.of_all), 1e-9);
  EXPECT_NEAR(told.at("table")[1].at("of_all").at("mean"), of_standard.of_all, 1e-9);
}

TEST(BenchmarkCommand, InterruptedOrKilledItKeepsWhatWasDoneAndGoesOn) {
  if (kSanitized) GTEST_SKIP() << "its images have the size of the protocol's";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"benchmark", "household", "--only", "hare",      "--strategies", "random,random-contours",
                         "--jobs",    "1",         "--out",  out.string()};
  {
    RunningProgram program{wanted};
    ASSERT_TRUE(program.wait_for("hare, random-contours"));  // the first run is done
    program.send(SIGINT);
    const Outcome interrupted = program.finish();
    EXPECT_EQ(interrupted.status, 130) << interrupted.err;
    EXPECT_NE(interrupted.err.find("interrupted after 1 of 2 runs"), std::string::npos) << interrupted.err;
    EXPECT_NE(interrupted.out.find("1 done now, 0 found"), std::string::npos) << interrupted.out;
    EXPECT_EQ(runs_in(out).size(), 1U);
    const nlohmann::json told = report_in(out / "index.html").at("record").at("result");
    EXPECT_EQ(told.at("interrupted"), true);
    EXPECT_EQ(told.at("benchmark").at("table").size(), 1U);  // what was done has been measured
  }
  {
    RunningProgram program{wanted};
    ASSERT_TRUE(program.wait_for("hare, random-contours"));
    program.send(SIGKILL);
    EXPECT_EQ(program.finish().status, -1);
    EXPECT_EQ(runs_in(out).size(), 1U);
  }
  const Outcome last = run_program(wanted + Arguments{"--quiet", "--json", (folder / "result.json").string()});
  ASSERT_EQ(last.status, 0) << last.err;
  EXPECT_NE(last.out.find("STAND-INS"), std::string::npos) << last.out;
  EXPECT_NE(last.out.find("1 done now, 1 found"), std::string::npos) << last.out;

  const nlohmann::json result = read_json(folder / "result.json")->at("result");
  EXPECT_EQ(result.at("runs").at("done"), 2);
  const nlohmann::json& benchmark = result.at("benchmark");
  EXPECT_EQ(benchmark.at("name"), "household");
  EXPECT_EQ(benchmark.at("objects_from"), "stand-ins");
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
  EXPECT_EQ(lines_in("differences.csv"), 1 + 1);
  const std::string table = text_of(out / "table.csv");
  EXPECT_NE(table.find(",of_visible,of_visible_low,of_visible_high,of_all,of_all_low,of_all_high,objects,"),
            std::string::npos)
      << table;
  const Shares random = shares_in(out / "curves.csv", "hare,random,1,6");
  const Shares contours = shares_in(out / "curves.csv", "hare,random-contours,1,6");
  ASSERT_EQ(benchmark.at("differences").size(), 1U);
  const nlohmann::json difference = benchmark.at("differences")[0];
  EXPECT_NEAR(difference.at("of_visible").at("mean"), random.of_visible - contours.of_visible, 1e-9);
  EXPECT_NEAR(difference.at("of_all").at("mean"), random.of_all - contours.of_all, 1e-9);
  const std::vector<CampaignEntry> runs = runs_in(out);
  ASSERT_EQ(runs.size(), 2U);
  for (const CampaignEntry& run : runs) EXPECT_GT(run.run.views.size(), 2U) << run.key.strategy;
  EXPECT_EQ(report_in(out / "index.html").at("record").at("result").at("benchmark"), benchmark);
}

}  // namespace
}  // namespace saccade::test
