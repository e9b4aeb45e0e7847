// SPDX-License-Identifier: Apache-2.0
// saccade explore, on small images and large voxels.
#include <gtest/gtest.h>

#include <algorithm>

#include "run_program.hpp"
#include "saccade/io/json_io.hpp"
#include "saccade/io/ply_io.hpp"
#include "saccade/io/sacmap.hpp"

namespace saccade::test {
namespace {

Arguments explore(const fs::path& out, Arguments more) {
  Arguments all{"explore", "clutter:5",    "--out", out.string(), "--image-size",
                "128,96",  "--voxel-size", "0.02",  "--quiet"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(ExploreCommand, GoesFromViewToView) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  const Outcome outcome = run_program(explore(run, {"--max-views", "2", "--min-gain", "5", "--json", "-"}));
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
    EXPECT_GE(view.at("gain").get<std::size_t>(), 5U);
    EXPECT_TRUE(pose_from_json(view.at("T_world_camera")));
    EXPECT_TRUE(view.at("points_at_object").is_boolean());
    for (const char* phase : {"candidates", "evaluation", "motion", "fusion"})
      EXPECT_GE(view.at("ms").at(phase).get<double>(), 0.0);
  }
  const nlohmann::json& final = result.at("final");
  EXPECT_EQ(final.at("unknown_left"), unknown);
  EXPECT_GT(final.at("coverage").get<double>(), result.at("initial").at("coverage").get<double>());
  EXPECT_GT(final.at("f_score").get<double>(), 0.0);
  EXPECT_GT(final.at("chamfer_m").get<double>(), 0.0);
  EXPECT_TRUE(load_map(run / "map.sacmap"));
  EXPECT_TRUE(read_mesh(run / "mesh.ply"));
  for (const char* picture : {"view-00.png", "view-01.png", "view-02.png", "run.json"})
    EXPECT_TRUE(fs::exists(run / picture));
}

TEST(ExploreCommand, AShorterRunLeavesNoPicturesOfALongerOne) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  ASSERT_EQ(run_program(explore(run, {"--max-views", "1", "--min-gain", "5"})).status, 0);
  EXPECT_TRUE(fs::exists(run / "view-01.png"));
  ASSERT_EQ(run_program(explore(run, {"--max-views", "0"})).status, 0);
  EXPECT_TRUE(fs::exists(run / "view-00.png"));
  EXPECT_FALSE(fs::exists(run / "view-01.png"));
}

TEST(ExploreCommand, TheSeedDecidesAndTheThreadsDoNot) {
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
  refused(explore(out, {"--robot", "walking"}), 2, "--robot");
  refused(explore(out, {"--strategy", "best"}), 2, "--strategy");
  refused(explore(out, {"--voxel-size", "-1"}), 2, "--voxel-size");
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace saccade::test
