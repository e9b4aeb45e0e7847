// SPDX-License-Identifier: Apache-2.0
// saccade reproduce as a user runs it, with few poses.
#include <gtest/gtest.h>

#include "cli/run_program.hpp"

namespace saccade::test {
namespace {

void expect_in(const std::string& text, const Arguments& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Reproduce, ListsTheTables) {
  const Outcome outcome = run_program({"reproduce"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("2.9 ")) << outcome.out;
  expect_in(outcome.out, {"\n2.10 "});
  const Outcome listed = run_program({"reproduce", "--json", "-"});
  expect_envelope(listed.json(), "reproduce");
  EXPECT_EQ(listed.json().at("result").at("known").size(), 2U);
}

TEST(Reproduce, RefusesWhatItDoesNotKnow) {
  expect_failure(run_program({"reproduce", "9.9"}), 2, "reproduce", {"\"9.9\"", "2.9, 2.10"});
  expect_failure(run_program({"reproduce", "2.9", "2.1"}), 2, "reproduce", {"\"2.1\"", "2.9, 2.10"});
  expect_failure(run_program({"reproduce", "2.9", "--poses", "0"}), 2, "reproduce", {"--poses"});
  expect_failure(run_program({"reproduce", "2.9", "--json", "/dev/null/no/file"}), 3, "reproduce", {"/dev/null/no"});
}

TEST(Reproduce, Table29StandsBesideTheThesis) {
  const TempFolder folder;
  const fs::path file = folder / "table.json";
  const Outcome outcome = run_program({"reproduce", "2.9", "--poses", "2", "--json", file.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_in(outcome.out,
            {"Table 2.9", "10.6", "211.5", "619.6", "| NBV-CPU-step", "2 of the 960 poses", "Core i7-4770"});
  expect_in(outcome.err, {"mapping the table", "every ray, by a fixed step"});

  const nlohmann::json document = nlohmann::json::parse(text_of(file), nullptr, false);
  expect_envelope(document, "reproduce");
  const nlohmann::json& table = document.at("result").at("tables").at(0);
  EXPECT_EQ(table.at("table"), "2.9");
  EXPECT_EQ(table.at("poses"), 2);
  EXPECT_EQ(table.at("blocked_cameras"), 0);
  const nlohmann::json& rows = table.at("rows");
  ASSERT_EQ(rows.size(), 3U);
  const double thesis_s[]{10.6, 211.5, 619.6};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rows.at(i).at("thesis_s"), thesis_s[i]);
    if (i == 1 && rows.at(i).contains("unavailable")) {  // built without PCL
      expect_in(outcome.out, {"not built (needs libpcl-dev)"});
      continue;
    }
    EXPECT_GT(rows.at(i).at("evaluate_s").get<double>(), 0.0);
    EXPECT_GT(rows.at(i).at("prepare_s").get<double>(), 0.0);
    EXPECT_LT(rows.at(i).at("gain_difference").get<double>(), i == 2 ? 0.05 : 1e-4);
    if (i == 0) continue;
    const auto rays = rows.at(i).at("rays_compared").get<std::uint64_t>();
    const auto elsewhere = rows.at(i).at("rays_other_voxel").get<std::uint64_t>();
    EXPECT_EQ(rays, 2U * 640U * 480U);
    EXPECT_LE(elsewhere, i == 1 ? rays / 10000 : rays / 2);
    EXPECT_GE(elsewhere, i == 1 ? 0 : rays / 100);
  }
}

TEST(Reproduce, Table210StandsBesideTheThesis) {
  const Outcome outcome = run_program({"reproduce", "2.10", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  expect_in(outcome.out, {"Table 2.10", "830", "836", "283", "3396", "45", "1638", "6232", ".sacmap"});
  const Outcome json = run_program({"reproduce", "2.10", "--quiet", "--json", "-"});
  ASSERT_EQ(json.status, 0) << json.err;
  expect_envelope(json.json(), "reproduce");
  const nlohmann::json table = json.json().at("result").at("tables").at(0);
  EXPECT_TRUE(table.at("equal").get<bool>());
  EXPECT_GT(table.at("bricks").get<int>(), 10000);
  const nlohmann::json& rows = table.at("rows");
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_TRUE(rows.at(0).at("ms").is_null());
  for (const std::size_t row : {1, 2, 4, 5}) EXPECT_GT(rows.at(row).at("ms").get<double>(), 0.0) << rows.at(row);
  EXPECT_EQ(rows.at(5).at("thesis_nbv_gpu_ms"), 6232);
}

TEST(Reproduce, StopsWhenInterrupted) {
  RunningProgram program{{"reproduce", "2.9"}};
  ASSERT_TRUE(program.wait_for("every ray"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace saccade::test
