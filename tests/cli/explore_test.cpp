// SPDX-License-Identifier: Apache-2.0
// saccade explore, on small images and large voxels.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "report_page.hpp"
#include "run_program.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

Arguments explore_scene(const std::string& scene, const fs::path& out, const Arguments& more) {
  return Arguments{"explore", scene, "--out", out.string(), "--quiet"} + more;
}

Arguments explore(const fs::path& out, const Arguments& more) {
  return explore_scene(tiny_cell_file(), out, Arguments{"--image-size", "96,72", "--voxel-size", "0.015"} + more);
}

// Pictures take half of the time, and more under sanitizers.
const Arguments kFewerPictures = kSanitized ? Arguments{"--no-pictures"} : Arguments{};

TEST(ExploreCommand, TakesAKinectV2) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; GoesFromViewToView runs one";
  const TempFolder folder;
  const Arguments some{"--robot", "free", "--max-views", "1", "--json", "-"};
  const Outcome v2 = run_program(explore(folder / "v2", Arguments{"--sensor", "kinect-v2"} + some));
  ASSERT_EQ(v2.status, 0) << v2.err;
  EXPECT_EQ(v2.json().at("result").at("sensor"), "kinect-v2");
  const Outcome v1 = run_program(explore(folder / "v1", Arguments{"--no-pictures"} + some));
  ASSERT_EQ(v1.status, 0) << v1.err;
  EXPECT_EQ(v1.json().at("result").at("sensor"), "kinect-v1");
  EXPECT_NE(v1.json().at("result").at("initial"), v2.json().at("result").at("initial"));
  EXPECT_EQ(report_in(folder / "v2" / "report.html").at("record").at("result").at("sensor"), "kinect-v2");
  expect_failure(run_program(explore(folder / "v3", {"--sensor", "kinect-v3"})), 2, "explore",
                 {"--sensor", "kinect-v1 or kinect-v2"});
}

TEST(ExploreCommand, GoesFromViewToView) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  const Outcome outcome =
      run_program(explore_scene("clutter:5", run,
                                {"--image-size", "128,96", "--voxel-size", "0.02", "--max-views", "2", "--min-gain",
                                 "5", "--strategy", "attention", "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("stopped_because"), "views_used_up");
  ASSERT_EQ(result.at("views").size(), 2U);
  auto unknown = result.at("initial").at("unknown_left").get<std::size_t>();
  for (std::size_t i = 0; i < 2; ++i) {
    const nlohmann::json& view = result.at("views")[i];
    EXPECT_EQ(view.at("index"), i);
    EXPECT_LT(view.at("unknown_left").get<std::size_t>(), unknown);
    unknown = view.at("unknown_left").get<std::size_t>();
    EXPECT_GE(view.at("gain").get<double>(), 5.0);
    EXPECT_GT(view.at("gain_observed").get<double>(), 0.0);
    EXPECT_LE(view.at("gain_observed").get<double>(), view.at("gain").get<double>() + 1e-6);
    EXPECT_TRUE(pose_from_json(view.at("T_world_camera")));
    EXPECT_TRUE(view.at("points_at_object").is_boolean());
    for (const char* phase : {"planner_map", "candidates", "segmentation", "saliency", "reachability", "evaluation",
                              "planning", "motion", "fusion"}) {
      EXPECT_GE(view.at("ms").at(phase).get<double>(), 0.0);
    }
    // 40 views of every contour point; the robot is asked about those of the segments that are looked at.
    const auto candidates = view.at("candidates").get<std::size_t>();
    EXPECT_EQ(candidates % 40, 0U);
    const nlohmann::json& attention = view.at("attention");
    EXPECT_EQ(candidates, 40 * attention.at("contours").get<std::size_t>());
    EXPECT_LE(attention.at("contours_of_segment").get<std::size_t>(), attention.at("contours").get<std::size_t>());
    EXPECT_GT(attention.at("contours_of_segment").get<std::size_t>(), 0U);
    EXPECT_LT(attention.at("segment").get<std::size_t>(), attention.at("segments").get<std::size_t>());
    EXPECT_GT(attention.at("saliency").get<double>(), 0.0);
    EXPECT_GT(view.at("evaluated").get<std::size_t>(), 0U);
    EXPECT_TRUE(view.at("looks_at_object").is_boolean());
    EXPECT_GT(view.at("refused").at("no_ik").get<int>(), 0);
    EXPECT_EQ(view.at("q").size(), 6U);
    EXPECT_GT(view.at("motion_s").get<double>(), 0.0);
    EXPECT_GT(view.at("path_m").get<double>(), 0.0);
    EXPECT_EQ(view.at("frames"), 5);
    ASSERT_EQ(view.at("tilt_rad").size(), 2U);
    EXPECT_LE(view.at("tilt_rad")[0].get<double>(), 0.0);
    EXPECT_GE(view.at("tilt_rad")[1].get<double>(), 0.0);
    EXPECT_EQ(view.at("retreat_s"), 0.0);
  }
  EXPECT_EQ(result.at("robot"), "comau");
  EXPECT_GT(result.at("phases_s").at("robot").get<double>(), 0.0);
  EXPECT_EQ(result.at("initial").at("views"), 1);
  EXPECT_EQ(result.at("initial").at("refused"), (nlohmann::json{{"outside_limits", 1}}));
  const nlohmann::json page = report_in(run / "report.html");
  EXPECT_EQ(page.at("schema"), "saccade-report/1");
  EXPECT_EQ(page.at("record"), nlohmann::json::parse(text_of(run / "run.json")));
  for (const char* name : {"view-00-map.png", "view-02-seen.png", "mesh.ply", "run.json"}) {
    const nlohmann::json& files = page.at("files");
    EXPECT_NE(std::find(files.begin(), files.end(), name), files.end()) << name;
  }
  const nlohmann::json& final = result.at("final");
  EXPECT_EQ(final.at("unknown_left"), unknown);
  EXPECT_GT(final.at("coverage").get<double>(), result.at("initial").at("coverage").get<double>());
  EXPECT_GT(final.at("f_score").get<double>(), 0.0);
  EXPECT_GT(final.at("chamfer_m").get<double>(), 0.0);
  EXPECT_TRUE(load_map(run / "map.sacmap"));
  EXPECT_TRUE(read_mesh(run / "mesh.ply"));
  const nlohmann::json states = nlohmann::json::parse(text_of(run / "ternary.json"));
  EXPECT_EQ(states.at("shape"), (nlohmann::json{22, 40, 60}));  // the workspace
  EXPECT_EQ(result.at("voxel_size_m"), states.at("voxel_size_m"));
  EXPECT_EQ(result.at("truth_spacing_m"), 0.004);
  for (const char* picture : {"view-00-map.png", "view-01-map.png", "view-01-choice.png", "view-01-saliency.png",
                              "view-02-seen.png", "run.json", "report.html"})
    EXPECT_TRUE(fs::exists(run / picture));
}

TEST(ExploreCommand, EveryStrategyTakesAView) {
  if (kSanitized) GTEST_SKIP() << "every strategy has its own tests";
  const TempFolder folder;
  for (const std::string strategy :
       {"surface", "attention", "standard", "sphere", "random", "random-contours", "proximity-count", "oracle"}) {
    const Outcome outcome =
        run_program(explore(folder / strategy, {"--strategy", strategy, "--max-views", "1", "--no-pictures",
                                                "--min-gain", "5", "--json", "-"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json result = outcome.json().at("result");
    EXPECT_EQ(result.at("strategy"), strategy);
    ASSERT_EQ(result.at("views").size(), 1U) << strategy;
    EXPECT_EQ(result.at("views")[0].at("attention").is_null(), strategy != "attention");
    EXPECT_GT(result.at("views")[0].at("evaluated").get<std::size_t>(), 0U);
  }
  expect_failure(run_program(explore(folder / "x", {"--strategy", "saliency"})), 2, "explore",
                 {"--strategy", "surface, attention, standard"});
  expect_failure(run_program(explore(folder / "x", {"--strategy", "oracle", "--camera-command", "true"})), 2, "explore",
                 {"--strategy", "true scene"});
}

TEST(ExploreCommand, SaliencyDecidesWhatIsLookedAtFirst) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; GoesFromViewToView runs one";
  const TempFolder folder;
  const auto first_segment = [&](const char* name, const char* saliency) {
    const Outcome outcome =
        run_program(explore(folder / name, {"--strategy", "attention", "--saliency", saliency, "--max-views", "1",
                                            "--no-pictures", "--min-gain", "5", "--json", "-"}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result").at("views").at(0).at("attention").at("segment");
  };
  EXPECT_NE(first_segment("a", "objectness"), first_segment("b", "rough-first"));
  expect_failure(run_program(explore(folder / "c", {"--saliency", "beauty"})), 2, "explore", {"--saliency", "beauty"});
}

TEST(ExploreCommand, AShorterRunLeavesNoPicturesOfALongerOne) {
  if (kSanitized) GTEST_SKIP() << "two explorations take long under sanitizers; GoesFromViewToView runs one";
  const TempFolder folder;
  const fs::path run = folder / "run";
  ASSERT_EQ(run_program(explore(run, {"--max-views", "1", "--min-gain", "5"})).status, 0);
  EXPECT_TRUE(fs::exists(run / "view-01-map.png"));
  ASSERT_EQ(run_program(explore(run, {"--max-views", "0"})).status, 0);
  EXPECT_TRUE(fs::exists(run / "view-00-map.png"));
  EXPECT_FALSE(fs::exists(run / "view-01-map.png"));
}

TEST(ExploreCommand, TheSeedDecidesAndTheThreadsDoNot) {
  if (kSanitized) GTEST_SKIP() << "three explorations take long under sanitizers; GoesFromViewToView runs one";
  const TempFolder folder;
  const auto views = [&](const char* name, const char* seed, const char* threads) {
    const Outcome outcome =
        run_program(explore(folder / name, {"--max-views", "1", "--strategy", "random", "--no-pictures", "--json", "-",
                                            "--seed", seed, "--threads", threads}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    nlohmann::json result = outcome.json().at("result");
    result.at("views")[0].erase("ms");
    return result.at("views").dump() + result.at("final").dump();
  };
  const std::string first = views("a", "3", "1");
  EXPECT_EQ(first, views("b", "3", "3"));
  EXPECT_NE(first, views("c", "4", "1"));
}

/// Returns the results of a run without its times.
nlohmann::json figures(const fs::path& run) {
  nlohmann::json result = nlohmann::json::parse(text_of(run / "run.json")).at("result");
  result.erase("out");
  result.erase("phases_s");
  for (nlohmann::json& view : result.at("views")) view.erase("ms");
  return result;
}

TEST(ExploreCommand, AKilledRunGoesOnAndEndsAsOneThatWasNotKilled) {
  if (kSanitized) GTEST_SKIP() << "two explorations take long under sanitizers; GoesFromViewToView runs one";
  const TempFolder folder;
  const Arguments options = kFewerPictures + Arguments{"--max-views", kSanitized ? "2" : "3", "--min-gain", "5"};
  ASSERT_EQ(run_program(explore(folder / "whole", options)).status, 0);

  const fs::path killed = folder / "killed";
  {
    RunningProgram program{explore(killed, options)};
    ASSERT_TRUE(wait_for_file(killed / "checkpoint-1.sacmap"));
    program.send(SIGKILL);
    EXPECT_EQ(program.finish().status, -1);
  }
  ASSERT_TRUE(fs::exists(killed / "journal.json"));
  std::ofstream{killed / ".mesh.ply.12345-0.tmp"} << "half";  // as when it is killed while it writes
  EXPECT_FALSE(fs::exists(killed / "run.json"));
  expect_failure(run_program(explore(killed, options)), 3, "explore", {"interrupted run", "--resume", "--force"});
  expect_failure(run_program(explore(killed, options + Arguments{"--resume", "--seed", "7"})), 3, "explore",
                 {"seed 1, not 7"});
  expect_failure(run_program(explore(killed, options + Arguments{"--resume", "--sensor", "kinect-v2"})), 3, "explore",
                 {R"(sensor "kinect-v1", not "kinect-v2")"});
  const Outcome resumed = run_program(explore(killed, options + Arguments{"--resume"}));
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(figures(killed), figures(folder / "whole"));
  EXPECT_EQ(text_of(killed / "map.sacmap"), text_of(folder / "whole" / "map.sacmap"));
  EXPECT_EQ(names_in(killed), names_in(folder / "whole"));  // no journal and no checkpoint are left
  expect_failure(run_program(explore(killed, options + Arguments{"--resume"})), 3, "explore", {"no interrupted run"});
}

TEST(ExploreCommand, CtrlCKeepsWhatWasSeen) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  RunningProgram program{explore(run, kFewerPictures + Arguments{"--max-views", "50", "--min-gain", "1"})};
  ASSERT_TRUE(wait_for_file(run / "checkpoint-1.sacmap"));
  expect_failure(run_program(explore(run, {"--force"})), 3, "explore", {"another run"});
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_NE(outcome.err.find("--resume"), std::string::npos) << outcome.err;
  const nlohmann::json result = figures(run);
  EXPECT_EQ(result.at("interrupted"), true);
  EXPECT_EQ(result.at("stopped_because"), "cancelled");
  EXPECT_GE(result.at("views").size(), 1U);
  EXPECT_TRUE(load_map(run / "map.sacmap"));
}

TEST(ExploreCommand, ADamagedJournalIsAnErrorAndNotACrash) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  const Arguments options{"--robot", "free", "--max-views", "2", "--min-gain", "5", "--no-pictures"};
  ASSERT_EQ(run_program(explore(run, options + Arguments{"--step"}), 0, "y\ny\ny\nq\n").status, 0);
  const std::string good = text_of(run / "journal.json");
  const auto resumed_with = [&](const std::string& journal) {
    std::ofstream{run / "journal.json"} << journal;
    return run_program(explore(run, options + Arguments{"--resume"}));
  };
  expect_failure(resumed_with(good.substr(0, good.size() / 2)), 3, "explore", {"JSON"});
  expect_failure(resumed_with("{}"), 3, "explore", {"damaged", "--force"});
  nlohmann::json odd = nlohmann::json::parse(good);
  odd["views"] = {{{"region", "x"}}};
  expect_failure(resumed_with(odd.dump()), 3, "explore", {"damaged"});
  odd = nlohmann::json::parse(good);
  odd["map"] = "../checkpoint-1.sacmap";
  expect_failure(resumed_with(odd.dump()), 3, "explore", {"damaged", "--force"});
  odd = nlohmann::json::parse(good);
  odd["initial"] = nlohmann::json::object();
  expect_failure(resumed_with(odd.dump()), 3, "explore", {"damaged", "--force"});
  fs::rename(run / "checkpoint-1.sacmap", folder / "elsewhere");
  expect_failure(resumed_with(good), 3, "explore", {"checkpoint-1"});
  fs::rename(folder / "elsewhere", run / "checkpoint-1.sacmap");
  EXPECT_EQ(resumed_with(good).status, 0);
}

TEST(ExploreCommand, GoesOnWithTheSameSensorOnly) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  const Arguments options{"--robot", "free", "--max-views", "2", "--min-gain", "5", "--no-pictures"};
  const Arguments stepping{"--sensor", "kinect-v2", "--step"};
  ASSERT_EQ(run_program(explore(run, options + stepping), 0, "y\ny\ny\nq\n").status, 0);
  expect_failure(run_program(explore(run, options + Arguments{"--resume"})), 3, "explore",
                 {R"(sensor "kinect-v2", not "kinect-v1")"});
}

TEST(ExploreCommand, StepAsksBeforeEachMove) {
  const TempFolder folder;
  const Arguments options{"--robot", "free",          "--max-views", "2",      "--min-gain",
                          "5",       "--no-pictures", "--step",      "--json", "-"};
  // The scan has two poses; of the views, one is skipped, one taken, and then the user leaves.
  const Outcome outcome = run_program(explore(folder / "run", options), 0, "y\ny\nwhat?\ns\ny\nq\n");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("views").size(), 1U);
  EXPECT_EQ(result.at("stopped_because"), "cancelled");
  std::size_t questions = 0;
  for (std::size_t at = outcome.err.find("[y]es"); at != std::string::npos; at = outcome.err.find("[y]es", at + 1)) {
    ++questions;
  }
  EXPECT_EQ(questions, 6U) << outcome.err;
  // Without anyone to answer, nothing moves.
  const Outcome silent = run_program(explore(folder / "silent", options), 0, "");
  EXPECT_EQ(silent.json().at("result").at("views").size(), 0U);
}

TEST(ExploreCommand, ScannedObjectsAreExplored) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; GoesFromViewToView runs one";
  const fs::path meshes = fs::absolute(shared_data() / "meshes_ycb");
  if (!fs::exists(meshes)) GTEST_SKIP() << meshes << " is not there";
  const auto object = [&](const std::string& name, const std::string& file, const std::string& at) {
    return "  - {name: " + name + ", mesh: {path: \"" + (meshes / file).string() + "\"}, at: " + at + "}\n";
  };
  const TempFolder folder;
  const fs::path scene =
      folder.write("scans.yaml",
                   "scene: scans\n"
                   "workspace: {min: [-0.35, -0.35, -0.03], max: [0.35, 0.35, 0.3]}\n"
                   "scan: [{from: [-0.9, 0, 0.3], look_at: [0, 0, 0.08]}]\n"
                   "objects:\n"
                   "  - {name: table, box: {size: [1, 1, 0.04]}, at: [0, 0, -0.04], support: true}\n" +
                       object("sugar", "004_sugar_box.stl", "[-0.12, 0.12, 0]") +
                       object("mug", "025_mug.stl", "[-0.05, -0.12, 0.001]") +
                       object("mustard", "006_mustard_bottle.stl", "[0.15, 0.05, 0.003]"));
  const Outcome outcome = run_program({"explore", scene.string(), "--out", (folder / "run").string(), "--image-size",
                                       "160,120", "--voxel-size", "0.015", "--max-views", "12", "--min-gain", "5",
                                       "--no-pictures", "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_LE(result.at("initial").at("coverage").get<double>(), 0.75);
  EXPECT_GE(result.at("final").at("coverage").get<double>(), 0.9);
  EXPECT_LE(result.at("views").size(), 12U);
  EXPECT_GE(result.at("views").size(), 1U);
}

TEST(ExploreCommand, RefusesWhatItCannotDo) {
  const TempFolder folder;
  const auto refused = [](const Arguments& arguments, int status, const std::string& part) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  };
  const fs::path out = folder / "out";
  refused({"explore", "atrium", "--out", out.string()}, 3, "no such scene");
  refused(explore(out, {"--robot", "walking"}), 3, "no such robot");
  refused(explore(out, {"--planner", "teleport"}), 2, "--planner");
  refused(explore(out, {"--obstacle-cell", "0"}), 2, "--obstacle-cell");
  refused(explore(out, {"--fixture", "0,0,0,1,1"}), 2, "--fixture");
  refused(explore(out, {"--free", "0,0,0,1,1,-1"}), 2, "--free");
  refused(explore(out, {"--good-enough", "1.5"}), 2, "good enough");
  refused(explore(out, {"--strategy", "best"}), 2, "--strategy");
  refused(explore(out, {"--voxel-size", "-1"}), 2, "--voxel-size");
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace saccade::test
