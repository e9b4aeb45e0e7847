// SPDX-License-Identifier: Apache-2.0
// saccade reproduce of the figures of saliency.
#include <gtest/gtest.h>

#include "cli/run_program.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

TEST(ReproduceFigures, OfSaliencyArePicturesWithFigures) {
  if (kSanitized) GTEST_SKIP() << "two scans take long under sanitizers; explore_test runs them";
  const TempFolder folder;
  const fs::path out = folder / "figures";
  const Outcome outcome = run_program({"reproduce", "3.8", "3.9", "--quiet", "--json", "-", "--out", out.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"fig-3-8.png", "fig-3-9.png", "report.html"}));
  EXPECT_GT(read_color(out / "fig-3-8.png").value().width(), 2000);
  EXPECT_GT(read_color(out / "fig-3-9.png").value().width(), 2500);
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables.at(0).at("table"), "3.8");
  EXPECT_GE(tables.at(0).at("objects").get<int>(), 5);
  const nlohmann::json& by = tables.at(0).at("rows");
  ASSERT_EQ(by.size(), 3U);
  // The figure must show that isolation takes scraps their saliency, more than objects theirs, and roundness
  // supports.
  EXPECT_LT(by.at(2).at("mean_of_scraps"), by.at(0).at("mean_of_scraps"));
  EXPECT_LT(by.at(2).at("mean_of_supports"), by.at(1).at("mean_of_supports"));
  EXPECT_GT(by.at(2).at("objects_first"), by.at(1).at("objects_first"));
  const auto objects_to_scraps = [&by](std::size_t row) {
    return by.at(row).at("mean_of_objects").get<double>() / by.at(row).at("mean_of_scraps").get<double>();
  };
  EXPECT_GT(objects_to_scraps(2), objects_to_scraps(0));
  EXPECT_GT(objects_to_scraps(2), objects_to_scraps(1));
  const nlohmann::json& distances = tables.at(1).at("rows");
  ASSERT_EQ(distances.size(), 5U);
  EXPECT_EQ(distances.at(2).at("saliency"), by.at(2).at("saliency"));  // B_th = 0.02 m
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_LE(distances.at(i).at("mean_of_scraps"), distances.at(i - 1).at("mean_of_scraps"));
    EXPECT_GE(distances.at(i).at("objects_at_zero"), distances.at(i - 1).at("objects_at_zero"));
  }
  EXPECT_GT(distances.at(4).at("objects_at_zero"), distances.at(0).at("objects_at_zero"));
}

}  // namespace
}  // namespace saccade::test
