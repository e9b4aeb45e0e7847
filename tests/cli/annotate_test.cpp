// SPDX-License-Identifier: Apache-2.0
// saccade annotate as a user runs it: a simulated annotator on a made-up table with three boxes, and bad input.
#include "cli/annotated_boxes.hpp"

namespace saccade::test {
namespace {

class Annotate : public AnnotatedBoxes {
 protected:
  void SetUp() override {
    AnnotatedBoxes::SetUp();
    fs::rename(path("cloud.txt"), path("truth.txt"));
  }
  std::size_t points_{kPoints};
};

TEST_F(Annotate, AFewClicksLabelAScene) {
  const Outcome outcome = run_program(simulate({"--out", path("labels.npy"), "--boxes", path("boxes.json")}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json()["result"];
  EXPECT_EQ(result["objects"], kLabels);
  EXPECT_EQ(result["points"], points_);
  ASSERT_EQ(result["clicks"].size(), std::size_t{kLabels});  // then nothing is wrong any more
  EXPECT_EQ(result["clicks"].back()["errors"], 0);
  EXPECT_EQ(result["clicks"].back()["iou_mean"], 1.0);
  EXPECT_EQ(result["clicks"][0]["label"], 1);
  EXPECT_EQ(result["noc"]["90"], kLabels);
  ASSERT_EQ(result["per_label"].size(), 4U);
  EXPECT_EQ(result["per_label"][3]["iou_mean"], 1.0);
  for (const char* key : {"graph", "full"}) EXPECT_GT(result["ms"][key], 0.0);
  for (const char* key : {"add", "delete"}) EXPECT_GT(result["ms"][key]["median"], 0.0);
  const auto written = read_labels(folder_ / "labels.npy", points_);
  const auto truth = read_labels(folder_ / "truth.txt", points_);
  ASSERT_TRUE(written.ok() && truth.ok());
  EXPECT_EQ(*written, *truth);
  const nlohmann::json boxes = nlohmann::json::parse(text("boxes.json"))["boxes"];
  ASSERT_EQ(boxes.size(), std::size_t{kLabels});
  const std::vector<double> front{0.095, 0.0, 0.195};  // twenty columns, forty rows, all at one depth
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(boxes[1]["size_m"][axis], front[axis], 1e-6);
  EXPECT_EQ(boxes[1]["points"], 800);
}

TEST_F(Annotate, BoxesAreJsonOrKitti) {
  const Outcome wrong = run_program(simulate({"--boxes", path("boxes.csv")}));
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("KITTI"), std::string::npos) << wrong.err;
  const Outcome outcome = run_program(simulate({"--boxes", path("boxes.txt")}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string lines = text("boxes.txt");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), kLabels);
}

TEST_F(Annotate, ShortPathsLeaveMuchWithoutALabel) {
  const Outcome outcome = run_program(
      {"--json", "-", "annotate", path("cloud.csv"), "--simulate", path("truth.txt"), "--max-path", "0.01"});
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

TEST_F(Annotate, ManyLabelsAreCountedButNotAllPrinted) {
  std::ofstream script{folder_ / "many.jsonl"};
  constexpr int kMany{45};
  for (int label = 1; label <= kMany; ++label) {
    script << "{\"do\": \"set\", \"label\": " << label << ", \"points\": [" << 10 * label << "]}\n";
  }
  script.close();
  const Arguments command{"annotate", path("cloud.csv"), "--script", path("many.jsonl"), "--out", path("many.npy")};
  const Outcome text = run_program(command);
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("\n        40 "), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find("\n        41 "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("... and 5 more"), std::string::npos) << text.out;
  const Outcome document = run_program(command + Arguments{"--json", "-"});
  ASSERT_EQ(document.status, 0) << document.err;
  EXPECT_EQ(document.json()["result"]["labels"].size(), std::size_t{kMany});
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
  EXPECT_NE(error_of({"annotate", path("cloud.csv"), "--picture", path("a.png")}, 2).find("--simulate"),
            std::string::npos);
  EXPECT_NE(
      error_of({"annotate", path("cloud.csv"), "--script", path("cloud.csv"), "--clicks", "3"}, 2).find("--simulate"),
      std::string::npos);
  EXPECT_NE(error_of(simulate({"--session", path("a")}), 2).find("--session"), std::string::npos);
  EXPECT_NE(error_of(simulate({"--color-weight", "-1"}), 2).find("not negative"), std::string::npos);
  EXPECT_NE(error_of(simulate({"--out", path("cloud.csv")}), 3).find("--out"), std::string::npos);
  EXPECT_NE(error_of(simulate({"--out", path("labels.jpg")}), 3).find("labels are written as"), std::string::npos);
  EXPECT_NE(error_of({"--json", path("truth.txt"), "annotate", path("cloud.csv"), "--simulate", path("truth.txt")}, 3)
                .find("truth.txt: holds something other than a result"),
            std::string::npos);
  EXPECT_NE(error_of({"--json", path("a.npy"), "annotate", path("cloud.csv"), "--simulate", path("truth.txt"), "--out",
                      path("a.npy")},
                     3)
                .find("--json"),
            std::string::npos);
  std::ofstream{folder_ / "empty.csv"};
  EXPECT_NE(error_of({"annotate", path("empty.csv"), "--simulate", path("truth.txt")}, 3).find("is empty"),
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
