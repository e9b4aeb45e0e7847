// SPDX-License-Identifier: Apache-2.0
// saccade attend as a user runs it, on made-up tasks and on the recorded hands where they are there.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <regex>

#include "cli/run_program.hpp"
#include "saccade/attention/gmm_as.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

constexpr int kTasks{4};

class Attend : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < kTasks; ++i) {
      const SyntheticTask task = synthetic_task(static_cast<std::uint64_t>(i) + 10, {.actions = 2});
      ASSERT_TRUE(write_hand_csv(file(i), task.trajectory));
      std::ofstream labels{file(i).string() + ".res"};
      for (const Eigen::Vector3d& p : task.actions_m) labels << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    }
  }
  [[nodiscard]] fs::path file(int i) const { return folder_ / ("task-" + std::to_string(i) + ".csv"); }
  [[nodiscard]] Arguments attend(const Arguments& more) const {
    Arguments arguments{"attend", "--quiet"};
    for (int i = 0; i < kTasks; ++i) arguments.push_back(file(i).string());
    return arguments + more;
  }
  TempFolder folder_;
};

TEST_F(Attend, FindsWhatTheLibraryFinds) {
  const Outcome outcome = run_program(attend({"--method", "gmm-as", "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json document = outcome.json();
  expect_envelope(document, "attend");
  const nlohmann::json& result = document.at("result");
  EXPECT_EQ(result.at("method"), "gmm-as");
  EXPECT_EQ(result.at("trajectories"), kTasks);
  EXPECT_TRUE(result.at("ms_per_trajectory").at("median").is_number());
  EXPECT_FALSE(result.contains("precision"));
  ASSERT_EQ(result.at("details").size(), static_cast<std::size_t>(kTasks));
  std::size_t actions{0};
  for (int i = 0; i < kTasks; ++i) {
    const auto expected = detect_by_gmm(read_hand_trajectory(file(i)).value().trajectory).value().actions;
    const nlohmann::json& found = result.at("details").at(static_cast<std::size_t>(i)).at("actions");
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k, ++actions) {
      EXPECT_EQ(found.at(k).at("position_m").at(2).get<double>(), expected[k].position_m.z());
      EXPECT_EQ(found.at(k).at("why"), expected[k].why);
    }
  }
  EXPECT_EQ(result.at("actions"), actions);
  EXPECT_GT(actions, 0U);
}

TEST_F(Attend, PrintsActionsForPeople) {
  const Outcome outcome = run_program(attend({"--method", "zvc"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("task-0.csv: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(" samples, 10 ms apart; "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("times as slow as within 25 cm"), std::string::npos) << outcome.out;
}

TEST_F(Attend, EvaluatesAgainstLabels) {
  const Outcome outcome = run_program(attend({"--method", "zvc", "--evaluate", "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  const int found = result.at("true_positives").get<int>();
  EXPECT_EQ(result.at("ground_truth"), 2 * kTasks);
  EXPECT_EQ(result.at("false_negatives").get<int>(), 2 * kTasks - found);
  EXPECT_GE(found, 2 * kTasks - 1);
  EXPECT_DOUBLE_EQ(result.at("recall").get<double>(), found / (2.0 * kTasks));
  const int wrong = result.at("false_positives").get<int>();
  EXPECT_DOUBLE_EQ(result.at("precision").get<double>(), found / static_cast<double>(found + wrong));
  EXPECT_LT(result.at("location_error_m").at("median").get<double>(), 0.1);
  const Outcome people = run_program(attend({"--method", "zvc", "--evaluate"}));
  EXPECT_NE(people.out.find("recall"), std::string::npos) << people.out;

  const Outcome strict =
      run_program(attend({"--method", "zvc", "--evaluate", "--match-radius", "1e-6", "--json", "-"}));
  EXPECT_EQ(strict.json().at("result").at("recall"), 0.0);
  EXPECT_TRUE(strict.json().at("result").at("location_error_m").at("median").is_null());
}

TEST_F(Attend, NoiseFollowsTheSeedAndSpeedTheMultiplier) {
  const auto actions = [&](const Arguments& more) {
    return run_program(attend(Arguments{"--json", "-"} + more)).json().at("result").at("details").at(0).at("actions");
  };
  EXPECT_EQ(actions({"--noise-m", "0.01"}), actions({"--noise-m", "0.01"}));
  EXPECT_NE(actions({"--noise-m", "0.01"}), actions({"--noise-m", "0.01", "--seed", "2"}));
  const auto plain = actions({});
  const auto slow = actions({"--speed", "2"});
  ASSERT_FALSE(plain.empty());
  ASSERT_FALSE(slow.empty());
  EXPECT_NEAR(slow.at(0).at("time_s").get<double>(), 2.0 * plain.at(0).at("time_s").get<double>(), 0.3);
}

TEST_F(Attend, MislabelledTrajectoriesCanBeLeftOut) {
  std::ofstream{file(2).string() + ".res", std::ios::app} << "9 9 9\n";
  const Outcome outcome = run_program(attend({"--evaluate", "--exclude-mislabelled", "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("trajectories"), kTasks - 1);
  EXPECT_EQ(result.at("ground_truth"), 2 * (kTasks - 1));
  ASSERT_EQ(result.at("excluded").size(), 1U);
  EXPECT_EQ(result.at("excluded").at(0), file(2).string());
}

TEST_F(Attend, DrawsEveryTrajectory) {
  const fs::path out = folder_ / "out";
  const Outcome outcome = run_program(attend({"--out", out.string(), "--method", "gmm-as"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"attend.json", "trajectory-000.png", "trajectory-001.png",
                                                     "trajectory-002.png", "trajectory-003.png"}));
  EXPECT_GT(read_color(out / "trajectory-000.png").value().width(), 300);

  ASSERT_EQ(run_program(attend({"--out", out.string()})).status, 0);
  EXPECT_EQ(names_in(out).size(), 1U + 2U * kTasks);
  EXPECT_TRUE(fs::exists(out / "trajectory-003-speed.svg"));
  ASSERT_EQ(run_program(attend({"--out", out.string(), "--method", "zvc"})).status, 0);
  EXPECT_EQ(names_in(out).size(), 1U + kTasks);  // no speeds of another method
}

TEST_F(Attend, FoldersStandForTheirTrajectories) {
  folder_.write("hands/a.traj", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const Outcome outcome = run_program({"attend", (folder_ / "hands").string(), "--quiet", "--json", "-"});
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("trajectories"), 1);
  EXPECT_EQ(outcome.json().at("result").at("actions"), 0);
}

TEST_F(Attend, BadInputIsOneLine) {
  const std::string good = file(0).string();
  const std::string broken = folder_.write("broken.csv", "0,1,2,3\n0.1,1,2\n").string();
  const std::string alone = folder_.write("alone.csv", "0,1,2,3\n").string();
  fs::create_directory(folder_ / "empty");
  expect_failure(run_program({"attend", broken, "--quiet"}), 3, "attend", {"broken.csv, line 2"});
  expect_failure(run_program({"attend", (folder_ / "none.traj").string(), "--quiet"}), 3, "attend", {"none.traj"});
  expect_failure(run_program({"attend", (folder_ / "empty").string(), "--quiet"}), 3, "attend", {"no .traj file"});
  expect_failure(run_program({"attend", alone, "--evaluate", "--quiet"}), 3, "attend", {"alone.csv.res"});
  expect_failure(run_program({"attend", good, "--method", "best"}), 2, "attend", {"--method", "ours, gmm-as or zvc"});
  expect_failure(run_program({"attend", good, "--speed", "0"}), 2, "attend", {"--speed"});
  expect_failure(run_program({"attend", good, "--noise-m", "-1"}), 2, "attend", {"--noise-m"});
  expect_failure(run_program({"attend", good, "--exclude-mislabelled"}), 2, "attend", {"--evaluate"});
  expect_failure(run_program({"attend", good, "--format", "xml"}), 2, "attend", {"--format"});
  expect_failure(run_program({"attend"}), 2, "attend", {"files"});
}

TEST(AttendRecorded, TheThesisHandsGiveItsFigures) {
  const fs::path hands = shared_data() / "hand_polhemus";
  if (!fs::exists(hands)) GTEST_SKIP() << "no " << hands;
  const Outcome outcome =
      run_program({"attend", hands.string(), "--method", "zvc", "--evaluate", "--quiet", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("trajectories"), 200);
  EXPECT_EQ(result.at("ground_truth"), 260);
  EXPECT_NEAR(result.at("precision").get<double>(), 0.955, 0.03);
  EXPECT_NEAR(result.at("recall").get<double>(), 0.977, 0.03);
}

TEST_F(Attend, FindingsStayWhenThePicturesAreInterrupted) {
  Arguments many = attend({});
  for (int i = 0; i < 60; ++i) many.push_back(file(i % kTasks).string());
  const fs::path out = folder_ / "out";
  RunningProgram program{many + Arguments{"--out", out.string()}};
  ASSERT_TRUE(wait_for_file(out / "trajectory-000.png"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find(" of 64 pictures; all actions are in "), std::string::npos) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(text_of(out / "attend.json")).at("result").at("trajectories"), 64);
  EXPECT_EQ(run_program(attend({"--out", out.string(), "--no-pictures"})).status, 0);
}

TEST_F(Attend, NoticesUnitsThatNoHandHas) {
  HandTrajectory millimetres = read_hand_trajectory(file(0)).value().trajectory;
  for (HandSample& sample : millimetres) sample.position_m *= 1000.0;
  ASSERT_TRUE(write_hand_csv(folder_ / "mm.csv", millimetres));
  const Outcome outcome = run_program({"attend", (folder_ / "mm.csv").string(), "--quiet"});
  for (const char* part : {"mm.csv", "hands do not move at ", "not millimetres", "times in seconds"}) {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << outcome.err;
  }
  EXPECT_FALSE(std::regex_search(outcome.out, std::regex{"[0-9]\\.[0-9]{3}[-0-9]+\\.[0-9]{3}"})) << outcome.out;
  EXPECT_EQ(run_program(attend({})).err, "");
  const std::string stamps = folder_.write("ns.csv", "time,x,y,z\n1700000000000000000,0,0,0\n").string();
  expect_failure(run_program({"attend", stamps, "--quiet"}), 3, "attend", {"ns.csv, line 2", "nanoseconds"});
}

}  // namespace
}  // namespace saccade::test
