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
  const auto equal = [&](const std::string& whole, const nlohmann::json& plain, const std::string& name,
                         const Arguments& more) {
    const nlohmann::json paged = fused(name, more);
    EXPECT_EQ(names_in(run(name)), names_in(run(whole)));
    for (const std::string& file : names_in(run(whole))) {
      if (file == "run.json") continue;
      EXPECT_TRUE(text_of(run(name) / file) == text_of(run(whole) / file)) << name << ' ' << file;
    }
    EXPECT_EQ(paged.at("map"), plain.at("map"));
    EXPECT_EQ(paged.at("depth_residual_m"), plain.at("depth_residual_m"));
    EXPECT_GT(paged.at("paging").at("sectors_out").get<int>(), 0);
    EXPECT_GT(paged.at("paging").at("bytes_written").get<int>(), 0);
    EXPECT_GT(paged.at("paging").at("peak_map_bytes").get<int>(), 0);
  };
  const Arguments forced{"--tracking", "forced"};
  const nlohmann::json drawn = fused("drawn", forced);
  EXPECT_TRUE(drawn.at("paging").is_null());
  EXPECT_TRUE(fs::exists(run("drawn") / "ternary.png"));
  equal("drawn", drawn, "drawn-paged", forced + Arguments{"--map-memory", "1.5 MiB", "--threads", "2"});

  const std::vector<Arguments> policies{
      {"--map-memory", "1B"}, {"--moving-volume", "0.3"}, {"--moving-volume", "1", "--map-memory", "500kB"}};
  const Arguments tracked{"--tracking", "icp", "--no-pictures"};
  const nlohmann::json plain = fused("whole", tracked);
  for (std::size_t i = 0; i < policies.size(); ++i)
    equal("whole", plain, "paged-" + std::to_string(i), tracked + policies[i]);
}

TEST_F(FusePaging, SaysSoInTheSummary) {
  const Outcome outcome =
      run_program(fuse(frames(), run(), {"--map-memory", "1MiB", "--count", "6", "--no-mesh", "--no-pictures"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("sectors out ("), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("in memory"), std::string::npos) << outcome.out;
}

TEST_F(FusePaging, RefusesWhatIsNoSizeAndNoFolder) {
  for (const char* size : {"", "much", "-1GiB", "0", "512", "1GiBs", "1 GiB 2", "nan"}) {
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
      fuse(frames(), run(), {"--map-memory", "1B", "--threads", "1", "--no-mesh", "--no-pictures"});
  const Outcome outcome = RunningProgram{arguments, kFileBytes}.finish();
  expect_failure(outcome, 3, "fuse", {run().string(), "make room", "frames before is", "map.sacmap", "--continue"});
  EXPECT_FALSE(fs::exists(run() / "run.json"));
  const auto map = load_map(run() / "map.sacmap");
  ASSERT_TRUE(map);
  EXPECT_GT(map->grid.sector_count(), 10U);
}

}  // namespace
}  // namespace saccade::test
