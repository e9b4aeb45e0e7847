// SPDX-License-Identifier: Apache-2.0
// saccade update as a user runs it: both experiments of the thesis, held to what they are held to, and what can go
// wrong.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>

#include "cli/report_page.hpp"
#include "cli/run_program.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

using nlohmann::json;

/// As little as can be seen with.
const Arguments kSmallest{"--image-size", "80,60", "--voxel-size", "0.02"};

/// Small images where programs are slow, unless the test says how large they are.
Arguments update(const fs::path& out, const Arguments& more) {
  Arguments arguments{"update", "--quiet", "--out", out.string(), "--json", "-"};
  const auto named = [&more](const char* option) { return std::find(more.begin(), more.end(), option) != more.end(); };
  if (kSanitized && !named("--image-size")) arguments = arguments + Arguments{"--image-size", "160,120"};
  if (kSanitized && !named("--voxel-size")) arguments = arguments + Arguments{"--voxel-size", "0.01"};
  if (kSanitized && !named("--no-pictures")) arguments = arguments + Arguments{"--no-pictures"};
  return arguments + more;
}

json result_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  json document = outcome.json();
  expect_envelope(document, "update");
  return document.at("result");
}

/// Checks that every update must pass.
void expect_complete(const json& result) {
  for (const json& region : result.at("regions")) {
    EXPECT_EQ(region.at("end"), "done");
    EXPECT_LT(region.at("gain_left").get<double>(), 50.0);
    const json& unknown = region.at("unknown");
    ASSERT_EQ(unknown.size(), 1 + result.at("views").size());
    EXPECT_LT(unknown.back().get<double>(), 0.2 * unknown.front().get<double>());
    EXPECT_GE(region.at("coverage").at("surfaces").get<double>(), kSanitized ? 0.5 : 0.9);
  }
  ASSERT_EQ(result.at("objects").size(), 1U);
  for (const auto& [parameter, error_m] : result.at("objects").at(0).at("error").items()) {
    EXPECT_LE(std::abs(error_m.get<double>()), kSanitized ? 0.02 : 0.008) << parameter;
  }
  EXPECT_EQ(result.at("contacts").at("touching"), 0);
  EXPECT_GT(result.at("contacts").at("instants").get<int>(), 100);
  EXPECT_TRUE(result.at("back").at("at_stand_by").get<bool>());
  EXPECT_EQ(result.at("stopped_because"), "regions_done");
}

double distance(const json& a, const json& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) sum += std::pow(a.at(i).get<double>() - b.at(i).get<double>(), 2);
  return std::sqrt(sum);
}

TEST(UpdateCommand, LooksAgainWhereABottleWasPutDown) {
  const TempFolder folder;
  const json result = result_of(run_program(update(folder / "run", {"--scene", "bottle"})));
  EXPECT_EQ(result.at("scene"), "bottle");
  EXPECT_EQ(result.at("before"), "bottle-before");
  ASSERT_EQ(result.at("regions").size(), 1U);
  EXPECT_EQ(result.at("objects").at(0).at("name"), "bottle");
  expect_complete(result);
  const json& task = result.at("task");
  ASSERT_EQ(task.at("actions").size(), 1U);
  EXPECT_LT(distance(task.at("actions").at(0).at("position_m"), task.at("true_places_m").at(0)), 0.05);
  EXPECT_EQ(result.at("regions").at(0).at("center_m"), task.at("actions").at(0).at("position_m"));
  std::vector<std::string> expected{"before.sacmap", "hand.csv", "map.sacmap", "mesh.ply", "update.json"};
  if (!kSanitized) {
    expected.insert(expected.end(), {"after.png", "before.png", "hand.png", "regions.png", "report.html",
                                     "view-01-choice.png", "view-01-map.png", "view-01-seen.png"});
  }
  for (const std::string& name : expected) EXPECT_TRUE(fs::exists(folder / "run" / name)) << name;
  if (!kSanitized) {
    const json page = report_in(folder / "run/report.html");
    EXPECT_EQ(page.at("record").at("result"), result);
    EXPECT_GT(page.at("details").at("speed").at("speed_m_s").size(), 1U);
  }

  // Equal results with this hand from a file, and with other threads.
  if (kSanitized) return;
  Arguments again = update(folder / "again", {"--scene", "bottle", "--no-pictures", "--threads", "1"});
  const json same = result_of(run_program(again + Arguments{"--trajectory", (folder / "run/hand.csv").string()}));
  EXPECT_EQ(same.at("regions"), result.at("regions"));
  EXPECT_EQ(same.at("objects"), result.at("objects"));
  EXPECT_TRUE(same.at("task").at("true_places_m").empty());
}

TEST(UpdateCommand, LooksAgainWhereAJugWasTakenAndPutDown) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update is enough under sanitizers";
  const TempFolder folder;
  const json result = result_of(run_program(update(folder / "run", {"--scene", "jug", "--no-pictures"})));
  EXPECT_EQ(result.at("regions").size(), 2U);
  EXPECT_EQ(result.at("objects").at(0).at("name"), "jug");
  expect_complete(result);
  EXPECT_FALSE(fs::exists(folder / "run/before.png"));
}

TEST(UpdateCommand, FusesOnItsWayWhenItIsTold) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update is enough under sanitizers";
  const TempFolder folder;
  Arguments few{"--scene", "jug", "--no-pictures"};
  if (!kSanitized) few = few + Arguments{"--image-size", "160,120"};
  if (kSanitized) few = few + kSmallest + Arguments{"--max-views", "1"};
  const json at_views = result_of(run_program(update(folder / "a", few)));
  const json on_way = result_of(run_program(update(folder / "b", few + Arguments{"--fuse-when", "motion"})));
  EXPECT_EQ(on_way.at("fuse_when"), "motion");
  for (const json& view : on_way.at("views")) EXPECT_GT(view.at("frames_on_way").get<int>(), 0);
  for (const json& view : at_views.at("views")) EXPECT_EQ(view.at("frames_on_way"), 0);
  EXPECT_LE(on_way.at("views").size(), at_views.at("views").size());
  EXPECT_GT(on_way.at("phases_s").at("robot").get<double>(), at_views.at("phases_s").at("robot").get<double>());
}

TEST(UpdateCommand, IsAsPrintedWhenItIsTold) {
  const TempFolder folder;
  const Arguments few = Arguments{"--scene", "bottle", "--no-pictures", "--as-printed", "--max-views", "1"} + kSmallest;
  const auto evaluated = [](const json& result) { return result.at("views").at(0).at("evaluated").get<int>(); };
  const json printed = result_of(run_program(update(folder / "a", few)));
  EXPECT_EQ(printed.at("as_printed"), true);
  EXPECT_EQ(printed.at("task").at("method"), "gmm-as");
  EXPECT_EQ(printed.at("gain_width_px"), 80) << "every pixel of the camera";
  EXPECT_EQ(printed.at("min_gain"), 12.5) << "as large a share of the rays as 50 of 160 x 120";
  EXPECT_EQ(evaluated(printed), 960) << "whatever the arm can take";
  const Arguments named{"--method", "ours", "--gain-width", "40", "--min-gain", "9"};
  const json chosen = result_of(run_program(update(folder / "b", few + named)));
  EXPECT_EQ(chosen.at("task").at("method"), "ours");
  EXPECT_EQ(chosen.at("gain_width_px"), 40);
  EXPECT_EQ(chosen.at("min_gain"), 9.0);
  EXPECT_EQ(evaluated(chosen), 960);
  Arguments ours = few;
  std::erase(ours, "--as-printed");
  const json usual = result_of(run_program(update(folder / "c", ours)));
  EXPECT_EQ(usual.at("as_printed"), false);
  EXPECT_EQ(usual.at("task").at("method"), "ours");
  EXPECT_EQ(usual.at("min_gain"), 50.0);
  EXPECT_LT(evaluated(usual), 960);
  EXPECT_NE(usual.at("views").at(0).at("gain"), printed.at("views").at(0).at("gain"));
}

void write_hand(const fs::path& path, const Eigen::Vector3d& place, int samples_there) {
  std::ofstream file{path};
  file << "time,x,y,z\n";
  const Eigen::Vector3d outside{0.0, -0.8, 0.4};
  double time_s = 0.0;
  const auto add = [&](const Eigen::Vector3d& p) {
    file << time_s << ',' << p.x() << ',' << p.y() << ',' << p.z() << '\n';
    time_s += 0.01;
  };
  for (int i = 0; i < 100; ++i) add(outside + std::pow(std::sin(0.5 * M_PI * i / 100.0), 2) * (place - outside));
  for (int i = 0; i < samples_there; ++i) add(place + Eigen::Vector3d{0.005 * std::sin(0.2 * i), 0, 0});
  for (int i = 0; i < 100; ++i) add(place + std::pow(std::sin(0.5 * M_PI * i / 100.0), 2) * (outside - place));
}

TEST(UpdateCommand, EndsClearlyWhereThereIsNothingToUpdate) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update and an interrupted one are enough under sanitizers";
  const TempFolder folder;
  std::ofstream{folder / "empty.csv"} << "";
  std::ofstream straight{folder / "straight.csv"};
  straight << "time,x,y,z\n";
  for (int i = 0; i < 200; ++i) straight << 0.01 * i << ',' << -1.0 + 0.01 * i << ",0,0.3\n";
  straight.close();
  write_hand(folder / "far.csv", {3.0, 2.0, 0.1}, 30);
  const auto run = [&](const std::string& file, const char* says) {
    const Arguments small = kSmallest + Arguments{"--no-pictures", "--scene", "bottle"};
    const Outcome outcome =
        run_program(update(folder / ("out-" + file), small + Arguments{"--trajectory", (folder / file).string()}));
    EXPECT_EQ(outcome.status, 5) << outcome.err;
    EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
    EXPECT_TRUE(outcome.json().at("result").at("views").empty());
  };
  run("far.csv", "outside the workspace");
  if (kSanitized) return;  // each run begins with a scan
  run("empty.csv", "the trajectory is empty");
  run("straight.csv", "did not act anywhere");
}

TEST(UpdateCommand, APlaceOutsideTheWorkspaceIsNotCalledDone) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update and an interrupted one are enough under sanitizers";
  const TempFolder folder;
  write_hand(folder / "far.csv", {0.0, 0.6, 0.75}, 30);  // over the table's far edge, where view poses are within reach
  const Outcome outcome =
      run_program(update(folder / "run", kSmallest + Arguments{"--no-pictures", "--scene", "bottle", "--trajectory",
                                                               (folder / "far.csv").string()}));
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  const json result = outcome.json().at("result");
  ASSERT_EQ(result.at("regions").size(), 1U);
  EXPECT_EQ(result.at("regions").at(0).at("end"), "outside_workspace");
}

TEST(UpdateCommand, PicturesOfAViewAreThoseOfTheViewAndNotOfTheWayToIt) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update is enough under sanitizers";
  const TempFolder folder;
  const Arguments first_view{"update", "--quiet",    "--scene",     "bottle", "--image-size", "160,120", "--voxel-size",
                             "0.02",   "--no-noise", "--max-views", "1"};
  for (const char* when : {"viewpoints", "motion"}) {
    const Outcome outcome = run_program(first_view + Arguments{"--fuse-when", when, "--out", (folder / when).string()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  // The first view is chosen in the same map, so that its exact picture is the same.
  const std::string at_view = text_of(folder / "viewpoints/view-01-seen.png");
  EXPECT_FALSE(at_view.empty());
  EXPECT_EQ(at_view, text_of(folder / "motion/view-01-seen.png"));
}

TEST(UpdateCommand, LongNamesOfObjectsStandApartFromTheirFigures) {
  if (kSanitized) GTEST_SKIP() << "a matter of text";
  const TempFolder folder;
  const Outcome outcome =
      run_program(Arguments{"update", "--quiet", "--scene", "tabletop-1", "--before", "tabletop-2", "--max-views", "0",
                            "--no-pictures", "--out", (folder / "run").string()} +
                  kSmallest);
  EXPECT_NE(outcome.out.find("\nright-middle  "), std::string::npos) << outcome.out << outcome.err;
}

TEST(UpdateCommand, SaysWhichRegionsAreOutOfReach) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update and an interrupted one are enough under sanitizers";
  const TempFolder folder;
  write_hand(folder / "hand.csv", {0.0, 0.0, 0.1}, 30);
  // View poses so far away are out of reach.
  const Outcome outcome =
      run_program(update(folder / "run", kSmallest + Arguments{"--no-pictures", "--scene", "bottle", "--radius", "3",
                                                               "--trajectory", (folder / "hand.csv").string()}));
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_NE(outcome.err.find("not one view"), std::string::npos) << outcome.err;
  const json result = outcome.json().at("result");
  EXPECT_EQ(result.at("regions").at(0).at("end"), "out_of_reach");
  EXPECT_FALSE(result.at("regions").at(0).at("refused").empty());
  EXPECT_TRUE(result.at("back").at("at_stand_by").get<bool>());
}

TEST(UpdateCommand, RefusesWhatMakesNoSense) {
  const TempFolder folder;
  const std::string out = (folder / "run").string();
  const auto refused = [&](int status, const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(Arguments{"update", "--out", out, "--quiet"} + more), status, "update", parts);
    EXPECT_FALSE(fs::exists(out));
  };
  refused(2, {}, {"--scene"});
  refused(2, {"--scene", "bottle", "--method", "magic"}, {"--method", "gmm-as"});
  refused(2, {"--scene", "bottle", "--fuse-when", "never"}, {"--fuse-when"});
  refused(2, {"--scene", "bottle", "--fuse-when", "motion", "--robot", "free"}, {"--fuse-when", "arm"});
  refused(2, {"--scene", "bottle", "--region-radius", "0"}, {"--region-radius"});
  refused(2, {"--scene", "bottle", "--region-radius", "1e6"}, {"--region-radius", "1000 m"});
  refused(2, {"--scene", "after.yaml"}, {"--before"});
  refused(3, {"--scene", "tabletop-1"}, {"tabletop-1-before", "no such scene"});
  refused(3, {"--scene", "bottle", "--before", "bottle"}, {"bottle"});
  refused(3, {"--scene", "bottle", "--trajectory", "nowhere.csv"}, {"nowhere.csv", "no such file"});
  refused(3, {"--scene", "bottle", "--robot", "nowhere.urdf"}, {"nowhere.urdf"});
}

TEST(UpdateCommand, ItsFolderIsNamedAfterTheSceneUnlessItIsGiven) {
  const TempFolder folder;
  folder.write("update-bottle", "a file, into which nothing can go");
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  const Outcome outcome = run_program({"update", "--scene", "bottle", "--robot", "free", "--quiet"});
  fs::current_path(before);
  expect_failure(outcome, 3, "update", {"update-bottle", "the results need a folder"});
}

TEST(UpdateCommand, AnInterruptedUpdateKeepsWhatItHas) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update is enough under sanitizers";
  const TempFolder folder;
  const fs::path run = folder / "run";
  RunningProgram program{
      Arguments{"update", "--scene", "jug", "--out", run.string(), "--fuse-when", "motion", "--no-pictures"} +
      (kSanitized ? kSmallest : Arguments{})};
  ASSERT_TRUE(program.wait_for("exploring"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("stopped after"), std::string::npos) << outcome.err;
  const json document = json::parse(text_of(run / "update.json"), nullptr, false);
  ASSERT_TRUE(document.is_object());
  EXPECT_TRUE(document.at("result").at("interrupted").get<bool>());
  EXPECT_TRUE(fs::exists(run / "map.sacmap"));
}

TEST(UpdateCommand, AnInterruptedScanIsNoUpdateThatIsDone) {
  if (kSanitized) GTEST_SKIP() << "the bottle's update and an interrupted one are enough under sanitizers";
  const TempFolder folder;
  const fs::path run = folder / "run";
  RunningProgram program{Arguments{"update", "--scene", "jug", "--out", run.string(), "--no-pictures"} +
                         (kSanitized ? kSmallest : Arguments{})};
  ASSERT_TRUE(program.wait_for("initial scan"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  const json document = json::parse(text_of(run / "update.json"), nullptr, false);
  ASSERT_TRUE(document.is_object());
  EXPECT_EQ(document.at("result").at("stopped_because"), "cancelled");
  EXPECT_EQ(document.at("result").at("regions").at(0).at("end"), "not_begun");
}

}  // namespace
}  // namespace saccade::test
