// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/trajectory_io.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>

#include "saccade/trial/simulated_task.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

constexpr const char* kTwoMatrices =
    "0 -1 0 0.5\n1 0 0 0.25\n0 0 1 1.5\n0 0 0 1\n\n"
    " 1 0 0 0.75\n 0 1 0 0.25\n 0 0 1 1.5\n 0 0 0 1\n";

std::string message_of(const std::string& text, HandFormat format) {
  const auto read = parse_hand_trajectory(text, format);
  return read ? "read " + std::to_string(read->report.samples) + " samples" : read.error().to_string();
}

TEST(HandTrajectoryIo, MatricesAreAHundredPerSecond) {
  const HandRecording recording = parse_hand_trajectory(kTwoMatrices, HandFormat::matrices).value();
  ASSERT_EQ(recording.trajectory.size(), 2U);
  EXPECT_EQ(recording.trajectory[0].time_s, 0.0);
  EXPECT_EQ(recording.trajectory[1].time_s, 0.01);
  EXPECT_EQ(recording.trajectory[0].position_m, Eigen::Vector3d(0.5, 0.25, 1.5));
  EXPECT_EQ(recording.trajectory[1].position_m, Eigen::Vector3d(0.75, 0.25, 1.5));
  const Eigen::Quaterniond turned{Eigen::AngleAxisd{0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()}};
  ASSERT_TRUE(recording.trajectory[0].R_world_hand.has_value());
  EXPECT_LT(recording.trajectory[0].R_world_hand->angularDistance(turned), 1e-9);
  EXPECT_EQ(recording.report.bad(), 0U);
}

TEST(HandTrajectoryIo, ARotationThatIsNoneIsLeftOutOfItsSample) {
  const HandRecording recording =
      parse_hand_trajectory("9 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", HandFormat::matrices).value();
  ASSERT_EQ(recording.trajectory.size(), 1U);
  EXPECT_FALSE(recording.trajectory[0].R_world_hand.has_value());
  const HandRecording tum = parse_hand_trajectory("1 2 3 4 0 0 0 0\n2 2 3 4 0 0 0 1\n", HandFormat::tum).value();
  ASSERT_EQ(tum.trajectory.size(), 2U);
  EXPECT_FALSE(tum.trajectory[0].R_world_hand.has_value());
  EXPECT_TRUE(tum.trajectory[1].R_world_hand.has_value());
}

TEST(HandTrajectoryIo, CsvWithAndWithoutAHeader) {
  const HandRecording plain = parse_hand_trajectory("0.0,1,2,3\n0.5, 4, 5, 6\n", HandFormat::csv).value();
  ASSERT_EQ(plain.trajectory.size(), 2U);
  EXPECT_EQ(plain.trajectory[1].time_s, 0.5);
  EXPECT_EQ(plain.trajectory[1].position_m, Eigen::Vector3d(4, 5, 6));
  const HandRecording full = parse_hand_trajectory("0.0,1,2,3,0,0,0,1\n", HandFormat::csv).value();
  EXPECT_TRUE(full.trajectory[0].R_world_hand.has_value());
  const HandRecording named =
      parse_hand_trajectory("# glove 3\nbattery,z,x,t,y\r\n90,3,1,0.0,2\r\n89,6,4,0.5,5\r\n", HandFormat::csv).value();
  ASSERT_EQ(named.trajectory.size(), 2U);
  EXPECT_EQ(named.trajectory[1].time_s, 0.5);
  EXPECT_EQ(named.trajectory[1].position_m, Eigen::Vector3d(4, 5, 6));
  EXPECT_FALSE(named.trajectory[1].R_world_hand.has_value());
  EXPECT_TRUE(parse_hand_trajectory("time,x,y,z\n", HandFormat::csv).value().trajectory.empty());
}

TEST(HandTrajectoryIo, CsvOfSpreadsheets) {
  const HandRecording marked = parse_hand_trajectory("\xEF\xBB\xBFtime,x,y,z\n0,1,2,3\n", HandFormat::csv).value();
  EXPECT_EQ(marked.trajectory.at(0).position_m, Eigen::Vector3d(1, 2, 3));
  const HandRecording plain = parse_hand_trajectory(
                                  "\xEF\xBB\xBF"
                                  "0,1,2,3\n",
                                  HandFormat::csv)
                                  .value();
  EXPECT_EQ(plain.trajectory.size(), 1U);
  const HandRecording german =
      parse_hand_trajectory("# Hand, links\ntime;x;y;z\r\n0,5;1,25;2;-3,5\r\n", HandFormat::csv).value();
  ASSERT_EQ(german.trajectory.size(), 1U);
  EXPECT_EQ(german.trajectory[0].time_s, 0.5);
  EXPECT_EQ(german.trajectory[0].position_m, Eigen::Vector3d(1.25, 2, -3.5));
}

TEST(HandTrajectoryIo, TimesInNanosecondsSayWhere) {
  const std::string message = message_of("0,1,2,3\n1700000000000000000,1,2,3\n", HandFormat::csv);
  EXPECT_TRUE(message.starts_with("line 2: ")) << message;
  EXPECT_NE(message.find("nanoseconds by 1e9"), std::string::npos) << message;
}

TEST(HandTrajectoryIo, BadSamplesAreCountedAndLeftOut) {
  const HandRecording recording =
      parse_hand_trajectory("0,0,0,0\n0.1,nan,0,0\n0.2,1,0,0\n0.2,2,0,0\n0.3,1,0,0\n", HandFormat::csv).value();
  EXPECT_EQ(recording.trajectory.size(), 3U);
  EXPECT_EQ(recording.report.not_finite, 1U);
  EXPECT_EQ(recording.report.not_increasing, 1U);
  EXPECT_EQ(recording.report.repeats, 1U);
  EXPECT_TRUE(parse_hand_trajectory("", HandFormat::matrices).value().trajectory.empty());
  EXPECT_TRUE(parse_hand_trajectory("\n# nothing\n", HandFormat::csv).value().trajectory.empty());
}

TEST(HandTrajectoryIo, WhatIsNoTrajectorySaysWhere) {
  using enum HandFormat;
  EXPECT_EQ(message_of("1 0 0 4\n0 1 0 5\n0 0 1 6\n", matrices), "line 1: this 4x4 matrix is cut");
  EXPECT_EQ(message_of("1 0 0 4\n0 1 0\n0 0 1 6\n0 0 0 1\n", matrices),
            "line 2: 4 numbers of a matrix row expected, not 3");
  EXPECT_EQ(message_of("1 0 0 4\n0 1 0 5\n0 0 1 6\n0 0 1 1\n", matrices),
            "line 4: the last row of a matrix must be 0 0 0 1");
  EXPECT_EQ(message_of("1 0 0 4\n0 1 x 5\n", matrices), "line 2: 'x' is not a number");
  EXPECT_EQ(message_of("0,1,2\n", csv), "line 1: 4 or 8 numbers expected: time,x,y,z[,qx,qy,qz,qw]");
  EXPECT_EQ(message_of("\n0,1,2,3\n1,1,2\n", csv), "line 3: 4 numbers expected as in the lines before, not 3");
  EXPECT_EQ(message_of("time,x,y\n0,1,2\n", csv), "line 1: columns time, x, y and z expected");
  EXPECT_EQ(message_of("time,x,y,z,x\n", csv), "line 1: column 'x' comes twice");
  EXPECT_EQ(message_of("time,x,y,z\n0,1,2,3\n0,1,2,oops\n", csv), "line 3: 'oops' is not a number");
  EXPECT_EQ(message_of("1 2 3 4\n", tum), "line 1: 8 numbers expected: time tx ty tz qx qy qz qw");
  EXPECT_EQ(message_of("1 2 3 4 0 0 0 1\n2 3\n", tum), "line 2: 8 numbers expected as in the lines before, not 2");
}

TEST(HandTrajectoryIo, LabelsAreThreeNumbersALine) {
  const auto labels_m = parse_hand_labels("0.78 -0.02 1.45\n\n-0.21 0.16 1.42\n").value();
  ASSERT_EQ(labels_m.size(), 2U);
  EXPECT_EQ(labels_m[1], Eigen::Vector3d(-0.21, 0.16, 1.42));
  EXPECT_TRUE(parse_hand_labels("").value().empty());
  EXPECT_EQ(parse_hand_labels("1 2\n").error().to_string(), "line 1: 3 numbers of a label expected: x y z");
  EXPECT_EQ(parse_hand_labels("1 2 3\n1 2 nan\n").error().to_string(), "line 2: the label is not finite");
}

TEST(HandTrajectoryIo, ExtensionsTellTheFormat) {
  const test::TempFolder folder;
  folder.write("a.traj", kTwoMatrices);
  folder.write("a.traj.res", "0.5 0.25 1.5\n");
  folder.write("b.csv", "0,1,2,3\n");
  folder.write("c.tum", "0 1 2 3 0 0 0 1\n");
  folder.write("d.dat", "0 1 2 3 0 0 0 1\n");
  EXPECT_EQ(read_hand_trajectory(folder / "a.traj").value().trajectory.size(), 2U);
  EXPECT_EQ(read_hand_trajectory(folder / "b.csv").value().trajectory.size(), 1U);
  EXPECT_EQ(read_hand_trajectory(folder / "c.tum").value().trajectory.size(), 1U);
  const auto unknown = read_hand_trajectory(folder / "d.dat");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Errc::invalid_argument);
  EXPECT_EQ(read_hand_trajectory(folder / "d.dat", HandFormat::tum).value().trajectory.size(), 1U);

  const LabelledTrajectory labelled = read_labelled_trajectory(folder / "a.traj").value();
  EXPECT_EQ(labelled.name, "a");
  EXPECT_EQ(labelled.labels_m.size(), 1U);
  EXPECT_EQ(read_labelled_trajectory(folder / "b.csv").error().code, Errc::not_found);
  EXPECT_EQ(read_hand_trajectory(folder / "e.traj").error().code, Errc::not_found);
  const auto wrong = read_hand_trajectory(folder / "c.tum", HandFormat::matrices);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().context, (folder / "c.tum").string() + ", line 1");
}

TEST(HandTrajectoryIo, FoldersAreSearchedByName) {
  const test::TempFolder folder;
  folder.write("b.traj", kTwoMatrices);
  folder.write("b.traj.res", "0 0 0\n");
  folder.write("inner/a.traj", kTwoMatrices);
  const auto found = find_hand_trajectories(folder.path()).value();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].filename(), "b.traj");
  EXPECT_EQ(found[1].filename(), "a.traj");
  EXPECT_EQ(find_hand_trajectories(folder / "none").error().code, Errc::not_found);
  std::filesystem::create_directory(folder / "empty");
  EXPECT_EQ(find_hand_trajectories(folder / "empty").error().code, Errc::not_found);
}

TEST(HandTrajectoryIo, WrittenCsvReadsBackToTheBit) {
  const test::TempFolder folder;
  const HandTrajectory trajectory = synthetic_task(1).trajectory;
  ASSERT_TRUE(write_hand_csv(folder / "task.csv", trajectory));
  const HandTrajectory read = read_hand_trajectory(folder / "task.csv").value().trajectory;
  ASSERT_EQ(read.size(), trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].time_s, trajectory[i].time_s);
    EXPECT_EQ(read[i].position_m, trajectory[i].position_m);
  }
}

}  // namespace
}  // namespace saccade
