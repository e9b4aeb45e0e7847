// SPDX-License-Identifier: Apache-2.0
// saccade reproduce 3.1, 3.2, 3.3 and 3.17, with small images.
#include <gtest/gtest.h>

#include "run_program.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

Outcome reproduce(Arguments tables, const Arguments& more = {}) {
  Arguments arguments{"reproduce", "--image-width", "64", "--quiet", "--json", "-"};
  arguments.insert(arguments.end(), tables.begin(), tables.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

void expect_experiments(const nlohmann::json& experiments) {
  ASSERT_EQ(experiments.size(), 12U) << "attention, attention as printed and standard in four scenes";
  std::size_t views{0};
  for (const nlohmann::json& experiment : experiments) {
    views += experiment.at("views").size();
    for (const nlohmann::json& view : experiment.at("views")) {
      EXPECT_GT(view.at("candidates").get<std::size_t>(), view.at("evaluated").get<std::size_t>());
      EXPECT_GT(view.at("motion_s").get<double>(), 0.0);
      EXPECT_TRUE(view.at("points_at_object").is_boolean());
      EXPECT_TRUE(view.at("looks_at_object").is_boolean());
    }
  }
  EXPECT_GT(views, 24U);
}

TEST(ReproduceExploration, SegmentsOfObjectsComeBeforeTheTable) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; explore_test runs one";
  const Outcome outcome = reproduce({"3.2"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json table = outcome.json().at("result").at("tables").at(0);
  const nlohmann::json& rows = table.at("rows");
  ASSERT_GT(rows.size(), 1U);
  std::size_t of_objects{0};
  double before{1.0};
  for (const nlohmann::json& row : rows) {
    EXPECT_EQ(row.at("poses").get<std::size_t>() % 40, 0U);
    EXPECT_LE(row.at("saliency").get<double>(), before);
    before = row.at("saliency").get<double>();
    if (row.at("object") != "part of the table") of_objects += row.at("poses").get<std::size_t>();
  }
  EXPECT_EQ(table.at("of_objects"), of_objects);
  EXPECT_GT(table.at("candidates").get<std::size_t>(), of_objects);
}

TEST(ReproduceExplorationEvidence, PhasesMarksAndCurvesOfFourScenes) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; explore_test runs one";
  const TempFolder folder;
  const Outcome outcome = reproduce({"3.1", "3.3", "3.17"}, {"--out", folder.path().string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  ASSERT_EQ(tables.size(), 3U);
  for (const nlohmann::json& table : tables) expect_experiments(table.at("experiments"));
  EXPECT_EQ(tables[0].at("rows").size(), 8U);
  double attention{0.0};
  double standard{0.0};
  for (const nlohmann::json& row : tables[0].at("rows")) {
    if (row.at("phase") == "views evaluation") {
      attention = row.at("attention_s").get<double>();
      standard = row.at("standard_s").get<double>();
    }
  }
  EXPECT_GT(attention, 0.0);
  EXPECT_GT(standard, 0.0);
  for (const int scene : {1, 2, 3, 4}) {
    EXPECT_TRUE(fs::exists(folder / ("fig-3-17-tabletop-" + std::to_string(scene) + ".svg")));
  }
}

}  // namespace
}  // namespace saccade::test
