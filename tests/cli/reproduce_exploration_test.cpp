// SPDX-License-Identifier: Apache-2.0
// saccade reproduce 3.1 to 3.3 and 3.16 to 3.22, with small images.
#include <gtest/gtest.h>

#include <limits>

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

/// Each view leaves less unknown near the objects than the one before it.
void expect_views(const nlohmann::json& figure) {
  ASSERT_GT(figure.at("rows").size(), 2U);
  std::size_t before = std::numeric_limits<std::size_t>::max();
  for (const nlohmann::json& row : figure.at("rows")) {
    EXPECT_LE(row.at("unknown_near_objects").get<std::size_t>(), before);
    before = row.at("unknown_near_objects").get<std::size_t>();
    EXPECT_GT(row.at("coverage").get<double>(), 0.0);
  }
}

TEST(ReproduceExploration, SegmentsOfObjectsComeBeforeTheTable) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; explore_test runs one";
  const TempFolder folder;
  const Outcome outcome = reproduce({"3.2", "3.16", "3.18"}, {"--out", folder.path().string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  const nlohmann::json& table = tables.at(0);
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

  // The exploration is the one of Table 3.2, carried out once.
  const nlohmann::json& candidates = tables.at(1).at("rows");
  EXPECT_EQ(candidates.at(0).at("here"), table.at("candidates"));
  EXPECT_EQ(candidates.at(1).at("here"), table.at("of_chosen"));
  EXPECT_EQ(candidates.at(0).at("thesis"), 91960);
  expect_views(tables.at(2));
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"fig-3-16.png", "fig-3-18.png", "report.html"}));
  EXPECT_LT(outcome.json().at("timings_ms").at("table 3.18").get<double>(), 1000.0);
}

TEST(ReproduceExplorationEvidence, ViewsAndMapsOfBothStrategies) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; explore_test runs one";
  const TempFolder folder;
  const Outcome outcome = reproduce({"3.19", "3.20", "3.21", "3.22"}, {"--out", folder.path().string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  for (std::size_t i = 0; i < 3; ++i) expect_views(tables.at(i));
  ASSERT_EQ(tables.at(3).at("rows").size(), 8U);
  for (const nlohmann::json& row : tables.at(3).at("rows")) EXPECT_GT(row.at("coverage").get<double>(), 0.3) << row;
  EXPECT_EQ(names_in(folder.path()),
            (std::vector<std::string>{"fig-3-19.png", "fig-3-20.png", "fig-3-21.png", "fig-3-22.png", "report.html"}));
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
