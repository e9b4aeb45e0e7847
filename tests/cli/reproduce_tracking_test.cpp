// SPDX-License-Identifier: Apache-2.0
// saccade reproduce 2.1 as a user runs it, with the first frames of the scan.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/run_program.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

constexpr int kScanFrames{6};

void expect_parts(const std::string& text, const Arguments& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

nlohmann::json row_of(const nlohmann::json& rows, int scenario, const std::string& tracking, bool depth_as_it_is) {
  for (const nlohmann::json& row : rows) {
    if (row.at("scenario") == scenario && row.at("tracking") == tracking &&
        (row.at("depth_scale") == 1.0) == depth_as_it_is) {
      return row;
    }
  }
  return {};
}

TEST(ReproduceTracking, TrackedPosesStandBesideTheRobots) {
  if (kSanitized) GTEST_SKIP() << "minutes under sanitizers: maps as large as the thesis'";
  const TempFolder folder;
  const fs::path file = folder / "tables.json";
  const fs::path plots = folder / "plots";
  const Outcome outcome = run_program(
      {"reproduce", "2.1", "--frames", std::to_string(kScanFrames), "--json", file.string(), "--out", plots.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_parts(outcome.err, {"scanning bottle", "scanning jug"});
  expect_parts(outcome.out, {"Table 2.1", "Egomotion", "Robot kinematics", " 0.031 ", " 0.040 ", " 0.005 ", " 0.006 ",
                             " 0.027 ", " 0.041 ", " 0.008 ", "Only the first"});
  const nlohmann::json document = nlohmann::json::parse(text_of(file), nullptr, false);
  expect_envelope(document, "reproduce");
  const nlohmann::json& table = document.at("result").at("tables").at(0);
  EXPECT_EQ(table.at("table"), "2.1");
  EXPECT_EQ(table.at("frames"), kScanFrames);
  const nlohmann::json& rows = table.at("rows");
  ASSERT_EQ(rows.size(), 8U);
  for (const nlohmann::json& row : rows) {
    EXPECT_EQ(row.at("frames"), kScanFrames);
    EXPECT_EQ(row.at("lost_frames"), 0) << row;
    EXPECT_FALSE(row.at("errors").empty()) << row;
    EXPECT_GT(row.at("mean_abs_m").get<double>(), 1e-4) << row;
    EXPECT_LT(row.at("mean_abs_m").get<double>(), 0.05) << row;
    EXPECT_LE(row.at("drift").at("end_m"), row.at("drift").at("max_m"));
    EXPECT_LT(row.at("drift").at("max_m").get<double>(), 0.005) << row;
    EXPECT_EQ(row.at("thesis_mean_abs_m").is_null(), row.at("depth_scale") != 1.0);
  }
  EXPECT_EQ(row_of(rows, 1, "egomotion", true).at("thesis_mean_abs_m"), 0.031);
  EXPECT_EQ(row_of(rows, 2, "robot kinematics", true).at("thesis_standard_deviation_m"), 0.008);
  // ICP on noise is never exact; the arm's own motion is, but for the calibration, which hardly shows in 0.3 s.
  EXPECT_GT(row_of(rows, 1, "egomotion", true).at("drift").at("max_m").get<double>(), 1e-5);

  EXPECT_EQ(names_in(plots),
            (std::vector<std::string>{"fig-2-12-rotation.svg", "fig-2-12-translation.svg", "report.html"}));
  expect_parts(text_of(plots / "fig-2-12-translation.svg"),
               {"<svg", "translation error, mm", "time, s", "scenario 1", "scenario 2, depth too long"});
  expect_parts(text_of(plots / "fig-2-12-rotation.svg"), {"<svg", "rotation error, °"});
}

TEST(ReproduceTracking, AFolderNeedsATableAndNoOtherFiles) {
  const TempFolder folder;
  const std::string plots = (folder / "plots").string();
  expect_failure(run_program({"reproduce", "--out", plots}), 2, "reproduce", {"--out", "name tables"});
  expect_failure(run_program({"reproduce", "2.1", "--frames", "0"}), 2, "reproduce", {"--frames"});
  EXPECT_FALSE(fs::exists(plots));
  fs::create_directories(plots);
  std::ofstream{fs::path{plots} / "notes.txt"} << "mine";
  expect_failure(run_program({"--quiet", "reproduce", "2.1", "--out", plots}), 3, "reproduce", {plots, "--force"});
}

TEST(ReproduceTracking, StopsWhenInterrupted) {
  const TempFolder folder;
  const std::string plots = (folder / "plots").string();
  RunningProgram program{{"reproduce", "2.1", "--out", plots}};
  ASSERT_TRUE(program.wait_for("scanning bottle"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(fs::exists(plots));
}

}  // namespace
}  // namespace saccade::test
