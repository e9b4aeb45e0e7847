// SPDX-License-Identifier: Apache-2.0
// saccade reproduce starts saccade-reproduce: how it is found, and that what it is told and says comes through.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include "cli/report_page.hpp"
#include "cli/run_program.hpp"

namespace saccade::test {
namespace {

/// saccade alone in a folder, with a PATH of our choice.
class LonelySaccade : public ::testing::Test {
 protected:
  void SetUp() override { fs::copy_file(saccade_program(), folder_ / "saccade"); }

  [[nodiscard]] Outcome run(const fs::path& path, const Arguments& arguments) const {
    const Arguments words{"PATH=" + path.string(), (folder_ / "saccade").string()};
    return RunningProgram{words + arguments, 0, "", "/usr/bin/env"}.finish();
  }

  TempFolder folder_;
};

TEST_F(LonelySaccade, SaysWhatIsNotInstalled) {
  const Outcome outcome = run(folder_ / "none", {"reproduce", "4.2"});
  expect_failure(outcome, 4, "reproduce", {"saccade-reproduce", folder_.path().string(), "PATH", "install"});
}

TEST_F(LonelySaccade, HelpsWithoutTheOtherProgram) {
  const Outcome outcome = run(folder_ / "none", {"reproduce", "--help"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* option : {"--quick", "--hands", "--markdown", "--noise-seeds"}) {
    EXPECT_NE(outcome.out.find(option), std::string::npos) << option;
  }
}

TEST_F(LonelySaccade, LooksOnThePath) {
  const fs::path other = folder_ / "other";
  fs::create_directory(other);
  std::ofstream{other / "saccade-reproduce"} << "#!/bin/sh\nfor word in \"$@\"; do echo \"[$word]\"; done\nexit 5\n";
  ::chmod((other / "saccade-reproduce").c_str(), 0700);
  const Outcome outcome =
      run(other, {"--seed", "7", "reproduce", "2.9", "fig-4.5", "--poses", "3", "--as-printed", "--out", "a b", "-q"});
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_EQ(outcome.out, "[--seed=7]\n[--quiet]\n[--poses=3]\n[--as-printed]\n[--out=a b]\n[2.9]\n[fig-4.5]\n");
}

TEST(ReproduceProgram, WorksAlone) {
  const std::string program = std::string{saccade_program()} + "-reproduce";
  const Outcome alone = RunningProgram{{"4.2", "--seed", "3", "--json", "-"}, 0, "", program.c_str()}.finish();
  ASSERT_EQ(alone.status, 0) << alone.err;
  expect_envelope(alone.json(), "reproduce");
  EXPECT_EQ(alone.json().at("seed"), 3);
  const nlohmann::json result = alone.json().at("result");
  EXPECT_EQ(result.at("schema"), "saccade-tables/1");
  EXPECT_EQ(result, run_program({"reproduce", "--seed", "3", "4.2", "--json", "-"}).json().at("result"));
}

TEST(ReproduceProgram, WritesTheTablesAsAPage) {
  const TempFolder folder;
  const fs::path out = folder / "tables";
  const auto reproduce = [&out](const Arguments& tables) {
    return run_program(Arguments{"reproduce", "--quiet", "--json", "-", "--out", out.string()} + tables);
  };
  const Outcome outcome = reproduce({"4.2", "3.24"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json page = report_in(out / "report.html");
  ASSERT_TRUE(page.is_object());
  EXPECT_EQ(page.at("record"), outcome.json());
  const nlohmann::json tables = page.at("record").at("result").at("tables");
  ASSERT_EQ(tables.size(), 2U);
  for (const nlohmann::json& table : tables) {  // the page reads these (web/src/report/tables.ts)
    EXPECT_NE(table.at("caption").get<std::string>().find(": "), std::string::npos);
    ASSERT_FALSE(table.at("cells").empty());
    for (const nlohmann::json& row : table.at("cells")) EXPECT_EQ(row.size(), table.at("columns").size());
  }
  ASSERT_FALSE(tables.at(1).at("drawings").empty());
  for (const nlohmann::json& drawing : tables.at(1).at("drawings")) {
    EXPECT_TRUE(fs::exists(out / drawing.get<std::string>())) << drawing;
    EXPECT_NE(page.at("files").dump().find(drawing.dump()), std::string::npos) << drawing;
  }
  EXPECT_EQ(reproduce({"4.2"}).status, 0);  // again, into its own files
  EXPECT_EQ(report_in(out / "report.html").at("record").at("result").at("tables").size(), 1U);
  std::ofstream{out / "notes.txt"} << "mine";
  expect_failure(reproduce({"4.2"}), 3, "reproduce", {out.string(), "--force"});
}

TEST(ReproduceProgram, ListsWhatThereIsAndHowLongItTakes) {
  const Outcome outcome = run_program({"reproduce", "--list", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::vector<std::string> numbers;
  const nlohmann::json known = outcome.json().at("result").at("known");
  for (const nlohmann::json& table : known) {
    numbers.push_back(table.at("table"));
    EXPECT_GT(table.at("seconds").get<double>(), 0.0);
    EXPECT_LE(table.at("quick_seconds").get<double>(), table.at("seconds").get<double>());
    EXPECT_FALSE(table.at("title").get<std::string>().empty());
  }
  for (const char* wanted :
       {"2.1", "2.17", "2.18", "2.19", "3.18", "3.19", "3.20", "3.21", "3.22", "4.9", "4.20", "4.21"}) {
    EXPECT_NE(std::find(numbers.begin(), numbers.end(), wanted), numbers.end()) << wanted;
  }
  expect_failure(run_program({"reproduce", "--list", "2.9"}), 2, "reproduce", {"--list"});
}

TEST(ReproduceProgram, AFigureHasTwoNames) {
  const Outcome outcome = run_program({"reproduce", "fig-3.24", "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("tables").at(0).at("table"), "3.24");
  expect_failure(run_program({"reproduce", "3.24", "fig-3.24"}), 2, "reproduce", {"named twice"});
}

TEST(ReproduceProgram, QuickTablesSaySo) {
  const Outcome outcome = run_program({"reproduce", "4.20", "4.21", "--quick", "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("quick"), true);
  ASSERT_EQ(result.at("tables").size(), 2U);
  for (const nlohmann::json& table : result.at("tables")) {
    EXPECT_EQ(table.at("quick"), true);
    EXPECT_NE(table.at("caption").get<std::string>().find("(quick)"), std::string::npos);
    EXPECT_NE(table.at("notes").dump().find("--quick"), std::string::npos);
    ASSERT_EQ(table.at("rows").size(), 4U);
  }
  // The clouds are annotated once for both.
  const nlohmann::json timings = outcome.json().at("timings_ms");
  EXPECT_LT(timings.at("table 4.21").get<double>(), 0.5 * timings.at("table 4.20").get<double>());
}

}  // namespace
}  // namespace saccade::test
