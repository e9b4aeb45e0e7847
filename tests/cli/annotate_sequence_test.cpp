// SPDX-License-Identifier: Apache-2.0
// saccade annotate on sequences of clouds: poses, labels that are carried on, what does not fit.
#include <Eigen/Geometry>
#include <iomanip>

#include "cli/annotated_boxes.hpp"

namespace saccade::test {
namespace {

class AnnotateSequence : public AnnotatedBoxes {
 protected:
  void SetUp() override {
    for (std::size_t i = 0; i < kClouds; ++i) write_seen(i);
    std::ofstream kitti{folder_ / "kitti.txt"};
    std::ofstream tum{folder_ / "tum.txt"};
    for (std::size_t i = 0; i < kClouds; ++i) {
      kitti << kitti_line(i) << '\n';
      const Eigen::Quaterniond q{pose(i).rotation()};
      const Eigen::Vector3d t = pose(i).translation();
      tum << std::setprecision(12) << 0.1 * static_cast<double>(i) << ' ' << t.x() << ' ' << t.y() << ' ' << t.z()
          << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
    }
  }
  static constexpr std::size_t kClouds{3};

  static Eigen::Isometry3d pose(std::size_t i) {
    return Eigen::Translation3d{0.4 * static_cast<double>(i), -0.2 * static_cast<double>(i), 0.1} *
           Eigen::AngleAxisd{0.5 * static_cast<double>(i), Eigen::Vector3d::UnitY()};
  }
  static std::string kitti_line(std::size_t i) {
    std::ostringstream line;
    line << std::setprecision(12);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) line << (row + column > 0 ? " " : "") << pose(i).matrix()(row, column);
    }
    return line.str();
  }
  static std::string name(std::size_t i) { return "00000" + std::to_string(i) + ".csv"; }

  /// clouds/00000I.csv: the table with its boxes in the frame of cloud I, on a raster that is shifted a little; truth/
  /// has its labels.
  void write_seen(std::size_t i) const {
    fs::create_directories(folder_ / "clouds");
    fs::create_directories(folder_ / "truth");
    std::ofstream cloud{folder_ / "clouds" / name(i)};
    std::ofstream truth{folder_ / "truth" / ("00000" + std::to_string(i) + ".txt")};
    cloud << "x,y,z,r,g,b\n" << std::setprecision(9);
    for (int row = 0; row < 100; ++row) {
      for (int column = 0; column < 120; ++column) {
        const int box = row >= 30 && row < 70 && column % 40 >= 10 && column % 40 < 30 ? 1 + column / 40 : 0;
        const double shift = 0.001 * static_cast<double>(i);
        const Eigen::Vector3d world{0.005 * (column - 60) + shift, 0.005 * (row - 50) - shift, box > 0 ? 0.95 : 1.0};
        const Eigen::Vector3d p = pose(i).inverse(Eigen::Isometry) * world;
        cloud << p.x() << ',' << p.y() << ',' << p.z() << ',' << (box == 0 ? 200 : 30) << ',' << 60 * box << ",90\n";
        truth << box + 1 << '\n';
      }
    }
  }
  [[nodiscard]] std::string cloud(std::size_t i) const { return path("clouds/" + name(i)); }
  [[nodiscard]] Outcome run(const Arguments& more) const {
    return run_program(Arguments{"--json", "-", "annotate", "--max-path", "10"} + more);
  }
  [[nodiscard]] nlohmann::json result_of(const Arguments& more) const {
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.status == 0 ? outcome.json()["result"] : nlohmann::json{};
  }
  [[nodiscard]] std::string error_of(const Arguments& more, int status = 3) const {
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return outcome.err;
  }
  /// Labels of the first cloud and their names; its control points are named by index, so that its frame says nothing.
  [[nodiscard]] std::string first_labelled() const {
    std::ostringstream script;
    script << R"({"do": "labels", "labels": [{"number": 2, "name": "box", "color": "#ff8000"}]})" << '\n';
    for (const auto& [label, point] : {std::pair{1, kOnTable}, {2, 50 * 120 + 20}, {3, kOnBox2}, {4, kOnBox3}}) {
      script << R"({"do": "set", "label": )" << label << R"(, "points": [)" << point << "]}\n";
    }
    return script.str();
  }
  /// Share of the points whose label is the true one.
  [[nodiscard]] double right(const std::string& labels, std::size_t i) const {
    const auto found = read_labels(path(labels + "/" + name(i)), kPoints);
    const auto true_labels = read_labels(path("truth/00000" + std::to_string(i) + ".txt"), kPoints);
    if (!found || !true_labels) return 0.0;
    std::size_t same{0};
    for (std::size_t p = 0; p < kPoints; ++p) same += (*found)[p] == (*true_labels)[p] ? 1 : 0;
    return static_cast<double>(same) / static_cast<double>(kPoints);
  }
};

TEST_F(AnnotateSequence, LabelsAreCarriedWithThePoses) {
  fs::create_directory(path("sessions"));
  const std::string script = write("first.jsonl", first_labelled());
  for (const std::string poses : {"kitti.txt", "tum.txt"}) {
    const nlohmann::json result = result_of({path("clouds"), "--poses", path(poses), "--script", script, "--carry",
                                             "--out", path(poses + "-out"), "--boxes", path(poses + "-boxes")});
    ASSERT_EQ(result["clouds"].size(), kClouds);
    EXPECT_FALSE(result["clouds"][0].contains("carried"));
    for (std::size_t i = 0; i < kClouds; ++i) {
      EXPECT_GT(right(poses + "-out", i), 0.97) << i;
      EXPECT_EQ(result["clouds"][i]["labels"][1]["name"], "box");
      EXPECT_EQ(result["clouds"][i]["labels"][1]["color"], "#ff8000");
      const auto boxes = nlohmann::json::parse(text(poses + "-boxes/00000" + std::to_string(i) + ".json"));
      EXPECT_EQ(boxes["boxes"].size(), 4U);
    }
    EXPECT_GT(result["clouds"][1]["carried"], 11'500);
  }
  // Without poses the clouds lie elsewhere.
  const nlohmann::json lost = result_of({path("clouds"), "--sequence", "--script", script, "--carry"});
  EXPECT_LT(lost["clouds"][1].value("carried", 0), 2'000);
}

TEST_F(AnnotateSequence, EachCloudHasItsSessionAndLabelsThatAreThereStay) {
  fs::create_directory(path("sessions"));
  const std::string own = R"({"do": "paint", "label": 9, "points": [0, 1, 2]})";
  const std::string carry = R"({"do": "carry"})";
  const std::string script =
      write("all.jsonl",
            first_labelled() + R"({"cloud": "000001.csv", "do": "paint", "label": 9, "points": [0, 1, 2]})" + "\n" +
                carry + "\n" + R"({"cloud": "000002.csv", "do": "carry"})" + "\n" + R"({"do": "undo"})" + "\n");
  const Arguments sequence{cloud(0), cloud(1), cloud(2), "--poses", path("kitti.txt"), "--session", path("sessions")};
  const nlohmann::json result = result_of(sequence + Arguments{"--script", script, "--out", path("out")});
  EXPECT_EQ(names_in(path("sessions")), (std::vector<std::string>{"000000.sacann", "000001.sacann", "000002.sacann"}));
  const auto second = read_labels(path("out/000001.csv"), kPoints);
  ASSERT_TRUE(second);
  EXPECT_EQ((std::vector<std::uint32_t>{second->begin(), second->begin() + 4}),
            (std::vector<std::uint32_t>{9, 9, 9, 1}));
  EXPECT_EQ(result["clouds"][2]["labelled"], 0) << "a carry is one action, which undo takes back";
  EXPECT_EQ(result["clouds"][2]["labels"][0]["name"], "box");

  // The sessions give the same again, and there is nothing more to carry into the second.
  const nlohmann::json again = result_of(sequence);
  for (std::size_t i = 0; i < kClouds; ++i) EXPECT_EQ(again["clouds"][i]["labels"], result["clouds"][i]["labels"]);
  const nlohmann::json carried =
      result_of(sequence + Arguments{"--carry", "--boxes", path("k"), "--boxes-as", "kitti"});
  EXPECT_EQ(carried["clouds"][1]["actions"], result["clouds"][1]["actions"]);
  EXPECT_GT(carried["clouds"][2]["carried"], 11'500);
  EXPECT_EQ(names_in(path("k")), (std::vector<std::string>{"000000.txt", "000001.txt", "000002.txt"}));
}

TEST_F(AnnotateSequence, NumberedCloudsTakeThePoseOfTheirNumber) {
  const Outcome outcome =
      run({cloud(2), cloud(1), "--poses", path("kitti.txt"), "--carry", "--script",
           write("s.jsonl", R"({"do": "paint", "label": 3, "points": [6060]})"), "--out", path("out")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("3 poses for 2 clouds"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.json()["result"]["clouds"][0]["file"], cloud(1)) << "in the order of their numbers";
  const auto labels = read_labels(path("out/000002.csv"), kPoints);
  ASSERT_TRUE(labels);
  EXPECT_EQ((*labels)[6060], 3U);
  fs::create_directory(path("many"));
  for (const char* unpadded : {"scan_10.csv", "scan_2.csv", "scan_1.csv"}) {
    fs::copy_file(cloud(0), path(std::string{"many/"} + unpadded));
  }
  const nlohmann::json result = result_of({path("many"), "--sequence", "--session", path("many")});
  EXPECT_EQ(result["clouds"][1]["file"], path("many/scan_2.csv"));
  EXPECT_EQ(result["clouds"][2]["file"], path("many/scan_10.csv"));
}

TEST_F(AnnotateSequence, WhatDoesNotFitIsSaid) {
  const std::string clicks = write("s.jsonl", first_labelled());
  const auto with_poses = [&](const std::string& poses) {
    return error_of({path("clouds"), "--poses", write("bad.txt", poses), "--script", clicks});
  };
  EXPECT_NE(with_poses(kitti_line(0) + "\n" + kitti_line(1) + "\n").find("2 poses for 3 clouds"), std::string::npos);
  EXPECT_NE(with_poses(kitti_line(0) + "\n" + kitti_line(1) + "\n1 0 0 nan 0 1 0 0 0 0 1 0\n").find("bad.txt"),
            std::string::npos);
  EXPECT_NE(with_poses("2 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n").find("rotation"),
            std::string::npos);
  EXPECT_NE(with_poses("").find("bad.txt"), std::string::npos);
  fs::copy_file(cloud(0), path("clouds/other.csv"));
  std::ofstream more{folder_ / "more.txt"};
  for (int i = 0; i < 6; ++i) more << kitti_line(0) << '\n';
  more.close();
  EXPECT_NE(error_of({path("clouds"), "--poses", path("more.txt"), "--script", clicks}).find("6 poses for 4 clouds"),
            std::string::npos);
  fs::remove(path("clouds/other.csv"));

  const auto with_lines = [&](const std::string& lines) {
    return error_of({path("clouds"), "--sequence", "--script", write("l.jsonl", lines)});
  };
  EXPECT_NE(with_lines(R"({"cloud": "x.csv", "do": "clear"})").find("line 1: there is no cloud x.csv"),
            std::string::npos)
      << with_lines(R"({"cloud": "x.csv", "do": "clear"})");
  EXPECT_NE(with_lines(R"({"cloud": "000001.csv", "do": "clear"}
{"cloud": "000000.csv", "do": "clear"})")
                .find("goes back"),
            std::string::npos);
  EXPECT_NE(with_lines(R"({"do": "carry"})").find("no cloud before"), std::string::npos);
  EXPECT_NE(with_lines(R"({"do": "carry", "spacings": 0})").find("positive"), std::string::npos);
  EXPECT_NE(with_lines(R"({"cloud": "000001.csv", "do": "carry"})").find("no point takes a label"), std::string::npos);

  EXPECT_NE(error_of({cloud(0), "--poses", path("kitti.txt"), "--script", clicks}, 2).find("several clouds"),
            std::string::npos);
  EXPECT_NE(error_of({cloud(0), "--carry", "--script", clicks}, 2).find("several clouds"), std::string::npos);
  EXPECT_NE(error_of({path("clouds"), cloud(0), "--script", clicks}, 2).find("one folder, or files"),
            std::string::npos);
  EXPECT_NE(error_of({path("clouds"), "--carry"}, 2).find("without the page"), std::string::npos);
  EXPECT_NE(error_of({cloud(0), cloud(0), "--script", clicks}).find("would share its files"), std::string::npos);
}

}  // namespace
}  // namespace saccade::test
