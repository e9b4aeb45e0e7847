// SPDX-License-Identifier: Apache-2.0
// saccade segment and score on surfels, as a user runs them: a wall of two colours with a board before it.
#include <gtest/gtest.h>

#include <cmath>

#include "cli/run_program.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade::test {
namespace {

/// 60 × 40 surfels 1 cm apart: the left half dark (label 1), the right half bright (label 2), a board 10 cm before the
/// middle of the right half (label 1 again), of the bright colour.
ColumnTable wall(bool with_surfels) {
  std::array<std::vector<float>, 3> places;
  std::vector<std::uint8_t> gray;
  std::vector<std::uint32_t> labels;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 40; ++k) {
      const bool is_board = i >= 40 && i < 50 && k >= 10 && k < 30;
      const std::array<double, 3> p{(i + 0.5) * 0.01, (k + 0.5) * 0.01, is_board ? 0.905 : 1.005};
      for (std::size_t axis = 0; axis < 3; ++axis) places[axis].push_back(static_cast<float>(p[axis]));
      gray.push_back(i < 30 ? 40 : 140);
      labels.push_back(i < 30 || is_board ? 1 : 2);
    }
  }
  ColumnTable fields;
  for (std::size_t axis = 0; axis < 3; ++axis) fields.add<float>(std::string{"xyz"}.substr(axis, 1), places[axis]);
  for (const char* name : {"red", "green", "blue"}) fields.add<std::uint8_t>(name, gray);
  if (with_surfels) {
    const std::vector<float> zeros(labels.size(), 0.0F);
    fields.add<float>("nx", zeros);
    fields.add<float>("ny", zeros);
    fields.add<float>("nz", std::vector<float>(labels.size(), -1.0F));
    fields.add<float>("radius", std::vector<float>(labels.size(), 0.008F));
  }
  fields.add<std::uint32_t>("label", labels);
  return fields;
}

class SegmentSurfels : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_ply(cloud(), wall(true))); }
  [[nodiscard]] fs::path cloud() const { return folder_ / "wall.ply"; }
  [[nodiscard]] fs::path out() const { return folder_ / "out.ply"; }
  [[nodiscard]] nlohmann::json result_of(const Arguments& more) const {
    const Outcome outcome = run_program(Arguments{"segment", cloud().string(), "--quiet", "--json", "-"} + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expect_envelope(outcome.json(), "segment");
    return outcome.json().at("result");
  }
  TempFolder folder_;
};

TEST_F(SegmentSurfels, AsPrintedIsWhatNoOptionSaysOtherwise) {
  const nlohmann::json ours = result_of({"--method", "sv-lccp"});
  EXPECT_EQ(ours.at("as_printed"), false);
  EXPECT_EQ(ours.at("parameters").at("rounds"), 5);
  EXPECT_EQ(ours.at("parameters").at("sanity"), true);
  const nlohmann::json printed = result_of({"--method", "sv-lccp", "--as-printed"});
  EXPECT_EQ(printed.at("as_printed"), true);
  EXPECT_EQ(printed.at("parameters").at("rounds"), 1);
  EXPECT_EQ(printed.at("parameters").at("sanity"), false);
  const nlohmann::json named = result_of({"--method", "sv-lccp", "--as-printed", "--rounds", "3", "--sanity"});
  EXPECT_EQ(named.at("parameters").at("rounds"), 3);
  EXPECT_EQ(named.at("parameters").at("sanity"), true);
  EXPECT_EQ(result_of({"--method", "flood-fill", "--as-printed"}).at("found"), 3) << "all its normals are known";
  expect_failure(run_program({"segment", cloud().string(), "--as-printed", "--quiet"}), 2, "segment",
                 {"--as-printed", "--method sv-lccp"});
}

TEST_F(SegmentSurfels, FloodFillFindsWhatTouchesAndLooksAlike) {
  const nlohmann::json result =
      result_of({"--method", "flood-fill", "--out", out().string(), "--picture", (folder_ / "a.png").string()});
  EXPECT_EQ(result.at("method"), "flood-fill");
  EXPECT_EQ(result.at("points"), 2400);
  EXPECT_EQ(result.at("found"), 3);
  EXPECT_EQ(result.at("radii"), "given");
  EXPECT_EQ(result.at("normals"), "given");
  EXPECT_TRUE(result.at("supervoxels").is_null());
  EXPECT_EQ(result.at("parameters").at("weights").at("normal"), 0.5);
  EXPECT_EQ(result.at("parameters").at("weights").at("color"), 1.0);
  for (const char* phase : {"surfels", "flood_fill", "saliency"}) EXPECT_GE(result.at("ms").at(phase), 0.0);
  ASSERT_EQ(result.at("segments").size(), 3U);
  EXPECT_EQ(result.at("segments").at(0).at("points"), 1200);
  EXPECT_EQ(result.at("segments").at(2).at("points"), 200);
  EXPECT_GE(read_color(folder_ / "a.png").value().width(), 1600);
  const nlohmann::json one = result_of({"--method", "flood-fill", "--threshold", "1", "--list-from", "300"});
  EXPECT_EQ(one.at("found"), 2);
  EXPECT_EQ(one.at("segments").size(), 1U);  // the board has 200
  EXPECT_EQ(result_of({"--method", "flood-fill", "--color-weight", "0"}).at("found"), 2);
  EXPECT_EQ(result_of({"--method", "flood-fill", "--radius", "0.004"}).at("found"), 2400);
  const nlohmann::json threads = result_of({"--method", "flood-fill", "--threads", "3", "--out", out().string()});
  EXPECT_EQ(threads.at("segments"), result.at("segments"));
}

TEST_F(SegmentSurfels, WhatAPlainCloudLacksIsEstimated) {
  ASSERT_TRUE(write_ply(cloud(), wall(false)));
  const nlohmann::json result = result_of({"--method", "flood-fill"});
  EXPECT_EQ(result.at("radii"), "estimated");
  EXPECT_EQ(result.at("normals"), "estimated");
  EXPECT_EQ(result.at("found"), 3);
}

TEST_F(SegmentSurfels, SvLccpKeepsColoursApart) {
  const nlohmann::json result = result_of({"--method", "sv-lccp", "--out", out().string()});
  EXPECT_EQ(result.at("parameters").at("voxel_size_m"), 0.01);
  EXPECT_EQ(result.at("parameters").at("seed_size_m"), 0.05);
  EXPECT_EQ(result.at("parameters").at("weights"), nlohmann::json({{"spatial", 0.1}, {"normal", 0.5}, {"color", 1.0}}));
  EXPECT_EQ(result.at("found"), 3);
  EXPECT_EQ(result_of({"--method", "sv-lccp", "--threshold", "1"}).at("found"), 2);
  EXPECT_EQ(result_of({"--method", "sv-lccp", "--voxel-size", "0.012"}).at("parameters").at("voxel_size_m"), 0.012);
  EXPECT_EQ(result_of({"--method", "lccp"}).at("parameters").at("voxel_size_m"), 0.0075);
}

TEST_F(SegmentSurfels, ScoreAddsBoundariesAndBce) {
  ASSERT_EQ(result_of({"--method", "flood-fill", "--out", out().string()}).at("found"), 3);
  const auto score = [&](const Arguments& more) {
    const Outcome outcome =
        run_program(Arguments{"score", out().string(), cloud().string(), "--quiet", "--json", "-"} + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result");
  };
  const nlohmann::json split = score({});
  for (const char* name : {"boundary_precision", "boundary_recall", "boundary_f"}) EXPECT_EQ(split.at(name), 1.0);
  EXPECT_EQ(split.at("bce"), 0.0);
  EXPECT_EQ(split.at("tolerance_m"), 0.02);
  EXPECT_EQ(split.at("clouds").at(0).at("true_segments"), 3);  // the board's label is the wall's, and does not touch it
  EXPECT_EQ(split.at("clouds").at(0).at("split"), true);
  EXPECT_EQ(split.at("clouds").at(0).at("boundary").at("surfels"), 80);  // the board is farther than 2 cm
  EXPECT_LT(split.at("wov"), 1.0);  // the other figures are of the labels as they are
  const nlohmann::json whole = score({"--no-split"});
  EXPECT_EQ(whole.at("clouds").at(0).at("true_segments"), 2);
  EXPECT_GT(whole.at("bce"), 0.1);
  EXPECT_EQ(whole.at("wov"), split.at("wov"));
  EXPECT_GT(score({"--tolerance", "0.2"}).at("clouds").at(0).at("boundary").at("surfels"), 80);
  const Outcome printed = run_program({"score", out().string(), cloud().string(), "--quiet"});
  EXPECT_NE(printed.out.find("BCE"), std::string::npos) << printed.out;
}

TEST_F(SegmentSurfels, ScoreWithoutPlacesHasBceAlone) {
  ColumnTable labels;
  labels.add<std::uint32_t>("label", std::vector<std::uint32_t>{1, 1, 1, 1});
  ASSERT_TRUE(write_pcd(folder_ / "truth.pcd", labels));
  ColumnTable found;
  found.add<std::uint32_t>("label", std::vector<std::uint32_t>{1, 2, 3, 4});
  ASSERT_TRUE(write_pcd(folder_ / "found.pcd", found));
  const nlohmann::json result =
      run_program({"score", (folder_ / "found.pcd").string(), (folder_ / "truth.pcd").string(), "--json", "-"})
          .json()
          .at("result");
  for (const char* name : {"boundary_precision", "boundary_recall", "boundary_f"}) {
    EXPECT_TRUE(result.at(name).is_null()) << name;
  }
  EXPECT_EQ(result.at("bce"), 0.75);
  EXPECT_EQ(result.at("clouds").at(0).at("split"), false);
}

TEST_F(SegmentSurfels, ScoreSaysWhyBoundariesAreMissing) {
  ColumnTable far;
  for (const char* name : {"x", "y", "z"}) far.add<float>(name, std::vector<float>{0.0F, 1e9F});
  far.add<std::uint32_t>("label", std::vector<std::uint32_t>{1, 2});
  ASSERT_TRUE(write_pcd(folder_ / "far.pcd", far));
  const Outcome outcome =
      run_program({"score", (folder_ / "far.pcd").string(), (folder_ / "far.pcd").string(), "--json", "-"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("boundaries are not scored"), std::string::npos) << outcome.err;
  EXPECT_TRUE(outcome.json().at("result").at("boundary_f").is_null());
  EXPECT_EQ(outcome.json().at("result").at("wov"), 1.0);
}

TEST_F(SegmentSurfels, CurvesGoOverThresholds) {
  const auto curve_of = [&](const char* method, const Arguments& more) {
    return result_of(Arguments{"--method", method, "--curve", cloud().string()} + more).at("curve");
  };
  const nlohmann::json fill = curve_of("flood-fill", {"--thresholds", "0,0.1,1"});
  ASSERT_EQ(fill.at("points").size(), 3U);
  EXPECT_EQ(fill.at("points").at(0).at("segments"), 2400);
  EXPECT_EQ(fill.at("points").at(0).at("boundary_recall"), 1.0);
  EXPECT_TRUE(fill.at("points").at(2).at("boundary_precision").is_null());  // wall and board, far apart
  EXPECT_EQ(fill.at("best_f").at("threshold"), 0.1);
  EXPECT_EQ(fill.at("best_f").at("boundary_f"), 1.0);
  EXPECT_EQ(fill.at("least_bce").at("bce"), 0.0);
  EXPECT_EQ(fill.at("area"), 1.0);
  const nlohmann::json supervoxels = curve_of("sv-lccp", {});
  EXPECT_EQ(supervoxels.at("points").size(), 25U);
  EXPECT_EQ(supervoxels.at("points").at(24).at("threshold"), 1.0);
  EXPECT_EQ(supervoxels.at("best_f").at("segments"), 3);
  const Outcome printed = run_program(
      {"segment", cloud().string(), "--method", "flood-fill", "--curve", cloud().string(), "--thresholds", "0.1"});
  EXPECT_NE(printed.out.find("greatest F 1.000 at 0.1000"), std::string::npos) << printed.out;
}

TEST_F(SegmentSurfels, BadInputIsOneLine) {
  const auto run = [&](const Arguments& more) {
    return run_program(Arguments{"segment", cloud().string(), "--quiet"} + more);
  };
  expect_failure(run({"--method", "magic"}), 2, "segment", {"--method", "flood-fill"});
  expect_failure(run({"--threshold", "1"}), 2, "segment", {"--threshold", "lccp"});
  expect_failure(run({"--method", "flood-fill", "--seed-size", "1"}), 2, "segment", {"--seed-size", "flood-fill"});
  expect_failure(run({"--method", "flood-fill", "--no-sanity"}), 2, "segment", {"--sanity", "flood-fill"});
  expect_failure(run({"--method", "flood-fill", "--threshold", "-1"}), 2, "segment", {"--threshold"});
  expect_failure(run({"--method", "sv-lccp", "--threshold", "-1"}), 2, "segment", {"--threshold"});
  expect_failure(run({"--method", "flood-fill", "--radius", "0"}), 2, "segment", {"--radius"});
  expect_failure(run({"--method", "flood-fill", "--tolerance", "1"}), 2, "segment", {"--tolerance", "--curve"});
  expect_failure(run({"--method", "sv-lccp", "--radius", "1"}), 2, "segment", {"--radius", "--curve"});
  expect_failure(run({"--curve", cloud().string()}), 2, "segment", {"--curve", "lccp"});
  expect_failure(run({"--method", "flood-fill", "--curve", cloud().string(), "--thresholds", "-1"}), 2, "segment",
                 {"--thresholds"});
  expect_failure(run({"--method", "flood-fill", "--curve", (folder_ / "none.pcd").string()}), 3, "segment",
                 {"none.pcd"});
  ColumnTable shorter;
  shorter.add<std::uint32_t>("label", std::vector<std::uint32_t>{1});
  ASSERT_TRUE(write_pcd(folder_ / "short.pcd", shorter));
  expect_failure(run({"--method", "flood-fill", "--curve", (folder_ / "short.pcd").string()}), 3, "segment",
                 {"short.pcd", "same points"});
  expect_failure(run({"--method", "flood-fill", "--curve", cloud().string(), "--out", cloud().string()}), 3, "segment",
                 {"--out"});
  ColumnTable fields = wall(true);
  for (Column& column : fields.columns) {
    if (column.name == "radius") column.set_value(7, -1.0);
  }
  ASSERT_TRUE(write_ply(cloud(), fields));
  expect_failure(run({"--method", "flood-fill"}), 3, "segment", {"wall.ply", "point 7", "radius"});
  expect_failure(run_program({"score", cloud().string(), cloud().string(), "--tolerance", "0"}), 2, "score",
                 {"--tolerance"});
}

TEST_F(SegmentSurfels, NothingToFillIsNoCrash) {
  const auto with_rows = [&](const std::vector<float>& values) {
    ColumnTable fields;
    for (const char* name : {"x", "y", "z"}) fields.add<float>(name, values);
    EXPECT_TRUE(write_ply(cloud(), fields));
    return run_program(
        {"segment", cloud().string(), "--method", "flood-fill", "--quiet", "--picture", (folder_ / "b.png").string()});
  };
  expect_failure(with_rows({}), 5, "segment", {"no points"});
  expect_failure(with_rows({std::nanf("")}), 5, "segment", {"no point with a finite place"});
  EXPECT_EQ(with_rows({0.5F}).status, 0);
  EXPECT_EQ(with_rows(std::vector<float>(3000, 0.25F)).status, 0);  // one place, many times
}

}  // namespace
}  // namespace saccade::test
