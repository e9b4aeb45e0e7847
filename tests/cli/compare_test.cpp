// SPDX-License-Identifier: Apache-2.0
// saccade compare, on small images and large voxels.
#include <gtest/gtest.h>

#include <algorithm>

#include "compare_runs.hpp"
#include "report_page.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/sqlite_file.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

std::ptrdiff_t lines_of(const fs::path& path) {
  const std::string text = text_of(path);
  return std::count(text.begin(), text.end(), '\n');
}

TEST(CompareCommand, GoesOnWhereItStopped) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Outcome first = run_program(compare_scenes(out, "clutter:5", {"--seeds", "1", "--quiet", "--json", "-"}));
  ASSERT_EQ(first.status, 0) << first.err;
  expect_envelope(first.json(), "compare");
  EXPECT_EQ(first.json().at("result").at("runs").dump(), R"({"done":2,"done_now":2,"planned":2})");
  const std::vector<CampaignEntry> before = runs_in(out);
  ASSERT_EQ(before.size(), 2U);

  const Outcome second =
      run_program(compare_scenes(out, "clutter:5", {"--seeds", "1-2", "--json", (folder / "result.json").string()}));
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_NE(second.err.find("2 of 4 runs found"), std::string::npos) << second.err;
  EXPECT_NE(second.out.find("2 done now, 2 found"), std::string::npos) << second.out;
  EXPECT_NE(second.out.find("sphere - random: "), std::string::npos) << second.out;
  const std::vector<CampaignEntry> after = runs_in(out);
  ASSERT_EQ(after.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(after[i].key, before[i].key);
    EXPECT_EQ(after[i].seconds, before[i].seconds);  // it was not run again
  }
  const nlohmann::json result = read_json(folder / "result.json")->at("result");
  ASSERT_EQ(result.at("summaries").size(), 2U);
  const nlohmann::json& sphere = result.at("summaries")[0].at("coverage");
  EXPECT_EQ(sphere.at("n"), 2);
  double sum = 0.0;  // runs that were done at once are stored in any order
  for (const CampaignEntry& run : after)
    sum += run.key.strategy == "sphere" ? run.run.final().coverage.value_or(0.0) : 0.0;
  EXPECT_NEAR(sphere.at("mean").get<double>(), 0.5 * sum, 1e-12);
  EXPECT_LT(sphere.at("low").get<double>(), sphere.at("mean").get<double>());
  EXPECT_EQ(result.at("gaps").at(0).at("coverage").at("n"), 2);
  EXPECT_EQ(names_in(out), (Arguments{"campaign.sqlite", "coverage-clutter-5.svg", "index.html", "runs.csv",
                                      "summary.csv", "unknown-clutter-5.svg", "views.csv"}));
  EXPECT_EQ(lines_of(out / "runs.csv"), 5);
  EXPECT_EQ(lines_of(out / "views.csv"), 9);  // the scan and one view of each run
  EXPECT_EQ(lines_of(out / "summary.csv"), 1 + 2 * (std::ssize(run_figures()) + 3));  // and how promises were kept
  const nlohmann::json page = report_in(out / "index.html");
  EXPECT_EQ(page.at("record").at("result").at("summaries"), result.at("summaries"));
  const nlohmann::json& details = page.at("details");
  EXPECT_EQ(details.at("measures").size(), run_figures().size());
  EXPECT_EQ(details.at("gaps").at(0).at("coverage"), result.at("gaps").at(0).at("coverage"));
  EXPECT_EQ(details.at("curves").at(0).at("coverage").size(), 2U);
  EXPECT_EQ(details.at("marks").size(), 4U);
  EXPECT_TRUE(text_of(out / "coverage-clutter-5.svg").starts_with("<svg "));

  // Other settings are other runs.
  const Outcome listed =
      run_program(compare_scenes(out, "clutter:5", {"--seeds", "1-2", "--list", "--no-noise", "--json", "-"}));
  ASSERT_EQ(listed.status, 0) << listed.err;
  const nlohmann::json planned = listed.json();
  for (const nlohmann::json& run : planned.at("result").at("runs")) EXPECT_EQ(run.at("found"), false);
}

TEST(CompareCommand, AnInterruptionKeepsWhatIsDone) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  const TempFolder folder;
  const fs::path out = folder / "out";
  RunningProgram program{compare(out, {"--seeds", "1-1000"})};
  ASSERT_TRUE(program.wait_for("sphere, seed 5"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("the same command goes on"), std::string::npos) << outcome.err;
  const std::vector<CampaignEntry> runs = runs_in(out);
  EXPECT_GE(runs.size(), 2U);
  EXPECT_LT(runs.size(), 40U);
  EXPECT_EQ(lines_of(out / "runs.csv"), static_cast<std::ptrdiff_t>(runs.size()) + 1);
  const Outcome listed = run_program(compare(out, {"--seeds", "1-1000", "--list"}));
  EXPECT_NE(listed.out.find("2000 runs, " + std::to_string(runs.size()) + " of them done"), std::string::npos);
}

TEST(CompareCommand, HasTheFiguresOfExplore) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  for (const char* robot : {"free", "comau"}) {
    const TempFolder folder;
    const Outcome compared = run_program(compare(
        folder / "out", {"--seeds", "3", "--strategies", "random", "--robot", robot, "--quiet", "--threads", "1"}));
    ASSERT_EQ(compared.status, 0) << compared.err;
    const std::vector<CampaignEntry> runs = runs_in(folder / "out");
    ASSERT_EQ(runs.size(), 1U);
    const Outcome explored =
        run_program(Arguments{"explore", tiny_cell_file(), "--out", (folder / "run").string(), "--quiet", "--robot",
                              robot, "--seed", "3", "--strategy", "random", "--max-views", "1", "--min-gain", "1",
                              "--no-pictures", "--json", "-"} +
                    kCoarse);
    ASSERT_EQ(explored.status, 0) << explored.err;
    const nlohmann::json result = explored.json().at("result");
    EXPECT_EQ(runs[0].run.scan.measures.coverage, result.at("initial").at("coverage").get<double>());
    EXPECT_EQ(runs[0].run.scan.views, result.at("initial").at("views").get<std::size_t>());
    EXPECT_EQ(to_string(runs[0].run.stopped_because), result.at("stopped_because").get<std::string>());
    ASSERT_EQ(runs[0].run.views.size(), 1U);
    ASSERT_EQ(result.at("views").size(), 1U);
    const ViewRecord& view = runs[0].run.views[0];
    const nlohmann::json& told = result.at("views")[0];
    const auto T_world_camera = pose_from_json(told.at("T_world_camera"));
    ASSERT_TRUE(T_world_camera);
    EXPECT_LT((view.T_world_camera.matrix() - T_world_camera->matrix()).norm(), 1e-12);
    EXPECT_EQ(view.measures.unknown_left, told.at("unknown_left").get<std::size_t>());
    EXPECT_EQ(view.reveals_object, told.at("points_at_object").get<bool>());
    EXPECT_EQ(refusals_to_json(view.refused), told.at("refused"));
    EXPECT_EQ(view.motion_s, told.at("motion_s").get<double>());
    if (view.motion_s > 0.0) {
      EXPECT_NEAR(view.path_m, told.at("path_m").get<double>(), 1e-9);
    }
    EXPECT_EQ(view.motion_s > 0.0, std::string{robot} == "comau");
    EXPECT_GT(view.path_m, 0.0);
    const nlohmann::json& final = result.at("final");
    EXPECT_EQ(runs[0].run.final().coverage, final.at("coverage").get<double>());
    EXPECT_EQ(runs[0].run.final().unknown_near_objects, final.at("unknown_near_objects").get<std::size_t>());
    EXPECT_EQ(runs[0].run.final().f_score.value(), final.at("f_score").get<double>());
    EXPECT_EQ(runs[0].run.final().accuracy_m.value(), final.at("accuracy_m").get<double>());
  }
}

TEST(CompareCommand, JobsAndThreadsChangeNoFigure) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  const TempFolder folder;
  const Arguments wanted{"--seeds", "1-2", "--robot", "comau", "--quiet"};
  ASSERT_EQ(run_program(compare(folder / "one", wanted + Arguments{"--jobs", "1", "--threads", "1"})).status, 0);
  ASSERT_EQ(run_program(compare(folder / "four", wanted + Arguments{"--jobs", "4", "--threads", "8"})).status, 0);
  const std::vector<std::string> one = figures_in(folder / "one");
  EXPECT_EQ(one.size(), 4U);
  EXPECT_EQ(one, figures_in(folder / "four"));
}

TEST(CompareCommand, AKilledComparisonGoesOnWhereItStopped) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  const TempFolder folder;
  const Arguments wanted{"--seeds", "1-6", "--jobs", "3"};
  {
    RunningProgram program{compare(folder / "killed", wanted)};
    ASSERT_TRUE(program.wait_for("sphere, seed 4"));
    program.send(SIGKILL);
    EXPECT_EQ(program.finish().status, -1);
  }
  const std::size_t before = runs_in(folder / "killed").size();
  EXPECT_GE(before, 3U);  // no more were at work than jobs
  EXPECT_LT(before, 12U);
  const Outcome again = run_program(compare(folder / "killed", wanted));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find(std::to_string(12 - before) + " done now, " + std::to_string(before) + " found"),
            std::string::npos)
      << again.out;
  ASSERT_EQ(run_program(compare(folder / "whole", wanted + Arguments{"--quiet"})).status, 0);
  EXPECT_EQ(figures_in(folder / "killed"), figures_in(folder / "whole"));
}

TEST(CompareCommand, RandomGetsAsManyViewsAsSphereTook) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  const TempFolder folder;
  const fs::path out = folder / "out";
  // Nothing gains that much: sphere takes no view.
  const Arguments choosy{"--seeds", "1", "--min-gain", "1e9", "--quiet", "--no-noise"};
  ASSERT_EQ(run_program(compare(out, choosy + Arguments{"--equal-views"})).status, 0);
  std::vector<CampaignEntry> runs = runs_in(out);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].key.strategy, "sphere");
  EXPECT_TRUE(runs[0].run.views.empty() && runs[1].run.views.empty());
  ASSERT_EQ(run_program(compare(out, choosy)).status, 0);
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
  refused({"--scenes", "jug", "--strategies", "random", "--equal-views"}, 2, {"--equal-views", "needs sphere"});
  for (const char* range : {"clutter:3-1", "clutter:1-", "clutter:1-x", "clutter:0-100000"})
    refused({"--scenes", range}, 2, {"--scenes", "clutter:1-30"});
  refused({"--scenes", "clutter:x"}, 3, {"a seed is a whole number"});
  refused({"--scenes", "jug", "--noise", "some"}, 2, {"--noise", "kinect-v2"});
  refused({"--scenes", "jug", "--noise", "none", "--no-noise"}, 2, {"--noise"});
  refused({"--scenes", "jug", "--jobs", "0"}, 2, {"--jobs"});
  refused({"--scenes", "jug", "--rivals", "0"}, 2, {"--rivals", "at most 1"});
  refused({"--scenes", "jug", "--robot", "hal"}, 3, {"hal"});
  refused({"--scenes", "jug", "--mesh-scale", "0"}, 2, {"--mesh-scale"});
  for (const char* seeds : {"", "x", "3-1", "1-", "-1", "1,,2", "9223372036854775808", "0-9223372036854775807"})
    refused({"--scenes", "jug", "--seeds", seeds}, 2, {"--seeds"});
  refused({"--scenes", "jug", "--voxel-size", "0"}, 2, {"--voxel-size"});

  const Outcome ranges = run_program({"compare", "--out", out.string(), "--scenes", "clutter:1-30,clutter:7", "--seeds",
                                      "1", "--noise", "none,kinect-v2", "--list"});
  EXPECT_NE(ranges.out.find("180 runs, 0 of them done"), std::string::npos) << ranges.out << ranges.err;
  for (const char* part : {"kinect-v2", "surface", "attention", "standard"})
    EXPECT_NE(ranges.out.find(part), std::string::npos) << part;
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

/// A box of these sizes in an OBJ file.
std::string box_obj(double x, double y, double z) {
  std::string text;
  for (const double height : {0.0, z}) {
    for (const double across : {0.0, y}) {
      for (const double along : {0.0, x}) {
        text += "v " + std::to_string(along) + ' ' + std::to_string(across) + ' ' + std::to_string(height) + '\n';
      }
    }
  }
  for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"})
    text += std::string{"f "} + face + '\n';
  return text;
}

TEST(CompareCommand, EveryMeshOfAFolderIsAScene) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  const TempFolder folder;
  folder.write("meshes/box.obj", box_obj(120, 80, 150));
  folder.write("meshes/flat.OBJ", box_obj(200, 200, 30));
  folder.write("meshes/notes.txt", "not a mesh");
  const std::string meshes = (folder / "meshes").string();
  expect_failure(run_program(once(folder / "out", meshes)), 3, "compare",
                 {"box.obj", "120 x 80 x 150 m", "0.001 (millimetres)", "--mesh-scale"});
  const Outcome done =
      run_program(once(folder / "out", meshes, {"--mesh-scale", "0.001", "--robot", "comau", "--json", "-"}));
  ASSERT_EQ(done.status, 0) << done.err;
  const nlohmann::json result = done.json();
  const nlohmann::json& summaries = result.at("result").at("summaries");
  ASSERT_EQ(summaries.size(), 3U);
  EXPECT_EQ(summaries[0].at("scene"), "box.obj");
  EXPECT_EQ(summaries[1].at("scene"), "flat.OBJ");
  EXPECT_TRUE(summaries[2].at("scene").is_null());  // both
  EXPECT_GT(summaries[0].at("coverage").at("mean").get<double>(), 0.5);
  const Outcome one =
      run_program(once(folder / "out", meshes + "/box.obj", {"--mesh-scale", "0.001", "--robot", "comau", "--list"}));
  EXPECT_NE(one.out.find("1 runs, 1 of them done"), std::string::npos) << one.out << one.err;
}

TEST(CompareCommand, ASceneThatFailsDoesNotStopTheOthers) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  const TempFolder folder;
  const fs::path out = folder / "out";
  for (const char* name : {"away", "far"}) {  // seen from nowhere
    folder.write(std::string{name} + ".yaml",
                 std::string{"scene: "} + name +
                     "\nworkspace: {min: [-0.5, -0.5, 0], max: [0.5, 0.5, 0.4]}\nobjects:\n"
                     "  - {name: ball, sphere: {radius: 0.05}, at: [3, 0, 0]}\n");
  }
  const std::string scenes =
      (folder / "away.yaml").string() + ',' + tiny_cell_file() + ',' + (folder / "far.yaml").string();
  expect_failure(run_program(once(out, scenes, {"--jobs", "1"})), 3, "compare",
                 {"away", "no surface of an object can be seen", "1 more failed", "1 run was done and kept"});
  ASSERT_EQ(runs_in(out).size(), 1U);

  // Its run counts as done where another version made it, and that is said.
  {
    const SqliteFile database = SqliteFile::open(out / "campaign.sqlite", 1000).value();
    ASSERT_TRUE(database.run("UPDATE runs SET program_version = '0.0.9'"));
  }
  const Outcome found = run_program(once(out, tiny_cell_file(), {"--json", (folder / "result.json").string()}));
  ASSERT_EQ(found.status, 0) << found.err;
  EXPECT_NE(found.out.find("1 run by 0.0.9: versions may differ"), std::string::npos) << found.out;
  EXPECT_EQ(read_json(folder / "result.json")->at("result").at("versions").dump(), R"({"0.0.9":1})");
}

TEST(CompareCommand, ScenesInWhichThereIsNothing) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  fs::create_directory(folder / "empty");
  expect_failure(run_program(once(out, (folder / "empty").string())), 3, "compare", {"holds no mesh"});
  folder.write("broken/cup.stl", "solid? no");
  expect_failure(run_program(once(out, (folder / "broken").string())), 3, "compare", {"cup.stl"});
  folder.write("table.yaml",
               "scene: table\nworkspace: {min: [-0.5, -0.5, 0], max: [0.5, 0.5, 0.4]}\nobjects:\n"
               "  - {name: table, box: {size: [1, 1, 0.04]}, at: [0, 0, -0.04], support: true}\n");
  expect_failure(run_program(once(out, (folder / "table.yaml").string())), 3, "compare", {"no object in the scene"});
  folder.write("away.yaml",
               "scene: away\nworkspace: {min: [-0.5, -0.5, 0], max: [0.5, 0.5, 0.4]}\nobjects:\n"
               "  - {name: ball, sphere: {radius: 0.05}, at: [3, 0, 0]}\n");
  expect_failure(run_program(once(out, (folder / "away.yaml").string())), 3, "compare",
                 {"away", "no surface of an object can be seen"});
}

TEST(CompareCommand, AFullDiskIsSaidBeforeTheWork) {
  const TempFolder folder;
  const Outcome full = run_program(once(folder / "out", "clutter:5"), 100000);
  EXPECT_NE(full.status, 0);
  EXPECT_EQ(std::count(full.err.begin(), full.err.end(), '\n'), 1) << full.err;
}

TEST(CompareCommand, ThereIsNoViewWhereEverythingIsKnownOrNothingCanBeReached) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; GoesOnWhereItStopped makes two";
  const TempFolder folder;
  // Nothing gains so much: to the strategy, everything is known.
  const Outcome known = run_program(once(folder / "known", "clutter:5", {"--min-gain", "1e9", "--json", "-"}));
  ASSERT_EQ(known.status, 0) << known.err;
  nlohmann::json row = known.json().at("result").at("summaries").at(0);
  EXPECT_EQ(row.at("stopped_because"), (nlohmann::json{{"regions_done", 1}}));
  EXPECT_EQ(row.at("views").at("mean"), 0.0);
  // Farther from the table than the arm is long.
  const Outcome far = run_program(
      once(folder / "far", "clutter:5", {"--robot", "comau", "--radius", "9", "--max-range", "12", "--json", "-"}));
  ASSERT_EQ(far.status, 0) << far.err;
  row = far.json().at("result").at("summaries").at(0);
  EXPECT_EQ(row.at("stopped_because"), (nlohmann::json{{"no_candidate", 1}}));
  EXPECT_GT(runs_in(folder / "far").at(0).run.refused_at_end.total(), 0U);
}

}  // namespace
}  // namespace saccade::test
