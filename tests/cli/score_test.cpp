// SPDX-License-Identifier: Apache-2.0
// saccade score as a user runs it: figures that can be worked out by hand, and clouds that do not belong together.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/run_program.hpp"
#include "saccade/io/clouds/pcd_io.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

class Score : public ::testing::Test {
 protected:
  fs::path cloud(const std::string& name, const std::vector<std::uint32_t>& labels) const {
    ColumnTable fields;
    fields.add<std::uint32_t>("label", labels);
    fs::create_directories((folder_ / name).parent_path());
    EXPECT_TRUE(write_pcd(folder_ / name, fields));
    return folder_ / name;
  }
  [[nodiscard]] static nlohmann::json result_of(const Arguments& arguments) {
    const Outcome outcome = run_program(Arguments{"score", "--quiet", "--json", "-"} + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expect_envelope(outcome.json(), "score");
    return outcome.json().at("result");
  }
  /// Segments the first recorded clouds and scores them by the commands of docs/guides/segmentation.md. Returns null
  /// where there is no cloud, or the program is sanitized.
  [[nodiscard]] nlohmann::json score_of_recorded_clouds(std::size_t at_most) const {
    const fs::path recorded = shared_data() / "mosd_labelled" / "learn";
    if (!fs::is_directory(recorded) || kSanitized) return nullptr;
    std::vector<std::string> names = names_in(recorded);
    names.resize(std::min(names.size(), at_most));
    for (const char* folder : {"predicted", "truth"}) fs::create_directories(folder_ / folder);
    for (const std::string& name : names) {
      fs::create_symlink(recorded / name, folder_ / "truth" / name);
      const Outcome outcome = run_program({"segment", (recorded / name).string(), "--transform", "--quiet", "--out",
                                           (folder_ / "predicted" / name).string()});
      EXPECT_EQ(outcome.status, 0) << outcome.err;
    }
    return result_of({(folder_ / "predicted").string(), (folder_ / "truth").string(), "--objects-from", "20"});
  }

  TempFolder folder_;
  /// Table 1 (8 points), objects 20 and 21 (4 and 2), one without a label; segments: the table and half of object 20,
  /// the rest of it, object 21 and a point that has none.
  const std::vector<std::uint32_t> truth_{1, 1, 1, 1, 1, 1, 1, 1, 20, 20, 20, 20, 21, 21, 0};
  const std::vector<std::uint32_t> found_{5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 7, 7, 9, 9, 9};
};

TEST_F(Score, IsWhatCanBeWorkedOutByHand) {
  const fs::path predicted = cloud("predicted.pcd", found_);
  const fs::path truth = cloud("truth.pcd", truth_);
  const nlohmann::json result = result_of({predicted.string(), truth.string(), "--objects-from", "20"});
  EXPECT_NEAR(result.at("fos"), 1.0 - (8.0 + 2.0 + 2.0) / 14.0, 1e-12);
  EXPECT_NEAR(result.at("fus"), (2.0 + 8.0) / 14.0, 1e-12);  // at equal overlaps the lower label is the best
  EXPECT_NEAR(result.at("wov"), (8.0 * 0.8 + 4.0 * 0.5 + 2.0 * 1.0) / 14.0, 1e-12);
  EXPECT_NEAR(result.at("wov_objects"), (4.0 * 0.5 + 2.0 * 1.0) / 6.0, 1e-12);
  ASSERT_EQ(result.at("clouds").size(), 1U);
  EXPECT_EQ(result.at("clouds").at(0).at("objects"), 2);
  EXPECT_EQ(result.at("clouds").at(0).at("points"), 14);
  const nlohmann::json all = result_of({predicted.string(), truth.string()});
  EXPECT_EQ(all.at("wov_objects"), all.at("wov"));  // every label is an object
}

TEST_F(Score, MergesTheTensOfAnObject) {
  const fs::path predicted = cloud("predicted.pcd", found_);
  const fs::path truth = cloud("truth.pcd", truth_);
  const nlohmann::json merged = result_of({predicted.string(), truth.string(), "--merge-tens"});
  EXPECT_EQ(merged.at("objects_from"), 20);
  EXPECT_NEAR(merged.at("wov"), (8.0 * 0.8 + 6.0 / 3.0) / 14.0, 1e-12);  // best of 2/14, 2/6, 2/6
  EXPECT_NEAR(merged.at("wov_objects"), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(merged.at("clouds").at(0).at("labels"), 2);
  const fs::path other = cloud("other.pcd", {1, 3, 9, 1, 1, 1, 1, 1, 25, 20, 29, 20, 30, 30, 0});
  EXPECT_EQ(result_of({predicted.string(), other.string(), "--merge-tens"}).at("clouds").at(0).at("labels"), 3);
}

TEST_F(Score, AveragesOverPairsAndFolders) {
  const fs::path predicted = cloud("predicted/a.pcd", found_);
  const fs::path truth = cloud("truth/a.pcd", truth_);
  cloud("predicted/b.pcd", truth_);
  cloud("truth/b.pcd", truth_);
  folder_.write("predicted/notes.txt", "no cloud");
  const nlohmann::json folders =
      result_of({(folder_ / "predicted").string(), (folder_ / "truth").string(), "--objects-from", "20"});
  ASSERT_EQ(folders.at("clouds").size(), 2U);
  EXPECT_EQ(folders.at("clouds").at(1).at("wov"), 1.0);
  EXPECT_NEAR(folders.at("wov"), 0.5 * (folders.at("clouds").at(0).at("wov").get<double>() + 1.0), 1e-12);
  EXPECT_NEAR(folders.at("wov_objects"), 0.5 * (4.0 / 6.0 + 1.0), 1e-12);
  const nlohmann::json pairs = result_of({predicted.string(), truth.string(), truth.string(), truth.string()});
  EXPECT_EQ(pairs.at("fos"), folders.at("fos"));
  const Outcome printed =
      run_program({"score", "--quiet", (folder_ / "predicted").string(), (folder_ / "truth").string()});
  EXPECT_NE(printed.out.find("mean of 2 clouds"), std::string::npos) << printed.out;
}

TEST_F(Score, OfRealLabelledClouds) {
  const nlohmann::json result = score_of_recorded_clouds(2);
  if (result.is_null()) GTEST_SKIP() << "no recorded clouds, or sanitizers, under which golden has one";
  EXPECT_EQ(result.at("clouds").size(), 2U);
  EXPECT_GT(result.at("wov_objects"), 0.9);
  EXPECT_GT(result.at("wov"), 0.97);
}

using ScoreEvidence = Score;

/// The measures of mOSD's clouds in docs/guides/segmentation.md, by the commands that it names.
TEST_F(ScoreEvidence, OfRealLabelledClouds) {
  const nlohmann::json result = score_of_recorded_clouds(100);
  if (result.is_null()) GTEST_SKIP() << "no recorded clouds";
  EXPECT_EQ(result.at("clouds").size(), 12U);
  EXPECT_GT(result.at("wov_objects"), 0.938);
  EXPECT_GT(result.at("wov"), 0.983);
  EXPECT_LT(result.at("fos"), 0.015);
  EXPECT_LT(result.at("fus"), 0.005);
}

TEST_F(Score, RefusesCloudsThatDoNotBelongTogether) {
  const fs::path truth = cloud("truth/a.pcd", truth_);
  const fs::path shorter = cloud("predicted/a.pcd", {1, 2, 3});
  expect_failure(run_program({"score", "--quiet", shorter.string(), truth.string()}), 3, "score",
                 {"predicted/a.pcd", "3 points", "15"});
  ColumnTable none;
  none.add<float>("x", std::vector<float>(15));
  ASSERT_TRUE(write_pcd(folder_ / "none.pcd", none));
  expect_failure(run_program({"score", "--quiet", (folder_ / "none.pcd").string(), truth.string()}), 3, "score",
                 {"none.pcd", "no field label"});
  expect_failure(run_program({"score", "--quiet", (folder_ / "missing.pcd").string(), truth.string()}), 3, "score",
                 {"missing.pcd"});
  expect_failure(run_program({"score", "--quiet", folder_.write("text.pcd", "no").string(), truth.string()}), 3,
                 "score", {"text.pcd"});
  cloud("truth/b.pcd", truth_);
  expect_failure(run_program({"score", (folder_ / "predicted").string(), (folder_ / "truth").string()}), 3, "score",
                 {"no cloud b", "predicted"});
  expect_failure(run_program({"score", (folder_ / "truth").string(), (folder_ / "predicted").string()}), 3, "score",
                 {"no cloud b"});
}

TEST_F(Score, SaysWhenThereIsNothingToScore) {
  const fs::path nothing = cloud("nothing.pcd", {0, 0, 0});
  expect_failure(run_program({"score", "--quiet", nothing.string(), nothing.string()}), 5, "score",
                 {"nothing to score"});
  const fs::path tables = cloud("tables.pcd", {1, 1, 2});
  EXPECT_TRUE(result_of({tables.string(), tables.string(), "--objects-from", "20"}).at("wov_objects").is_null());
}

TEST_F(Score, UsageErrorsAreOneLine) {
  const std::string truth = cloud("truth.pcd", truth_).string();
  expect_failure(run_program({"score", truth}), 2, "score", {"PREDICTED TRUTH"});
  expect_failure(run_program({"score", truth, truth, truth}), 2, "score", {"pairs"});
  expect_failure(run_program({"score", truth, truth, "--objects-from", "0"}), 2, "score", {"--objects-from"});
  expect_failure(run_program({"score", truth, truth, "--merge-tens", "--objects-from", "25"}), 2, "score",
                 {"multiple of 10"});
}

}  // namespace
}  // namespace saccade::test
