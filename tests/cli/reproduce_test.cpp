// SPDX-License-Identifier: Apache-2.0
// saccade reproduce as a user runs it, with few poses.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/run_program.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

void expect_in(const std::string& text, const Arguments& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Reproduce, ListsTheTables) {
  const Outcome outcome = run_program({"reproduce"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expect_in(outcome.out, {"2.1 ", "\n2.2 ", "\n2.6 ", "\n2.9 ", "\n2.10 ", "\n3.4 ", "\n3.5 "});
  const Outcome listed = run_program({"reproduce", "--json", "-"});
  expect_envelope(listed.json(), "reproduce");
  EXPECT_EQ(static_cast<std::ptrdiff_t>(listed.json().at("result").at("known").size()),
            std::count(outcome.out.begin(), outcome.out.end(), '\n'));
}

TEST(Reproduce, RefusesWhatItDoesNotKnow) {
  expect_failure(run_program({"reproduce", "9.9"}), 2, "reproduce", {"\"9.9\"", "2.9, 2.10"});
  expect_failure(run_program({"reproduce", "2.9", "3.6"}), 2, "reproduce", {"\"3.6\"", "2.9, 2.10"});
  expect_failure(run_program({"reproduce", "2.9", "2.10", "2.9"}), 2, "reproduce", {"2.9 is named twice"});
  expect_failure(run_program({"reproduce", "2.9", "--poses", "0"}), 2, "reproduce", {"--poses"});
  expect_failure(run_program({"reproduce", "2.9", "--json", "/dev/null/no/file"}), 3, "reproduce", {"/dev/null/no"});
}

TEST(ReproduceEvidence, UpdatesStandBesideTheThesis) {
  if (kSanitized) GTEST_SKIP() << "four updates take long under sanitizers; update_test runs them";
  const TempFolder folder;
  const Outcome outcome = run_program({"reproduce", "2.7", "2.16", "2.17", "2.18", "2.19", "2.20", "--image-width",
                                       "80", "--quiet", "--json", "-", "--out", folder.path().string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  const nlohmann::json& table = tables.at(0);
  ASSERT_EQ(table.at("rows").size(), 4U);
  for (const nlohmann::json& row : table.at("rows")) {
    EXPECT_GT(row.at("views").get<int>(), 0);
    EXPECT_GT(row.at("coverage").get<double>(), 0.5);
    EXPECT_LT(row.at("error_m").get<double>(), 0.02);
    EXPECT_GT(row.at("robot_s").get<double>(), 1.0);
    EXPECT_LT(row.at("nbv_s").get<double>(), row.at("thesis").at("nbv_s").get<double>());
    EXPECT_GT(row.at("regions").get<int>(), row.at("experiment").get<int>() - 1);
    EXPECT_EQ(row.at("method"), "ours");
    EXPECT_LT(row.at("evaluated").get<double>(), 960.0) << "those that the arm can take";
    EXPECT_EQ(row.at("min_gain"), 50.0);
  }
  EXPECT_EQ(table.at("as_printed"), false);
  EXPECT_EQ(table.at("rows").at(3).at("thesis").at("views"), 3);
  EXPECT_NE(table.at("notes").dump().find("80 pixels wide"), std::string::npos);

  EXPECT_EQ(tables.at(1).at("rows").size(), 2U) << "one hand for each experiment";
  for (const nlohmann::json& row : tables.at(1).at("rows")) {
    for (const nlohmann::json& off_m : row.at("distance_m")) EXPECT_LT(off_m.get<double>(), 0.2);
  }
  for (const std::size_t figure : {2U, 3U}) {
    const nlohmann::json& views = tables.at(figure).at("rows");
    ASSERT_EQ(views.size(), table.at("rows").at(figure == 2 ? 0 : 2).at("views").get<std::size_t>());
    for (const nlohmann::json& view : views) {
      EXPECT_LT(view.at("unknown_after").get<int>(), view.at("unknown_before").get<int>()) << view;
    }
  }
  EXPECT_EQ(tables.at(4).at("rows").size(), 4U);
  for (const nlohmann::json& row : tables.at(5).at("rows")) {
    EXPECT_LT(row.at("unknown").back().get<int>(), row.at("unknown").front().get<int>()) << row;
  }
  EXPECT_EQ(names_in(folder.path()).size(), 9U) << "four pictures, four plots and their page";
}

TEST(Reproduce, SaysWhereAsPrintedChangesNothing) {
  const Outcome outcome =
      run_program({"reproduce", "2.1", "4.7", "--as-printed", "--frames", "3", "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  expect_in(tables.at(0).at("notes").dump(), {"--as-printed: ", "eq. 2.1 to 2.3", "refuse a frame, as it did 0 times"});
  expect_in(tables.at(1).at("notes").dump(), {"--as-printed changes nothing here"});
}

/// One of these updates is in update_test.
TEST(ReproduceEvidence, UpdatesAreDoneAsPrintedWhenTheyAreToBe) {
  if (kSanitized) GTEST_SKIP() << "four updates take long under sanitizers; update_test runs one";
  const Outcome outcome =
      run_program({"reproduce", "2.8", "--as-printed", "--image-width", "80", "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  EXPECT_EQ(tables.at(0).at("as_printed"), true);
  ASSERT_EQ(tables.at(0).at("rows").size(), 4U);
  for (const nlohmann::json& row : tables.at(0).at("rows")) {
    EXPECT_EQ(row.at("method"), "gmm-as");
    EXPECT_EQ(row.at("evaluated"), 960.0) << "whatever the arm can take";
    EXPECT_EQ(row.at("gain_width_px"), 80);
    EXPECT_EQ(row.at("min_gain"), 12.5) << "50 of 160 x 120 rays";
    EXPECT_GT(row.at("views").get<int>(), 0);
    EXPECT_GT(row.at("coverage").get<double>(), 0.5);
  }
  const std::string notes = tables.at(0).at("notes").dump();
  expect_in(notes, {"every promise is believed", "eq. 2.13", "IncTh"});
  expect_in(tables.at(0).at("caption").get<std::string>(), {"as printed"});
}

TEST(Reproduce, FiltersOfDepthStandBesideTheThesis) {
  if (kSanitized)
    GTEST_SKIP() << "ninety simulated frames take long under sanitizers; shadow_doubt_test runs the filter";
  const TempFolder folder;
  const fs::path plots = folder / "plots";
  const Outcome outcome = run_program({"reproduce", "3.4", "3.5", "--quiet", "--json", "-", "--out", plots.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  ASSERT_EQ(tables.size(), 2U);

  const nlohmann::json& pipelines = tables.at(0).at("rows");
  ASSERT_EQ(pipelines.size(), 5U);
  const auto outliers = [&](std::size_t row) { return pipelines.at(row).at("outliers").get<int>(); };
  const auto measurements = [&](std::size_t row) { return pipelines.at(row).at("measurements").get<int>(); };
  EXPECT_GT(outliers(1), 200);
  EXPECT_LT(outliers(2), outliers(1));
  EXPECT_LT(outliers(3), 10);
  EXPECT_LE(outliers(4), outliers(3));  // ours lets no more through
  EXPECT_GT(measurements(1), measurements(2));
  EXPECT_GT(measurements(4), measurements(3));
  EXPECT_EQ(pipelines.at(3).at("thesis_outliers"), 182);

  const nlohmann::json& rates = tables.at(1).at("rows");
  ASSERT_EQ(rates.size(), 30U);
  for (const nlohmann::json& row : rates) {
    const double thesis = row.at("thesis").at("false_discovery_rate").get<double>();
    const double surface = row.at("surface").at("false_discovery_rate").get<double>();
    EXPECT_LE(surface, std::max(0.5 * thesis, 0.01)) << row;
    if (row.at("width_m") == 0.04 && row.at("baseline_m") == 0.14) {
      EXPECT_NEAR(thesis, row.at("printed").get<double>(), 0.16) << row;
    }
    EXPECT_GT(row.at("thesis").at("removed").get<int>(), 1000);
  }
  EXPECT_GE(tables.at(1).at("within_8_points").at("emitter_14_cm").get<int>(), 12);
  EXPECT_EQ(names_in(plots), (std::vector<std::string>{"report.html", "table-3-5.svg"}));
}

/// One run for both, with few poses.
TEST(Reproduce, TablesStandBesideTheThesis) {
  if (kSanitized) GTEST_SKIP() << "minutes under sanitizers: maps as large as the thesis'";
  const TempFolder folder;
  const fs::path file = folder / "tables.json";
  const Outcome outcome = run_program({"reproduce", "2.10", "2.9", "--poses", "2", "--json", file.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_in(outcome.err, {"mapping the table", "saving and loading", "every ray, by a fixed step"});
  const nlohmann::json document = nlohmann::json::parse(text_of(file), nullptr, false);
  expect_envelope(document, "reproduce");
  const nlohmann::json& tables = document.at("result").at("tables");
  ASSERT_EQ(tables.size(), 2U);

  expect_in(outcome.out, {"Table 2.10", " 830 ", " 836 ", " 283 ", " 3396 ", " 45 ", " 1638 ", " 6232 ", ".sacmap"});
  const nlohmann::json& overhead = tables.at(0);
  EXPECT_EQ(overhead.at("table"), "2.10");
  EXPECT_TRUE(overhead.at("equal").get<bool>());
  EXPECT_GT(overhead.at("bricks").get<int>(), 10000);
  const nlohmann::json& phases = overhead.at("rows");
  ASSERT_EQ(phases.size(), 6U);
  EXPECT_TRUE(phases.at(0).at("ms").is_null());
  for (const std::size_t row : std::vector<std::size_t>{1, 2, 4, 5}) {
    EXPECT_GT(phases.at(row).at("ms").get<double>(), 0.0) << phases.at(row);
  }
  EXPECT_EQ(phases.at(5).at("thesis_nbv_gpu_ms"), 6232);

  expect_in(outcome.out, {"Table 2.9", " 10.6 ", " 211.5 ", " 619.6 ", "2 of the 960 poses", "Core i7-4770"});
  const nlohmann::json& views = tables.at(1);
  EXPECT_EQ(views.at("table"), "2.9");
  EXPECT_EQ(views.at("poses"), 2);
  EXPECT_EQ(views.at("blocked_cameras"), 0);
  const nlohmann::json& rows = views.at("rows");
  ASSERT_EQ(rows.size(), 3U);
  const std::vector<double> thesis_s{10.6, 211.5, 619.6};
  const std::vector<double> most_gain_difference{0.0, 1e-4, 0.05};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rows.at(i).at("thesis_s"), thesis_s[i]);
    if (i == 1 && rows.at(i).contains("unavailable")) {  // built without PCL
      expect_in(outcome.out, {"not built (needs libpcl-dev)"});
      continue;
    }
    EXPECT_GT(rows.at(i).at("prepare_s").get<double>(), 0.0);
    EXPECT_GT(rows.at(i).at("s").get<double>(), rows.at(i).at("prepare_s").get<double>());
    EXPECT_GT(rows.at(i).at("cpu_s").get<double>(), 0.0);
    EXPECT_LE(rows.at(i).at("gain_difference").get<double>(), most_gain_difference[i]);
    if (i == 0) continue;
    const auto rays = rows.at(i).at("rays_compared").get<std::uint64_t>();
    const auto elsewhere = rows.at(i).at("rays_other_voxel").get<std::uint64_t>();
    EXPECT_EQ(rays, 2U * 640U * 480U);
    EXPECT_LE(elsewhere, i == 1 ? rays / 10000 : rays / 2);
    EXPECT_GE(elsewhere, i == 1 ? 0 : rays / 100);
  }
}

/// The map of Table 2.10 does not fit into the files that the program may write.
TEST(Reproduce, AFailureKeepsTheTablesBeforeIt) {
  if (kSanitized) GTEST_SKIP() << "minutes under sanitizers: maps as large as the thesis'";
  const TempFolder folder;
  const fs::path file = folder / "tables.json";
  const Arguments arguments{"--quiet", "reproduce", "2.9", "2.10", "--poses", "1", "--json", file.string()};
  const Outcome outcome = run_program(arguments, 500000);
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  expect_in(outcome.err, {"saccade reproduce: ", "map.sacmap", "cannot write"});
  expect_in(outcome.out, {"Table 2.9"});
  const nlohmann::json document = nlohmann::json::parse(text_of(file), nullptr, false);
  ASSERT_EQ(document.at("result").at("tables").size(), 1U);
  EXPECT_EQ(document.at("result").at("tables").at(0).at("table"), "2.9");
}

TEST(Reproduce, StopsWhenInterrupted) {
  RunningProgram program{{"reproduce", "2.9"}};
  ASSERT_TRUE(program.wait_for("mapping the table"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace saccade::test
