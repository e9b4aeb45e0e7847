// SPDX-License-Identifier: Apache-2.0
// saccade fuse with a paged map: the results of a map in memory, and clear errors where paging cannot go on.
#include <gtest/gtest.h>

#include "cli/run_program.hpp"
#include "saccade/io/maps/sacmap.hpp"

namespace saccade::test {
namespace {

class FusePaging : public ::testing::Test {
 protected:
  void SetUp() override { make_sample(frames(), 21); }
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  [[nodiscard]] fs::path run(const std::string& name = "run") const { return folder_ / name; }
  [[nodiscard]] nlohmann::json fused(const std::string& name, const Arguments& more) const {
    const Outcome outcome = run_program(fuse(frames(), run(name), more + Arguments{"--count", "6", "--json", "-"}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result");
  }
  TempFolder folder_;
};

TEST_F(FusePaging, GivesTheFilesOfAMapInMemory) {
  const std::map<std::string, std::vector<Arguments>> policies{
      {"forced", {{"--map-memory", "1.5 MiB", "--threads", "2"}, {"--moving-volume", "1", "--map-memory", "500kB"}}},
      {"icp", {{"--map-memory", "1"}}}};
  for (const auto& [tracking, bounds] : policies) {
    const std::string whole = "whole-" + tracking;
    const nlohmann::json plain = fused(whole, {"--tracking", tracking});
    EXPECT_TRUE(plain.at("paging").is_null());
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const std::string name = tracking + std::to_string(i);
      const nlohmann::json paged = fused(name, Arguments{"--tracking", tracking} + bounds[i]);
      for (const char* file : {"map.sacmap", "mesh.ply", "trajectory.txt", "fusion-first.png", "fusion-last.png"}) {
        EXPECT_TRUE(text_of(run(name) / file) == text_of(run(whole) / file)) << name << ' ' << file;
      }
      EXPECT_EQ(names_in(run(name)), names_in(run(whole)));
      EXPECT_EQ(paged.at("map"), plain.at("map"));
      EXPECT_EQ(paged.at("depth_residual_m"), plain.at("depth_residual_m"));
      EXPECT_GT(paged.at("paging").at("sectors_out").get<int>(), 0);
      EXPECT_GT(paged.at("paging").at("bytes_written").get<int>(), 0);
      EXPECT_GT(paged.at("paging").at("peak_map_bytes").get<int>(), 0);
    }
  }
}

TEST_F(FusePaging, SaysSoInTheSummary) {
  const Outcome outcome =
      run_program(fuse(frames(), run(), {"--map-memory", "1MiB", "--count", "6", "--no-mesh", "--no-pictures"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("sectors out ("), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("in memory"), std::string::npos) << outcome.out;
}

TEST_F(FusePaging, RefusesWhatIsNoSizeAndNoFolder) {
  for (const char* size : {"", "much", "-1GiB", "0", "1GiBs", "1 GiB 2", "nan"}) {
    const Outcome outcome = run_program(fuse(frames(), run(), {"--map-memory", size}));
    EXPECT_EQ(outcome.status, 2) << size;
    EXPECT_NE(outcome.err.find("--map-memory"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run_program(fuse(frames(), run(), {"--moving-volume", "0"})).status, 2);
  EXPECT_EQ(run_program(fuse(frames(), run(), {"--page-folder", folder_.path().string()})).status, 2);
  const fs::path missing = folder_ / "missing";
  expect_failure(run_program(fuse(frames(), run(), {"--map-memory", "1MiB", "--page-folder", missing.string()})), 3,
                 "fuse", {missing.string(), "choose a folder"});
  EXPECT_FALSE(fs::exists(run()));
}

TEST_F(FusePaging, AFullDiskEndsTheRunAndKeepsTheMapBefore) {
  // No file may grow beyond this: enough for the map of the first frames, not for what is paged out later.
  constexpr rlim_t kFileBytes{1050 << 10};
  const Arguments arguments =
      fuse(frames(), run(), {"--map-memory", "1", "--threads", "1", "--no-mesh", "--no-pictures"});
  const Outcome outcome = RunningProgram{arguments, kFileBytes}.finish();
  expect_failure(outcome, 3, "fuse", {run().string(), "make room", "frames before is", "map.sacmap", "--continue"});
  EXPECT_FALSE(fs::exists(run() / "run.json"));
  const auto map = load_map(run() / "map.sacmap");
  ASSERT_TRUE(map);
  EXPECT_GT(map->grid.sector_count(), 10U);
}

}  // namespace
}  // namespace saccade::test
