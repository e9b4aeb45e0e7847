// SPDX-License-Identifier: Apache-2.0
// saccade reproduce 4.4 to 4.8 as a user runs them: on made clouds, on a folder of labelled ones, and on bad input.
#include <algorithm>
#include <array>
#include <iostream>
#include <map>

#include "cli/annotated_boxes.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

class ReproduceAnnotation : public AnnotatedBoxes {
 protected:
  void SetUp() override {
    write_boxes("a", 30, "clouds");
    write_boxes("b", 45, "clouds");
  }
  [[nodiscard]] nlohmann::json tables_of(const Arguments& tables, const Arguments& more) const {
    const Outcome outcome = run_program(Arguments{"--json", "-", "--quiet", "reproduce"} + tables + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result").at("tables");
  }
  [[nodiscard]] Arguments on_boxes() const { return {"--clouds", path("clouds")}; }
};

/// The first row by that annotator and method whose other keys have these values.
nlohmann::json study_row(const nlohmann::json& table, const std::string& annotator, const std::string& method,
                         const std::map<std::string, std::string>& others = {}) {
  for (const nlohmann::json& row : table.at("rows")) {
    const bool fits = row.at("annotator") == annotator && row.at("method") == method;
    if (fits && std::all_of(others.begin(), others.end(), [&](const auto& o) { return row.at(o.first) == o.second; })) {
      return row;
    }
  }
  ADD_FAILURE() << "no such row of " << annotator << ", " << method;
  return nullptr;
}

TEST_F(ReproduceAnnotation, StandsBesideTheUserStudy) {
  const nlohmann::json tables = tables_of({"4.5", "4.6"}, on_boxes());
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_NEAR(study_row(tables.at(0), "people", "control points").at("errors_per_100k").get<double>(), 797.4, 0.1);
  EXPECT_EQ(study_row(tables.at(0), "people", "rectangles").at("errors").at("mean"), 3551);
  EXPECT_EQ(study_row(tables.at(1), "people", "control points").at("errors").at("mean"), 926);
  EXPECT_NEAR(study_row(tables.at(1), "people", "rectangles").at("errors_per_100k").get<double>(), 3480.1, 0.1);
  for (const nlohmann::json& table : tables) {
    EXPECT_EQ(table.at("clouds"), 2);
    EXPECT_EQ(table.at("rows").size(), 2U + 2U * 5U);
    EXPECT_NE(table.at("notes").at(0).get<std::string>().find("No person annotates here"), std::string::npos);
    for (const nlohmann::json& row : table.at("rows")) {
      if (row.at("annotator") == "people") continue;
      ASSERT_EQ(row.at("clouds").size(), 2U);
      EXPECT_EQ(row.at("clouds").at(0).at("cloud"), "a.csv");
      double errors{0.0};
      for (const nlohmann::json& cloud : row.at("clouds")) {
        EXPECT_EQ(cloud.at("labels"), kLabels);
        EXPECT_EQ(cloud.at("points"), kPoints);
        EXPECT_GE(cloud.at("actions"), 1);
        errors += 0.5 * cloud.at("errors").get<double>();
      }
      EXPECT_DOUBLE_EQ(row.at("errors").at("mean").get<double>(), errors);
    }
    // Boxes of one colour on a table of another: a click on each, and nothing is wrong any more.
    const nlohmann::json clicks =
        study_row(table, "simulated", "control points", {{"weights", "ours"}, {"budget", "total"}});
    EXPECT_EQ(clicks.at("errors").at("mean"), 0.0);
    EXPECT_EQ(clicks.at("actions").at("mean"), kLabels);
    EXPECT_EQ(clicks.at("iou_mean").at("mean"), 1.0);
  }
}

TEST_F(ReproduceAnnotation, NoLabelCountsAsTheBackground) {
  constexpr int kGroups{80};  // more groups than actions; no path leads from one to another
  std::ofstream cloud{folder_ / "clouds" / "a.csv", std::ios::app};
  std::ofstream truth{folder_ / "clouds" / "a.txt", std::ios::app};
  for (int i = 0; i < 12 * kGroups; ++i) {
    cloud << 10 + i / 12 << ',' << 0.01 * (i % 12) << ",1,200,0,90\n";
    truth << "1\n";
  }
  cloud.close();
  truth.close();
  const nlohmann::json row =
      study_row(tables_of({"4.5"}, on_boxes()).at(0), "simulated", "control points", {{"weights", "ours"}});
  const nlohmann::json& spread = row.at("clouds").at(0);
  EXPECT_EQ(spread.at("points"), kPoints + 12 * kGroups);
  EXPECT_EQ(spread.at("actions"), 26);
  EXPECT_EQ(spread.at("errors"), 0);
}

TEST_F(ReproduceAnnotation, MadeCloudsAreLabelledByTheirScenes) {
  if (kSanitized) GTEST_SKIP() << "takes long under sanitizers; the tests of annotation run the code";
  const Arguments small{"--image-width", "160", "--seed", "3"};
  const nlohmann::json tables = tables_of({"4.6", "4.8"}, small + Arguments{"--threads", "1"});
  const nlohmann::json clicks =
      study_row(tables.at(0), "simulated", "control points", {{"weights", "ours"}, {"budget", "per_label"}});
  ASSERT_EQ(clicks.at("clouds").size(), 4U);
  EXPECT_EQ(clicks.at("clouds").at(0).at("labels"), 7);  // six objects and the table
  for (const nlohmann::json& cloud : clicks.at("clouds")) {
    EXPECT_GT(cloud.at("points"), 5000);
    EXPECT_GT(cloud.at("iou_mean"), 0.85) << cloud;
  }
  EXPECT_EQ(tables.at(0), tables_of({"4.6"}, small + Arguments{"--threads", "3"}).at(0));
  EXPECT_NE(tables.at(0), tables_of({"4.6"}, {"--image-width", "160", "--seed", "4"}).at(0));
}

TEST_F(ReproduceAnnotation, StepsAreTimedBesideTheThesis) {
  fs::create_directories(folder_ / "more");
  std::ofstream{folder_ / "more" / "few.csv"} << "x,y,z\n0,0,1\n0,0.01,1\n0.01,0,1\n";
  std::ofstream{folder_ / "more" / "few.txt"} << "1\n1\n2\n";
  write_boxes("many", 30, "more");
  const nlohmann::json table = tables_of({"4.8"}, {"--clouds", path("more")}).at(0);
  EXPECT_EQ(table.at("cloud"), "many.csv");
  EXPECT_EQ(table.at("points"), kPoints);
  ASSERT_EQ(table.at("rows").size(), 4U);
  const std::array<double, 4> printed{520, 41, 10, 11};
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const nlohmann::json& row = table.at("rows").at(i);
    EXPECT_EQ(row.at("thesis_ms"), printed.at(i));
    EXPECT_GT(row.at("ms"), 0.0);
    EXPECT_GT(row.at("table_4_4_weights_ms"), 0.0);
  }
  // Three points: no others than the control points to add.
  fs::remove(folder_ / "more" / "many.csv");
  EXPECT_EQ(tables_of({"4.8"}, {"--clouds", path("more")}).at(0).at("points"), 3);
}

TEST_F(ReproduceAnnotation, ParametersAndTheQuestionnaireAreQuoted) {
  const nlohmann::json tables = tables_of({"4.4", "4.7"}, {});
  const std::string defaults = run_program({"annotate", "--help"}).out;
  ASSERT_EQ(tables.at(0).at("rows").size(), 5U);
  for (const nlohmann::json& row : tables.at(0).at("rows")) {
    EXPECT_NE(defaults.find(row.at("option").get<std::string>()), std::string::npos) << row;
  }
  EXPECT_EQ(tables.at(0).at("rows").at(3).at("thesis"), 1.0);
  EXPECT_EQ(tables.at(0).at("rows").at(3).at("here"), 100.0);
  EXPECT_EQ(tables.at(1).at("quoted"), true);
  EXPECT_EQ(tables.at(1).at("rows").size(), 5U);
}

TEST_F(ReproduceAnnotation, BadInputIsOneLine) {
  expect_failure(run_program({"reproduce", "4.5", "--clouds", path("none")}), 2, "reproduce", {"--clouds", "none"});
  fs::create_directories(folder_ / "empty");
  expect_failure(run_program({"reproduce", "4.5", "--quiet", "--clouds", path("empty")}), 3, "reproduce", {"empty"});
  fs::remove(folder_ / "clouds" / "b.txt");
  expect_failure(run_program({"reproduce", "4.8", "--quiet", "--clouds", path("clouds")}), 3, "reproduce", {"b.csv"});
  std::ofstream{folder_ / "clouds" / "b.txt"} << "1\n2\n";
  expect_failure(run_program({"reproduce", "4.6", "--quiet", "--clouds", path("clouds")}), 3, "reproduce", {"b.txt"});
}

/// Some of mOSD's clouds, by links.
TEST(AnnotateRecordedCloudsEvidence, ThreeClicksPerLabelAreAlmostEnough) {
  if (kSanitized) GTEST_SKIP() << "takes long under sanitizers; the tests of annotation run the code";
  const fs::path recorded = shared_data() / "mosd_labelled" / "learn";
  if (!fs::exists(recorded)) GTEST_SKIP() << "no " << recorded;
  const TempFolder folder;
  Arguments names{"learn38.pcd", "learn33.pcd", "learn0.pcd"};
  if (kSanitized) names.resize(1);
  for (const std::string& name : names) fs::create_symlink(fs::absolute(recorded / name), folder / name);
  const std::string clouds = (folder / ".").string();
  const Outcome outcome =
      run_program({"--json", "-", "--quiet", "annotate", clouds, "--simulate", clouds, "--clicks", "3"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json mean = outcome.json().at("result").at("mean");
  EXPECT_EQ(mean.at("clouds"), names.size());
  const nlohmann::json& three = mean.at("per_label").at(2);
  std::cout << names.size() << " clouds, three clicks per label: " << three << "\n";
  EXPECT_GE(three.at("iou_mean"), 0.95);
  EXPECT_LE(three.at("errors_per_100k"), 1000.0);

  const Outcome beside = run_program({"--json", "-", "--quiet", "reproduce", "4.5", "--clouds", clouds});
  ASSERT_EQ(beside.status, 0) << beside.err;
  const nlohmann::json table = beside.json().at("result").at("tables").at(0);
  const double by_rectangles = study_row(table, "people", "rectangles").at("errors_per_100k").get<double>();
  const nlohmann::json clicks =
      study_row(table, "simulated", "control points", {{"weights", "ours"}, {"budget", "per_label"}});
  EXPECT_LT(clicks.at("errors_per_100k").at("mean").get<double>(), by_rectangles);
}

}  // namespace
}  // namespace saccade::test
