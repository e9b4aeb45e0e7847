// SPDX-License-Identifier: Apache-2.0
// saccade explore --map surfels: a short run, its files and its record, and options that it refuses.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "run_program.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

Arguments on_surfels(const fs::path& out, const Arguments& more = {}) {
  return Arguments{"explore", tiny_cell_file(), "--out",   out.string(),   "--map",   "surfels",     "--quiet",
                   "--robot", "free",           "--force", "--image-size", "160,120", "--max-views", "2"} +
         more;
}

Arguments shortly_on_surfels(const fs::path& out) {
  return {"explore", tiny_cell_file(), "--out",        out.string(), "--map",       "surfels", "--quiet",
          "--robot", "free",           "--image-size", "96,72",      "--max-views", "1",       "--no-pictures"};
}

TEST(ExploreSurfels, ARunLeavesSurfelsPicturesAndARecord) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const fs::path run = folder / "run";
  const Outcome done = run_program(on_surfels(run));
  ASSERT_EQ(done.status, 0) << done.err;
  for (const char* name : {"surfels.ply", "unknown.ply", "map.sacmap", "ternary.npy", "report.html", "view-00-map.png",
                           "view-01-choice.png", "view-01-map.png", "view-01-seen.png", "view-01.sacmap"})
    EXPECT_TRUE(fs::exists(run / name)) << name;
  EXPECT_FALSE(fs::exists(run / "mesh.ply"));
  EXPECT_FALSE(fs::exists(run / "journal.json"));
  const auto document = read_json(run / "run.json");
  ASSERT_TRUE(document);
  const auto& result = document->at("result");
  EXPECT_EQ(result.at("strategy"), "surfels");
  const auto& map = result.at("map");
  EXPECT_EQ(map.at("kind"), "surfels");
  EXPECT_EQ(map.at("voxel_size_m"), 0.02);
  EXPECT_EQ(map.at("memory_bytes").get<std::size_t>(),
            map.at("voxels_bytes").get<std::size_t>() + map.at("surfels_bytes").get<std::size_t>());
  EXPECT_GE(map.at("surfels_bytes").get<std::size_t>(), 48 * map.at("surfels").get<std::size_t>());
  EXPECT_GT(map.at("surfels").get<std::size_t>(), 1000U);
  EXPECT_GT(map.at("unknown_surfels").get<std::size_t>(), 10U);
  EXPECT_GT(result.at("final").at("coverage").get<double>(), result.at("initial").at("coverage").get<double>());
  ASSERT_FALSE(result.at("views").empty());
  EXPECT_GT(result.at("views").at(0).at("gain_observed").get<double>(), 0.0);
}

TEST(ExploreSurfels, AKilledRunGoesOnAndEndsAsOneThatWasNotKilled) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const fs::path whole = folder / "whole";
  const fs::path killed = folder / "killed";
  ASSERT_EQ(run_program(shortly_on_surfels(whole)).status, 0);
  {
    RunningProgram program{shortly_on_surfels(killed)};
    ASSERT_TRUE(wait_for_file(killed / "checkpoint-0.npy"));
    program.send(SIGKILL);
    EXPECT_EQ(program.finish().status, -1);
  }
  const Arguments resume = shortly_on_surfels(killed) + Arguments{"--resume"};
  const std::string journal = text_of(killed / "journal.json");
  const std::string name = nlohmann::json::parse(journal).at("surfels").at("file").get<std::string>();
  const std::string surfels = text_of(killed / name);
  std::string damaged = surfels;
  damaged.back() ^= 1;
  std::ofstream{killed / name, std::ios::binary} << damaged;
  expect_failure(run_program(resume), 3, "explore", {name, "checksum"});
  std::ofstream{killed / name, std::ios::binary} << surfels;
  expect_failure(run_program(resume + Arguments{"--free-voxel", "0.03"}), 3, "explore",
                 {"free_voxel_m 0.02, not 0.03"});
  const Outcome resumed = run_program(resume);
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  for (const char* file : {"surfels.ply", "unknown.ply", "map.sacmap"})
    EXPECT_TRUE(text_of(killed / file) == text_of(whole / file)) << file;
  EXPECT_EQ(names_in(killed), names_in(whole));  // no journal and no checkpoint are left
}

TEST(ExploreSurfels, AVolumeTellsItsMemoryToo) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const fs::path run = folder / "run";
  ASSERT_EQ(run_program({"explore", tiny_cell_file(), "--out", run.string(), "--quiet", "--robot", "free",
                         "--image-size", "96,72", "--voxel-size", "0.015", "--max-views", "0", "--no-pictures"})
                .status,
            0);
  const auto document = read_json(run / "run.json");
  ASSERT_TRUE(document);
  const auto& map = document->at("result").at("map");
  EXPECT_EQ(map.at("kind"), "volume");
  EXPECT_GT(map.at("memory_bytes").get<std::size_t>(), 100'000U);
  EXPECT_FALSE(map.contains("surfels"));
}

TEST(ExploreSurfels, OptionsThatSayNothingAboutSurfelsAreRefused) {
  const TempFolder folder;
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"--strategy", "attention"}, "--strategy: with --map surfels"},
      {{"--voxel-size", "0.01"}, "--free-voxel sets those of free space"},
      {{"--truncation", "3"}, "--truncation: with --map surfels"},
      {{"--saliency", "roundness"}, "--saliency: with --map surfels"},
      {{"--tracking", "icp"}, "--tracking: with --map surfels"},
      {{"--dry-run"}, "leave --map surfels out"},
      {{"--free-voxel", "0"}, "--free-voxel"},
  };
  for (const auto& [more, expected] : cases) {
    const Outcome refused = run_program(on_surfels(folder / "run", more));
    EXPECT_EQ(refused.status, 2) << more.front();
    EXPECT_NE(refused.err.find(expected), std::string::npos) << refused.err;
  }
  const Outcome alone =
      run_program({"explore", tiny_cell_file(), "--out", (folder / "run").string(), "--free-voxel", "0.01"});
  EXPECT_EQ(alone.status, 2);
  EXPECT_NE(alone.err.find("--free-voxel: is for --map surfels"), std::string::npos) << alone.err;
  EXPECT_FALSE(fs::exists(folder / "run"));
}

}  // namespace
}  // namespace saccade::test
