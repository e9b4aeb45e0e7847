// SPDX-License-Identifier: Apache-2.0
// saccade annotate as a user runs it: a simulated annotator on a made-up table with three boxes, and bad input.
#include <gtest/gtest.h>

#include <cmath>

#include "cli/run_program.hpp"
#include "saccade/io/label_input.hpp"

namespace saccade::test {
namespace {

constexpr int kLabels{4};

/// A frame of a camera that looks down on a table, 1 m away, with three boxes, each of one colour.
class Annotate : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream cloud{folder_ / "cloud.csv"};
    std::ofstream truth{folder_ / "truth.txt"};
    cloud << "x,y,z,r,g,b\n";
    for (int row = 0; row < 100; ++row) {
      for (int column = 0; column < 120; ++column) {
        const int box = row >= 30 && row < 70 && column % 40 >= 10 && column % 40 < 30 ? 1 + column / 40 : 0;
        cloud << 0.005 * (column - 60) << ',' << 0.005 * (row - 50) << ',' << (box > 0 ? 0.95 : 1.0) << ','
              << (box == 0 ? 200 : 30) << ',' << 60 * box << ",90\n";
        truth << box + 1 << '\n';
        ++points_;
      }
    }
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Arguments simulate(const Arguments& more = {}) const {
    Arguments all{"--json", "-", "annotate", path("cloud.csv"), "--simulate", path("truth.txt"), "--max-path", "10"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  TempFolder folder_;
  std::size_t points_{0};
};

TEST_F(Annotate, AFewClicksLabelAScene) {
  const Outcome outcome = run_program(simulate({"--out", path("labels.npy")}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json()["result"];
  EXPECT_EQ(result["objects"], kLabels);
  EXPECT_EQ(result["points"], points_);
  ASSERT_EQ(result["clicks"].size(), std::size_t{kLabels});  // then nothing is wrong any more
  EXPECT_EQ(result["clicks"].back()["errors"], 0);
  EXPECT_EQ(result["clicks"].back()["iou_mean"], 1.0);
  EXPECT_EQ(result["clicks"][0]["label"], 1);
  EXPECT_EQ(result["noc"]["90"], kLabels);
  for (const char* key : {"graph", "full"}) EXPECT_GT(result["ms"][key], 0.0);
  for (const char* key : {"add", "delete"}) EXPECT_GT(result["ms"][key]["median"], 0.0);
  const auto written = read_labels(folder_ / "labels.npy", points_);
  const auto truth = read_labels(folder_ / "truth.txt", points_);
  ASSERT_TRUE(written.ok() && truth.ok());
  EXPECT_EQ(*written, *truth);
}

TEST_F(Annotate, ShortPathsLeaveMuchWithoutALabel) {
  Arguments arguments = simulate();
  arguments.back() = "0.01";
  const Outcome outcome = run_program(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json()["result"];
  ASSERT_EQ(result["clicks"].size(), std::size_t{4 * kLabels});
  EXPECT_GT(result["clicks"].back()["errors"], 0);
  EXPECT_TRUE(result["noc"]["90"].is_null());
}

TEST_F(Annotate, RectanglesAreAMethodToo) {
  const Outcome outcome = run_program(simulate({"--method", "rectangle", "--clicks", "2"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json()["result"];
  ASSERT_FALSE(result["clicks"].empty());
  EXPECT_LE(result["clicks"].size(), std::size_t{2 * kLabels});
  EXPECT_LT(result["clicks"].back()["errors"], result["clicks"].front()["errors"]);
  EXPECT_FALSE(result.contains("ms"));
}

TEST_F(Annotate, LabelsInTensAreDetectedOrKept) {
  std::ofstream truth{folder_ / "truth.txt"};
  for (std::size_t i = 0; i < points_; ++i) truth << (i % 120 < 60 ? 1 + i % 3 : 20 + i % 7) << '\n';
  truth.close();
  EXPECT_EQ(run_program(simulate({"--clicks", "1"})).json()["result"]["objects"], 2);
  EXPECT_EQ(run_program(simulate({"--clicks", "1", "--tens", "keep"})).json()["result"]["objects"], 10);
}

TEST_F(Annotate, BadInputIsSaid) {
  const auto error_of = [&](const Arguments& arguments, int status) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(error_of({"annotate", path("cloud.csv")}, 2).find("--simulate"), std::string::npos);
  EXPECT_NE(error_of(simulate({"--color-weight", "-1"}), 2).find("not negative"), std::string::npos);
  EXPECT_NE(error_of(simulate({"--out", path("cloud.csv")}), 3).find("--out"), std::string::npos);
  EXPECT_NE(error_of(simulate({"--out", path("labels.jpg")}), 3).find("labels are written as"), std::string::npos);
  EXPECT_NE(error_of({"--json", path("truth.txt"), "annotate", path("cloud.csv"), "--simulate", path("truth.txt")}, 3)
                .find("--json"),
            std::string::npos);
  std::ofstream{folder_ / "empty.csv"};
  EXPECT_NE(error_of({"annotate", path("empty.csv"), "--simulate", path("truth.txt")}, 3).find("holds no points"),
            std::string::npos);
  std::ofstream{folder_ / "truth.txt"} << "1\n2\n";
  EXPECT_NE(error_of(simulate(), 3).find("truth.txt"), std::string::npos);
  std::ofstream none{folder_ / "truth.txt"};
  for (std::size_t i = 0; i < points_; ++i) none << "0\n";
  none.close();
  EXPECT_NE(error_of(simulate(), 3).find("has a label but 0"), std::string::npos);
}

}  // namespace
}  // namespace saccade::test
