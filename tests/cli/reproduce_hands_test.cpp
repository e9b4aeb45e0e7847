// SPDX-License-Identifier: Apache-2.0
// saccade reproduce 2.2 to 2.6 as a user runs them, on made-up tasks and on the recorded hands where they are there.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "cli/run_program.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

/// A small data set laid out as the thesis': two users, three tasks of either kind; one task has a label that is
/// nowhere near the hand.
class ReproduceHands : public ::testing::Test {
 protected:
  static constexpr int kTasks{6};
  static constexpr std::size_t kLabels{10};  // 3 · 1 + 3 · 2 + 1

  void SetUp() override {
    for (int i = 0; i < kTasks; ++i) {
      const int actions = i < 3 ? 1 : 2;
      write(i < 3 ? "placements_removals" : "pick_and_place",
            "user" + std::to_string(1 + i % 2) + "_cup" + std::to_string(i),
            synthetic_task(static_cast<std::uint64_t>(i) + 10, {.actions = actions}));
    }
    std::ofstream{hands() + "/pick_and_place/user2_cup5.traj.res", std::ios::app} << "9 9 9\n";
  }
  [[nodiscard]] std::string hands() const { return (folder_ / "hands").string(); }
  [[nodiscard]] Outcome reproduce(const Arguments& tables, const Arguments& more) const {
    return run_program(Arguments{"reproduce", "--quiet"} + tables + Arguments{"--hands", hands()} + more);
  }
  [[nodiscard]] nlohmann::json tables_of(const Arguments& tables, const Arguments& more = {}) const {
    const Outcome outcome = reproduce(tables, Arguments{"--json", "-"} + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result").at("tables");
  }
  TempFolder folder_;

 private:
  void write(const std::string& kind, const std::string& name, const SyntheticTask& task) const {
    const fs::path file = fs::path{hands()} / kind / (name + ".traj");
    fs::create_directories(file.parent_path());
    std::ofstream matrices{file};
    std::ofstream labels{file.string() + ".res"};
    matrices.precision(std::numeric_limits<double>::max_digits10);
    for (const HandSample& sample : task.trajectory) {
      const Eigen::Vector3d& p = sample.position_m;
      matrices << "1 0 0 " << p.x() << "\n0 1 0 " << p.y() << "\n0 0 1 " << p.z() << "\n0 0 0 1\n\n";
    }
    for (const Eigen::Vector3d& p : task.actions_m) labels << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
};

/// The row of that algorithm, not as printed, for which `figure` is `value`.
nlohmann::json row_of(const nlohmann::json& table, const char* algorithm, const char* figure,
                      const nlohmann::json& value) {
  for (const nlohmann::json& row : table.at("rows")) {
    if (row.at("algorithm") == algorithm && !row.at("as_printed").get<bool>() && row.at(figure) == value) return row;
  }
  ADD_FAILURE() << "no row of " << algorithm << " with " << figure << " " << value;
  return nullptr;
}

TEST_F(ReproduceHands, CountsWhatAttendCounts) {
  const nlohmann::json tables = tables_of({"2.3", "2.4"}, {"--noise-seeds", "2", "--seed", "7"});
  const auto counts = [&](const std::string& method, const Arguments& conditions) {
    const Outcome outcome = run_program(
        Arguments{"attend", hands(), "--quiet", "--method", method, "--evaluate", "--json", "-"} + conditions);
    const nlohmann::json result = outcome.json().at("result");
    return std::pair{result.at("true_positives").get<int>(), result.at("false_positives").get<int>()};
  };
  const nlohmann::json slow = row_of(tables.at(0), "ZVC-like", "speed", 0.5).at("here");
  const auto [slow_found, slow_false] = counts("zvc", {"--speed", "0.5"});
  EXPECT_EQ(slow.at("true_positives"), slow_found);
  EXPECT_EQ(slow.at("false_positives"), slow_false);
  EXPECT_GT(slow_found, 0);

  const nlohmann::json noisy = row_of(tables.at(1), "ours", "noise_m", 0.025);
  EXPECT_EQ(noisy.at("seeds"), 2);
  EXPECT_EQ(noisy.at("here").at("ground_truth"), 2 * kLabels);
  const auto [found_7, false_7] = counts("ours", {"--noise-m", "0.025", "--seed", "7"});
  const auto [found_8, false_8] = counts("ours", {"--noise-m", "0.025", "--seed", "8"});
  EXPECT_EQ(noisy.at("here").at("true_positives"), found_7 + found_8);
  EXPECT_EQ(noisy.at("here").at("false_positives"), false_7 + false_8);
  EXPECT_TRUE(noisy.at("thesis").is_null());
  EXPECT_TRUE(noisy.at("difference_points").is_null());
}

TEST_F(ReproduceHands, RowsAreAboutTheirHands) {
  const nlohmann::json table = tables_of({"2.2"}).at(0);
  EXPECT_EQ(table.at("table"), "2.2");
  EXPECT_EQ(table.at("trajectories"), kTasks);
  EXPECT_EQ(table.at("users"), (std::vector<std::string>{"user1", "user2"}));
  EXPECT_EQ(table.at("ground_truth"), kLabels);
  EXPECT_EQ(table.at("mislabelled").at("labels"), 1);
  EXPECT_EQ(table.at("mislabelled").at("trajectories"), 1);
  EXPECT_DOUBLE_EQ(table.at("recall_ceiling").get<double>(), 0.9);
  ASSERT_EQ(table.at("rows").size(), 10U);

  const nlohmann::json moved = row_of(table, "ours", "tasks", "pick_and_place");
  EXPECT_EQ(moved.at("here").at("ground_truth"), 7);
  EXPECT_EQ(moved.at("sound").at("ground_truth"), 4);
  EXPECT_EQ(moved.at("users").at("user1").at("ground_truth"), 2);
  EXPECT_EQ(moved.at("users").at("user2").at("ground_truth"), 5);
  EXPECT_DOUBLE_EQ(moved.at("here").at("recall").get<double>(), 6.0 / 7.0);
  EXPECT_EQ(moved.at("sound").at("recall"), 1.0);

  const nlohmann::json placed = row_of(table, "GMM-AS", "tasks", "placements_removals");
  EXPECT_EQ(placed.at("here").at("ground_truth"), 3);
  EXPECT_DOUBLE_EQ(placed.at("thesis").at("precision").get<double>(), 0.954);
  EXPECT_NEAR(placed.at("difference_points").at("recall").get<double>(),
              100.0 * placed.at("here").at("recall").get<double>() - 95.9, 1e-9);
}

TEST_F(ReproduceHands, ThreadsMakeNoDifference) {
  if (kSanitized) GTEST_SKIP() << "takes long under sanitizers; CountsWhatAttendCounts runs the code";
  const Arguments tables{"2.2", "2.4", "2.6"};
  EXPECT_EQ(tables_of(tables, {"--noise-seeds", "1", "--threads", "1"}),
            tables_of(tables, {"--noise-seeds", "1", "--threads", "4"}));
}

TEST_F(ReproduceHands, SalienciesStandBesideTheExamples) {
  const nlohmann::json tables = tables_of({"2.5", "2.6"});
  for (const std::size_t t : {0U, 1U}) {
    const nlohmann::json& table = tables.at(t);
    EXPECT_TRUE(
        table.at("recording").get<std::string>().starts_with(t == 0 ? "placements_removals/" : "pick_and_place/"));
    EXPECT_LE(table.at("thesis_threshold_error").get<double>(), 1e-6);
    std::size_t printed{0};
    std::size_t printed_pois{0};
    for (const nlohmann::json& row : table.at("rows")) {
      if (!row.at("here").is_null() && !row.at("here").at("threshold").is_null()) {
        const double recomputed = row.at("here").at("recomputed_threshold").get<double>();
        EXPECT_NEAR(row.at("here").at("threshold").get<double>(), 2.2 / 1.5 * recomputed, 1e-9);
      }
      if (row.at("thesis").is_null()) continue;
      ++printed;
      printed_pois += row.at("thesis").at("poi").get<bool>() ? 1 : 0;
    }
    EXPECT_EQ(printed, 6 + t);
    EXPECT_EQ(printed_pois, 1 + t);
  }
}

TEST_F(ReproduceHands, MarkdownHasWhatIsOnStandardOutput) {
  const fs::path file = folder_ / "tables.md";
  for (int run = 0; run < 2; ++run) {  // the second replaces it
    const Outcome outcome =
        reproduce({"2.6", "2.2"}, {"--markdown", file.string(), "--json", (folder_ / "a").string()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    std::string text = text_of(file);
    ASSERT_TRUE(text.starts_with("# Tables of the thesis beside those of Saccade\n")) << text;
    const std::size_t first = text.find("\n## Table 2.6");
    const std::size_t second = text.find("\n## Table 2.2");
    ASSERT_NE(first, std::string::npos);
    ASSERT_NE(second, std::string::npos);
    text.erase(second + 1, 3);
    EXPECT_EQ(text.substr(first + 4), outcome.out);
    EXPECT_TRUE(fs::exists(folder_ / "a"));
  }
}

TEST_F(ReproduceHands, BadInputIsOneLine) {
  const std::string address = "https://github.com/RMonica/hand-polhemus-dataset";
  expect_failure(run_program({"reproduce", "2.9", "2.3", "--poses", "1"}), 2, "reproduce",
                 {"--hands", "Table 2.3", address});
  expect_failure(run_program({"reproduce", "2.2", "--hands", (folder_ / "none").string()}), 3, "reproduce",
                 {"none/pick_and_place", "cannot be read", address});
  const fs::path empty = folder_ / "empty";
  fs::create_directories(empty / "pick_and_place");
  expect_failure(run_program({"reproduce", "2.5", "--hands", empty.string()}), 3, "reproduce",
                 {"empty/pick_and_place", "holds no .traj file", address});
  fs::remove(hands() + "/placements_removals/user1_cup0.traj.res");
  expect_failure(reproduce({"2.2"}, {}), 3, "reproduce", {"user1_cup0.traj.res"});

  const std::string notes = folder_.write("notes.md", "notes\n").string();
  expect_failure(reproduce({"2.2"}, {"--markdown", notes}), 3, "reproduce", {"notes.md", "name another file"});
  EXPECT_EQ(text_of(notes), "notes\n");
  expect_failure(reproduce({"2.2"}, {"--markdown", "/dev/null/no/file"}), 3, "reproduce", {"/dev/null/no"});
  expect_failure(reproduce({"2.2"}, {"--markdown", "-"}), 2, "reproduce", {"--markdown", "standard output"});
  const std::string same = (folder_ / "same").string();
  expect_failure(reproduce({"2.2"}, {"--markdown", same, "--json", same}), 2, "reproduce", {"another file"});
  expect_failure(run_program({"reproduce", "--markdown", same}), 2, "reproduce", {"--markdown", "tables"});
  expect_failure(reproduce({"2.4"}, {"--noise-seeds", "0"}), 2, "reproduce", {"--noise-seeds"});
}

TEST_F(ReproduceHands, AnInterruptionKeepsTheTablesBeforeIt) {
  const fs::path file = folder_ / "tables.md";
  RunningProgram program{
      {"reproduce", "2.5", "2.4", "--noise-seeds", "1000000", "--hands", hands(), "--markdown", file.string()}};
  ASSERT_TRUE(program.wait_for("detecting hand actions"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("1 of 2 tables"), std::string::npos) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("Table 2.5")) << outcome.out;
  const std::string text = text_of(file);
  EXPECT_NE(text.find("## Table 2.5"), std::string::npos) << text;
  EXPECT_EQ(text.find("## Table 2.4"), std::string::npos) << text;
}

TEST(ReproduceRecordedHands, Table2_2IsWithinThreePointsOfTheThesis) {
  const fs::path hands = shared_data() / "hand_polhemus";
  if (!fs::exists(hands)) GTEST_SKIP() << "no " << hands;
  if (kSanitized) GTEST_SKIP() << "200 trajectories take too long under sanitizers";
  const Outcome outcome = run_program({"reproduce", "2.2", "2.6", "--hands", hands.string(), "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json tables = outcome.json().at("result").at("tables");
  EXPECT_EQ(tables.at(0).at("trajectories"), 200);
  EXPECT_EQ(tables.at(0).at("mislabelled").at("labels"), 9);
  int compared{0};
  for (const nlohmann::json& row : tables.at(0).at("rows")) {
    if (row.at("thesis").is_null() || row.at("as_printed").get<bool>()) continue;
    EXPECT_LE(std::abs(row.at("difference_points").at("precision").get<double>()), 3.0) << row;
    EXPECT_LE(std::abs(row.at("difference_points").at("recall").get<double>()), 3.0) << row;
    EXPECT_GE(row.at("sound").at("recall").get<double>(), 0.97) << row;
    ++compared;
  }
  EXPECT_EQ(compared, 4);
  EXPECT_LT(row_of(tables.at(0), "ours", "tasks", "pick_and_place").at("here").at("recall").get<double>(), 0.97);

  const nlohmann::json& example = tables.at(1);
  EXPECT_EQ(example.at("recordings"), 60);
  ASSERT_EQ(example.at("distance_to_label_m").size(), 2U);
  for (const nlohmann::json& distance_m : example.at("distance_to_label_m")) EXPECT_LT(distance_m.get<double>(), 0.05);
}

}  // namespace
}  // namespace saccade::test
