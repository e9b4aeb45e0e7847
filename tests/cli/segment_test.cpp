// SPDX-License-Identifier: Apache-2.0
// saccade segment as a user runs it, on a made-up table with a box and a ball, and on what is no cloud.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "cli/report_page.hpp"
#include "cli/run_program.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade::test {
namespace {

/// A table at z = 0 with a box on it and a ball that hovers, with normals.
ColumnTable made_table() {
  std::array<std::vector<float>, 6> columns;
  std::vector<std::uint16_t> intensity;
  const auto add = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    for (const int axis : {0, 1, 2}) {
      columns[static_cast<std::size_t>(axis)].push_back(static_cast<float>(p[axis]));
      columns[static_cast<std::size_t>(axis) + 3].push_back(static_cast<float>(normal[axis]));
    }
    intensity.push_back(static_cast<std::uint16_t>(columns[0].size()));
  };
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (int i = -60; i <= 60; ++i) {
    for (int k = -40; k <= 40; ++k) {
      if (std::abs(i) > 10 || std::abs(k) > 8) add({0.005 * i, 0.005 * k, 0.0}, up);
    }
  }
  for (int i = -10; i <= 10; ++i) {
    for (int k = -8; k <= 8; ++k) {
      add({0.005 * i, 0.005 * k, 0.1}, up);
      if (std::abs(i) < 10 && std::abs(k) < 8) continue;
      const Eigen::Vector3d out =
          std::abs(i) == 10 ? Eigen::Vector3d{0.1 * i, 0.0, 0.0} : Eigen::Vector3d{0.0, 0.125 * k, 0.0};
      for (int l = 1; l < 20; ++l) add({0.005 * i, 0.005 * k, 0.005 * l}, out);
    }
  }
  constexpr double kRadius_m{0.04};
  for (int i = 0; i < 1200; ++i) {
    const double height = 1.0 - 2.0 * (i + 0.5) / 1200.0;
    const double turn = 2.399963 * i;
    const double r = std::sqrt(1.0 - height * height);
    const Eigen::Vector3d normal{r * std::cos(turn), r * std::sin(turn), height};
    add(Eigen::Vector3d{0.2, 0.12, 0.1} + kRadius_m * normal, normal);
  }
  add({std::nan(""), 0.0, 0.0}, up);
  ColumnTable fields;
  constexpr std::array<const char*, 6> kNames{"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  for (std::size_t i = 0; i < kNames.size(); ++i) fields.add<float>(kNames[i], columns[i]);
  fields.add<std::uint16_t>("intensity", intensity);
  return fields;
}

class Segment : public ::testing::Test {
 protected:
  void SetUp() override {
    fields_ = made_table();
    ASSERT_TRUE(write_pcd(cloud(), fields_));
  }
  [[nodiscard]] fs::path cloud() const { return folder_ / "table.pcd"; }
  [[nodiscard]] fs::path out() const { return folder_ / "labels.pcd"; }
  /// Several supervoxels to the box and the ball.
  [[nodiscard]] Arguments segment(const Arguments& more = {}) const {
    return Arguments{"segment", cloud().string(), "--quiet", "--seed-size", "0.02"} + more;
  }
  TempFolder folder_;
  ColumnTable fields_;
};

TEST_F(Segment, LabelsACloudAndSaysHowSalientItsPartsAre) {
  const Outcome outcome = run_program(segment(
      {"--method", "lccp", "--out", out().string(), "--json", "-", "--picture", (folder_ / "picture.png").string()}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_envelope(outcome.json(), "segment");
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("rows"), fields_.rows);
  EXPECT_EQ(result.at("points"), fields_.rows - 1);
  EXPECT_GT(result.at("supervoxels").get<int>(), 50);
  for (const char* phase : {"supervoxels", "lccp", "saliency"}) EXPECT_GT(result.at("ms").at(phase).get<double>(), 0.0);
  ASSERT_GE(result.at("segments").size(), 3U);

  const ColumnTable written = read_pcd(out()).value().table;
  ASSERT_EQ(written.columns.size(), fields_.columns.size() + 1);
  for (std::size_t i = 0; i < fields_.columns.size(); ++i) EXPECT_EQ(written.columns[i], fields_.columns[i]);
  const std::vector<std::uint32_t> labels = written.find("label")->values<std::uint32_t>();
  EXPECT_EQ(labels.back(), 0U);                          // no point
  EXPECT_NE(labels.front(), labels[labels.size() - 2]);  // table, ball

  std::size_t points{0};
  for (std::size_t s = 0; s < result.at("segments").size(); ++s) {
    const nlohmann::json& segment = result.at("segments").at(s);
    EXPECT_EQ(segment.at("id"), s + 1);
    EXPECT_EQ(segment.at("points"), std::count(labels.begin(), labels.end(), s + 1));
    points += segment.at("points").get<std::size_t>();
    EXPECT_NEAR(segment.at("saliency").get<double>(),
                segment.at("roundness").get<double>() * segment.at("isolation").get<double>(), 1e-12);
  }
  EXPECT_EQ(points, fields_.rows - 1);
  const auto of_ball = result.at("segments").at(labels[labels.size() - 2] - 1);
  EXPECT_GT(of_ball.at("saliency").get<double>(), 0.9);
  EXPECT_NE(of_ball.at("why").get<std::string>().find("roundness "), std::string::npos);
  EXPECT_LT(result.at("segments").at(labels.front() - 1).at("saliency").get<double>(), 0.2);
  EXPECT_GE(read_color(folder_ / "picture.png").value().width(), 1600);
}

TEST_F(Segment, IsTheSameForEveryThreadCountAndEncoding) {
  const auto labels_of = [&](const fs::path& input, const char* threads) {
    const Outcome outcome =
        run_program({"segment", input.string(), "--out", out().string(), "--quiet", "--threads", threads});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_pcd(out()).value().table;
  };
  const ColumnTable one = labels_of(cloud(), "1");
  EXPECT_EQ(one, labels_of(cloud(), "3"));
  ASSERT_TRUE(write_pcd(folder_ / "packed.pcd", fields_, PcdFormat::binary_compressed));
  EXPECT_EQ(one, labels_of(folder_ / "packed.pcd", "2"));
  ASSERT_TRUE(write_pcd(folder_ / "text.pcd", fields_, PcdFormat::ascii));
  EXPECT_EQ(*one.find("label"), *labels_of(folder_ / "text.pcd", "2").find("label"));
  ASSERT_TRUE(write_ply(folder_ / "table.ply", fields_));
  EXPECT_EQ(one, labels_of(folder_ / "table.ply", "2"));
}

TEST_F(Segment, PrintsTheMostSalientFirst) {
  const Outcome outcome = run_program(segment());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* part :
       {"points ", "supervoxels ", "segments ", "ms LCCP", "longest  saliency  roundness  isolation  why"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << outcome.out;
  }
  const std::string first = outcome.out.substr(outcome.out.find("why\n") + 4, 60);
  EXPECT_NE(first.find("0.9"), std::string::npos) << first;
}

TEST_F(Segment, ListsSpecksLast) {
  constexpr std::array<float, 3> kHalf_m{0.0003F, 0.00028F, 0.00026F};  // six points, alone in the air
  ColumnTable with_speck;
  for (std::size_t k = 0; k < 6; ++k) {
    std::vector<float> values = fields_.columns[k].values<float>();
    for (std::size_t i = 0; i < 6; ++i) {
      const float off_m = i / 2 != k ? 0.0F : (i % 2 == 0 ? kHalf_m[k] : -kHalf_m[k]);
      values.push_back(k < 3 ? 0.5F + off_m : (k == 5 ? 1.0F : 0.0F));
    }
    with_speck.add<float>(fields_.columns[k].name, values);
  }
  ASSERT_TRUE(write_pcd(cloud(), with_speck));
  const Outcome outcome = run_program(segment({"--json", (folder_ / "specks.json").string()}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t speck_row = outcome.out.find("0.60 mm");
  const std::size_t table_row = outcome.out.find("60.0 cm");
  ASSERT_NE(speck_row, std::string::npos) << outcome.out;
  EXPECT_LT(table_row, speck_row) << outcome.out;
  EXPECT_NE(outcome.out.find("1 segment no longer than 3.0 cm comes last"), std::string::npos) << outcome.out;
  const nlohmann::json document = nlohmann::json::parse(text_of(folder_ / "specks.json"));
  const nlohmann::json& segments = document.at("result").at("segments");
  const auto speck =
      std::find_if(segments.begin(), segments.end(), [](const nlohmann::json& each) { return each.at("points") == 6; });
  ASSERT_NE(speck, segments.end());
  EXPECT_GT(speck->at("saliency").get<double>(), 0.8);  // it is the order that differs
}

TEST_F(Segment, TakesEveryHeuristicAndBlends) {
  const auto most_salient = [&](const Arguments& more) {
    const Outcome outcome = run_program(segment({"--json", "-"}) + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json segments = outcome.json().at("result").at("segments");
    return *std::max_element(segments.begin(), segments.end(), [](const nlohmann::json& a, const nlohmann::json& b) {
      return a.at("saliency").get<double>() < b.at("saliency").get<double>();
    });
  };
  const auto length = [](const nlohmann::json& segment) {
    return *std::max_element(segment.at("sizes_m").begin(), segment.at("sizes_m").end());
  };
  EXPECT_GT(length(most_salient({"--saliency", "rough-first"})).get<double>(), 0.5);
  EXPECT_NEAR(length(most_salient({"--saliency", "size", "--size", "0.08"})).get<double>(), 0.08, 0.01);
  EXPECT_GT(most_salient({"--saliency", "height"}).at("mean_m").at(2).get<double>(), 0.08);
  const nlohmann::json chosen = most_salient({"--saliency", "region", "--sphere", "0.2,0.12,0.1,0.05"});
  EXPECT_EQ(chosen.at("saliency"), 1.0);
  EXPECT_NEAR(chosen.at("mean_m").at(0).get<double>(), 0.2, 0.01);
  EXPECT_NEAR(most_salient({"--saliency", "region", "--box", "0.15,0.05,0.05,0.25,0.2,0.2"}).at("mean_m").at(0), 0.2,
              0.01);
  const nlohmann::json blended = most_salient({"--saliency", "objectness=3,height=1"});
  EXPECT_NE(blended.at("why").get<std::string>().find("75 % objectness"), std::string::npos);
  EXPECT_GT(most_salient({"--saliency", "isolation", "--isolation-distance", "0.001"}).at("saliency"), 0.99);
}

TEST_F(Segment, SaysWhenVoxelsAreTooSmall) {
  const auto notes_with = [&](const char* voxel_size_m) {
    return run_program({"segment", cloud().string(), "--voxel-size", voxel_size_m, "--seed-size", "0.02"}).err;
  };
  EXPECT_NE(notes_with("0.0001").find("--voxel-size"), std::string::npos);
  EXPECT_EQ(notes_with("0.0075").find("--voxel-size"), std::string::npos);
}

TEST_F(Segment, KeepsAnEarlierLabelAndSaysSo) {
  fields_.add<std::uint32_t>("label", std::vector<std::uint32_t>(fields_.rows, 77));
  ASSERT_TRUE(write_pcd(cloud(), fields_));
  const Outcome outcome = run_program({"segment", cloud().string(), "--out", out().string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("label_input"), std::string::npos) << outcome.err;
  const ColumnTable written = read_pcd(out()).value().table;
  EXPECT_EQ(written.find("label_input")->bytes, fields_.find("label")->bytes);
  EXPECT_NE(written.find("label")->bytes, fields_.find("label")->bytes);
}

TEST_F(Segment, SegmentsTheSurfaceOfAMap) {
  make_sample(folder_ / "frames", 2);
  ASSERT_EQ(run_program(fuse(folder_ / "frames", folder_ / "run", {"--tracking", "forced"})).status, 0);
  const auto with_out = [&](const fs::path& file) {
    return run_program({"segment", (folder_ / "run" / "map.sacmap").string(), "--voxel-size", "0.015", "--seed-size",
                        "0.05", "--quiet", "--json", "-", "--picture", (folder_ / "map.png").string(), "--out",
                        file.string()});
  };
  const Outcome outcome = with_out(out());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("kind"), "map");
  EXPECT_EQ(result.at("normals"), "tsdf gradient");
  EXPECT_GT(result.at("segments").size(), 1U);
  const ColumnTable written = read_pcd(out()).value().table;
  EXPECT_EQ(written.rows, result.at("points").get<std::size_t>());
  EXPECT_NE(written.find("normal_x"), nullptr);
  EXPECT_GE(read_color(folder_ / "map.png").value().width(), 1600);
}

TEST_F(Segment, NothingToSegmentIsNoCrash) {
  const auto with_rows = [&](const std::vector<float>& values) {
    ColumnTable fields;
    for (const char* name : {"x", "y", "z"}) fields.add<float>(name, values);
    EXPECT_TRUE(write_pcd(cloud(), fields));
    return run_program(segment({"--out", out().string(), "--picture", (folder_ / "none.png").string(), "--json",
                                (folder_ / "none.json").string()}));
  };
  expect_failure(with_rows({}), 5, "segment", {"table.pcd", "no points"});
  expect_failure(with_rows({std::nanf(""), std::nanf("")}), 5, "segment", {"no point with a finite place"});
  EXPECT_EQ(read_pcd(out()).value().table.find("label")->values<std::uint32_t>(), (std::vector<std::uint32_t>{0, 0}));
  const nlohmann::json nothing = nlohmann::json::parse(text_of(folder_ / "none.json")).at("result");
  EXPECT_EQ(nothing.at("points"), 0);
  EXPECT_TRUE(nothing.at("segments").empty());
  EXPECT_FALSE(fs::exists(folder_ / "none.png"));
  expect_failure(with_rows({0.5F, 1e9F}), 3, "segment", {"table.pcd", "point 1", "larger voxels"});
  const Outcome one = with_rows({0.5F});
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "none.json")).at("result").at("segments").at(0).at("points"), 1);
  EXPECT_EQ(with_rows(std::vector<float>(300, 0.25F)).status, 0);  // one place, many times
  const Outcome before = run_program({"segment", cloud().string(), "--quiet", "--transform"});
  EXPECT_EQ(before.status, 0) << before.err;

  // With a camera, what lies behind it is no point.
  const auto from_camera = [&](const std::vector<float>& z) {
    ColumnTable fields;
    for (const char* name : {"x", "y"}) fields.add<float>(name, std::vector<float>(z.size(), 0.1F));
    fields.add<float>("z", z);
    EXPECT_TRUE(write_pcd(cloud(), fields));
    return run_program({"segment", cloud().string(), "--quiet", "--transform", "--json", "-"});
  };
  const Outcome behind = from_camera({-1.0F, -1.2F});
  EXPECT_EQ(behind.status, 5) << behind.err;
  EXPECT_NE(behind.err.find("in front of the camera"), std::string::npos) << behind.err;
  EXPECT_EQ(from_camera({-1.0F, 1.2F}).json().at("result").at("points"), 1);
}

TEST_F(Segment, WhatIsNoCloudIsBadInput) {
  const auto of_file = [&](const std::string& name, const std::string& text) {
    return run_program({"segment", folder_.write(name, text).string(), "--quiet", "--out", out().string()});
  };
  expect_failure(of_file("notes.txt", "no cloud"), 3, "segment", {"notes.txt", "no point cloud"});
  expect_failure(
      of_file("flat.pcd", "VERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2\n"), 3,
      "segment", {"flat.pcd", "x, y and z"});
  expect_failure(of_file("cut.pcd", text_of(cloud()).substr(0, 500)), 3, "segment", {"cut.pcd", "ends"});
  expect_failure(of_file("no.sacmap", "no map"), 3, "segment", {"no.sacmap"});
  expect_failure(run_program({"segment", (folder_ / "missing.pcd").string(), "--quiet"}), 3, "segment",
                 {"missing.pcd"});
  expect_failure(run_program({"segment", folder_.path().string(), "--quiet"}), 3, "segment", {folder_.path().string()});
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Segment, NeverReplacesItsInput) {
  const std::string before = text_of(cloud());
  expect_failure(run_program(segment({"--out", cloud().string()})), 3, "segment", {"table.pcd", "--out"});
  fs::create_symlink(cloud(), folder_ / "link.pcd");
  expect_failure(run_program(segment({"--out", (folder_ / "link.pcd").string()})), 3, "segment", {"--out"});
  fs::create_symlink(cloud(), folder_ / "link.png");
  expect_failure(run_program(segment({"--picture", (folder_ / "link.png").string()})), 3, "segment", {"--picture"});
  expect_failure(run_program(segment({"--out", out().string(), "--json", out().string()})), 3, "segment", {"--json"});
  EXPECT_TRUE(text_of(cloud()) == before);
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Segment, AFolderTakesEverythingAndAPage) {
  const fs::path run = folder_ / "run";
  const Outcome outcome = run_program(segment({"--out", run.string(), "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(names_in(run), (std::vector<std::string>{"report.html", "segment.json", "segments.ply", "segments.png"}));
  const nlohmann::json page = report_in(run / "report.html");
  ASSERT_TRUE(page.is_object());
  EXPECT_EQ(page.at("record"), outcome.json());
  EXPECT_EQ(page.at("record"), nlohmann::json::parse(text_of(run / "segment.json")));
  EXPECT_NE(page.at("files").dump().find("segments.png"), std::string::npos);
  EXPECT_EQ(read_ply(run / "segments.ply").value().find("vertex")->table.rows, fields_.rows);
  EXPECT_EQ(page.at("record").at("result").at("found"), page.at("record").at("result").at("segments").size());

  // A second run replaces the first, its picture included, and nothing else.
  const Outcome again = run_program(segment({"--out", run.string(), "--no-pictures"}));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find((run / "report.html").string()), std::string::npos) << again.out;
  EXPECT_EQ(names_in(run), (std::vector<std::string>{"report.html", "segment.json", "segments.ply"}));
  EXPECT_EQ(report_in(run / "report.html").at("files").dump().find(".png"), std::string::npos);
  const fs::path other = folder_ / "other";
  fs::create_directory(other);
  std::ofstream{other / "notes.txt"} << "mine";
  expect_failure(run_program(segment({"--out", other.string()})), 3, "segment", {other.string(), "--force"});
  EXPECT_EQ(run_program(segment({"--out", other.string(), "--force"})).status, 0);
  EXPECT_EQ(text_of(other / "notes.txt"), "mine");
}

TEST_F(Segment, AFolderNeverLosesTheInput) {
  const fs::path run = folder_ / "run";
  ASSERT_EQ(run_program(segment({"--out", run.string()})).status, 0);
  const std::string before = text_of(run / "segments.ply");
  const Outcome outcome = run_program({"segment", (run / "segments.ply").string(), "--out", run.string(), "--quiet"});
  expect_failure(outcome, 3, "segment", {"segments.ply", "--out"});
  EXPECT_TRUE(text_of(run / "segments.ply") == before);
  EXPECT_EQ(names_in(run).size(), 4U);
}

TEST_F(Segment, UsageErrorsAreOneLine) {
  expect_failure(run_program({"segment"}), 2, "segment", {"input is required"});
  expect_failure(run_program(segment({"--method", "slic"})), 2, "segment", {"--method", "lccp"});
  expect_failure(run_program(segment({"--out", "labels.txt"})), 2, "segment", {".pcd or .ply", "folder"});
  expect_failure(run_program(segment({"--no-pictures"})), 2, "segment", {"--no-pictures", "--out"});
  expect_failure(run_program(segment({"--out", "labels.ply", "--no-pictures"})), 2, "segment", {"--no-pictures"});
  expect_failure(run_program(segment({"--picture", "picture.jpg"})), 2, "segment", {"--picture", ".png"});
  expect_failure(run_program(segment({"--voxel-size", "0"})), 2, "segment", {"--voxel-size"});
  expect_failure(run_program(segment({"--voxel-size", "0.1"})), 2, "segment", {"--seed-size"});
  expect_failure(run_program(segment({"--concavity", "-1"})), 2, "segment", {"--concavity"});
  expect_failure(run_program(segment({"--isolation-distance", "0"})), 2, "segment", {"--isolation-distance"});
  expect_failure(run_program(segment({"--saliency", "beauty"})), 2, "segment", {"beauty", "objectness"});
  expect_failure(run_program(segment({"--saliency", "size=-1"})), 2, "segment", {"weight of size"});
  expect_failure(run_program(segment({"--saliency", "region"})), 2, "segment", {"--box or --sphere"});
  expect_failure(run_program(segment({"--sphere", "0,0,0,1"})), 2, "segment", {"--saliency region"});
  expect_failure(run_program({"segment", "some.sacmap", "--transform"}), 2, "segment", {"--transform", "world"});
  expect_failure(run_program(segment({"--min-size", "-1"})), 2, "segment", {"--min-size"});
}

TEST_F(Segment, AFullDiskLeavesNoHalfFile) {
  const Outcome outcome = run_program(segment({"--out", out().string()}), 4096);
  expect_failure(outcome, 3, "segment", {"labels.pcd", "cannot write"});
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"table.pcd"}));
}

TEST_F(Segment, StopsWhenInterrupted) {
  ColumnTable large;
  for (const char* name : {"x", "y", "z"}) {
    std::vector<float> values;
    for (int i = 0; i < 1000000; ++i) {
      const int place = name[0] == 'x' ? i % 1000 : (name[0] == 'y' ? i / 1000 : 0);
      values.push_back(0.002F * static_cast<float>(place));
    }
    large.add<float>(name, values);
  }
  ASSERT_TRUE(write_pcd(cloud(), large));
  RunningProgram program{{"segment", cloud().string(), "--out", out().string(), "--voxel-size", "0.004"}};
  ASSERT_TRUE(program.wait_for("supervoxels"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted; no result was written"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Segment, VoxelsAreThoseOfTheMapUnlessGiven) {
  make_sample(folder_ / "frames", 2);
  const Arguments coarse{"fuse",    (folder_ / "frames").string(),
                         "--out",   (folder_ / "run").string(),
                         "--quiet", "--voxel-size",
                         "0.02",    "--tracking",
                         "forced",  "--no-pictures"};
  ASSERT_EQ(run_program(coarse).status, 0);
  const Arguments of_map{"segment", (folder_ / "run" / "map.sacmap").string(), "--json", "-"};
  const Outcome outcome = run_program(of_map);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("parameters").at("voxel_size_m"), 0.02);
  EXPECT_DOUBLE_EQ(result.at("parameters").at("seed_size_m").get<double>(), 0.08);
  EXPECT_LT(20 * result.at("segments").size(), result.at("points").get<std::size_t>());
  EXPECT_EQ(outcome.err.find("touch"), std::string::npos) << outcome.err;
  const Outcome fine = run_program(of_map + Arguments{"--voxel-size", "0.005"});
  EXPECT_NE(fine.err.find("those of the map 0.02 m"), std::string::npos) << fine.err;
  EXPECT_EQ(fine.err.find("coordinates metres"), std::string::npos) << fine.err;
  expect_failure(run_program(of_map + Arguments{"--seed-size", "0.01", "--quiet"}), 3, "segment", {"--seed-size"});
}

}  // namespace
}  // namespace saccade::test
