// SPDX-License-Identifier: Apache-2.0
// saccade explore: what a view is chosen by, and what is said where there is nothing to choose.
#include <gtest/gtest.h>

#include "run_program.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

/// A small image in the scene.
Outcome explore(const std::string& scene, const fs::path& out, const Arguments& more) {
  return run_program(Arguments{"explore", scene, "--out", out.string(), "--image-size", "96,72", "--voxel-size",
                               "0.015", "--no-pictures", "--quiet"} +
                     more);
}

/// A table wider than the workspace, and what stands on it, or nothing.
std::string table_scene(const std::string& objects) {
  return "scene: table\n"
         "workspace: {min: [-0.25, -0.25, -0.03], max: [0.25, 0.25, 0.25]}\n"
         "scan: [{from: [-0.75, 0, 0.35], look_at: [0, 0, 0.05]}]\n"
         "objects:\n"
         "  - {name: table, box: {size: [1.0, 1.0, 0.03]}, at: [0, 0, -0.03], support: true}\n" +
         objects;
}

TEST(ExploreChoices, WhatIsLookedAheadChangesWhatIsChosenAndFramesOnTheWayAreFused) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; Foresight has its own tests";
  const TempFolder folder;
  const Arguments options{"--max-views",    "2",   "--lookahead", "3", "--objective", "surface-per-second",
                          "--frame-on-way", "0.2", "--json",      "-"};
  const Outcome outcome = explore(tiny_cell_file(), folder / "run", options);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  const nlohmann::json& views = result.at("views");
  ASSERT_EQ(views.size(), 2U);
  EXPECT_GT(views[0].at("frames_on_way").get<int>() + views[1].at("frames_on_way").get<int>(), 0);
  EXPECT_GT(views[0].at("gain_observed").get<double>(), 0.0);

  // The first view does not depend on how many may follow.
  const Arguments one = Arguments{"--max-views", "1"} + Arguments(options.begin() + 2, options.end());
  const Outcome first = explore(tiny_cell_file(), folder / "first", one);
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.json().at("result").at("views")[0].at("T_world_camera"), views[0].at("T_world_camera"));
  const Outcome gains_alone = explore(tiny_cell_file(), folder / "gains", {"--max-views", "2", "--json", "-"});
  ASSERT_EQ(gains_alone.status, 0) << gains_alone.err;
  EXPECT_NE(gains_alone.json().at("result").at("views"), result.at("views"));
}

TEST(ExploreChoices, AMissingGpuIsSaidWhereItWasAskedFor) {
  const nlohmann::json info = run_program({"info", "--json", "-"}).json().at("result");
  if (info.at("backends").at("cuda")) GTEST_SKIP() << "there is a GPU";
  const TempFolder folder;
  const std::string why = info.at("cuda").at("absent_because");
  const Arguments options{"--max-views", "1", "--no-pictures", "--backend"};
  expect_failure(explore(tiny_cell_file(), folder / "x", options + Arguments{"cuda"}), 4, "explore", {why});
  if (kSanitized) return;
  const Outcome automatic = explore(tiny_cell_file(), folder / "y", options + Arguments{"auto", "--json", "-"});
  ASSERT_EQ(automatic.status, 0) << automatic.err;
  EXPECT_EQ(automatic.json().at("result").at("compute").at("used"), "cpu");
}

TEST(ExploreChoices, AMeshInMillimetresIsScaledOntoTheTable) {
  const TempFolder folder;
  const std::string mesh = folder
                               .write("wedge.obj",
                                      "v 0 0 0\nv 120 0 0\nv 0 120 0\nv 0 0 150\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
                                      "f 2 3 4\n")
                               .string();
  const Arguments flying{"--robot", "free", "--max-views", "0"};
  expect_failure(explore(mesh, folder / "run", flying), 3, "explore", {"120 x 120 x 150 m", "--mesh-scale", "0.001"});
  expect_failure(explore(mesh, folder / "run", flying + Arguments{"--mesh-scale", "0"}), 2, "explore",
                 {"--mesh-scale"});
  const Outcome scaled =
      explore(mesh, folder / "run", flying + Arguments{"--mesh-scale", "0.001", "--mesh-up", "y", "--json", "-"});
  ASSERT_EQ(scaled.status, 0) << scaled.err;
  const nlohmann::json result = scaled.json().at("result");
  EXPECT_EQ(result.at("scene"), "wedge.obj");
  EXPECT_GT(result.at("initial").at("coverage").get<double>(), 0.0);
}

TEST(ExploreChoices, RefuseWhatTheyCannotWeigh) {
  const TempFolder folder;
  const auto refused = [&](const Arguments& options, const std::vector<std::string>& parts) {
    expect_failure(explore(tiny_cell_file(), folder / "x", options), 2, "explore", parts);
  };
  refused({"--lookahead", "0"}, {"--lookahead"});
  refused({"--objective", "time"}, {"--objective", "surface-per-second"});
  refused({"--frame-on-way", "-1"}, {"frames on the way"});
  refused({"--frame-on-way", "nan"}, {"frame"});
  refused({"--frame-on-way", "1e-9"}, {"frames on the way", "10 ms"});
  refused({"--frame-on-way", "0.5", "--robot", "free"}, {"--frame-on-way", "needs an arm"});
}

TEST(ExploreChoices, ATableWithNothingOnItIsDoneAtOnce) {
  const TempFolder folder;
  const std::string scene = folder.write("bare.yaml", table_scene("")).string();
  const Outcome outcome = explore(scene, folder / "run", {"--robot", "free", "--no-noise", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("stopped_because"), "regions_done");
  EXPECT_TRUE(result.at("views").empty());
  EXPECT_TRUE(result.at("final").at("coverage").is_null()) << "there is nothing to cover";
  expect_failure(explore(scene, folder / "oracle", {"--robot", "free", "--strategy", "oracle"}), 3, "explore",
                 {"nothing but supports", "choose another"});
}

/// Nothing behind it tells what is empty around it.
TEST(ExploreChoices, AThingInTheAirIsSeenFromAllSides) {
  const TempFolder folder;
  const std::string scene =
      "scene: in the air\n"
      "workspace: {min: [-0.2, -0.2, 0], max: [0.2, 0.2, 0.4]}\n"
      "scan: [{from: [-0.8, 0, 0.25], look_at: [0, 0, 0.2]}]\n"
      "objects:\n"
      "  - {name: box, box: {size: [0.12, 0.1, 0.15]}, at: [0, 0, 0.12], turn_deg: [0, 0, 20]}\n";
  const Outcome outcome = explore(folder.write("air.yaml", scene).string(), folder / "run",
                                  {"--robot", "free", "--no-noise", "--max-views", "12", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("stopped_because"), "regions_done");
  EXPECT_GT(result.at("final").at("coverage").get<double>(), 0.95);
  bool kept = true;
  for (const nlohmann::json& view : result.at("views")) {
    const bool kept_before = kept;
    kept = view.at("gain_observed").get<double>() >= 0.1 * view.at("gain").get<double>();
    EXPECT_TRUE(kept || kept_before) << "two in a row broke their promises";
  }
}

TEST(ExploreChoices, NothingSalientIsDoneAtOnce) {
  const TempFolder folder;
  const Outcome outcome = explore(tiny_cell_file(), folder / "run",
                                  {"--robot", "free", "--saliency", "region", "--box", "5,5,5,6,6,6", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("stopped_because"), "regions_done");
  EXPECT_TRUE(outcome.json().at("result").at("views").empty());
}

TEST(ExploreChoices, NothingWithinReachIsSaidWithItsReasons) {
  const TempFolder folder;
  std::string far = table_scene("  - {name: box, box: {size: [0.1, 0.1, 0.1]}, at: [5, 0, 0]}\n");
  const auto replace = [&far](const std::string& from, const std::string& to) {
    ASSERT_NE(far.find(from), std::string::npos) << from;
    far.replace(far.find(from), from.size(), to);
  };
  replace("min: [-0.25", "min: [4.75");
  replace("max: [0.25", "max: [5.25");
  replace("from: [-0.75, 0, 0.35], look_at: [0", "from: [0.6, 0, 0.6], look_at: [5");
  replace("at: [0, 0, -0.03]", "at: [5, 0, -0.03]");
  const Outcome outcome = explore(folder.write("far.yaml", far).string(), folder / "run",
                                  {"--max-range", "6", "--min-gain", "1", "--json", (folder / "far.json").string()});
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_NE(outcome.err.find("out of reach"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace saccade::test
