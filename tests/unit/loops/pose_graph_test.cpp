// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/pose_graph.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace saccade {
namespace {

using Eigen::Vector3d;

Pose pose_of(const Vector3d& at, double yaw_rad = 0.0) {
  Pose T{Pose::Identity()};
  T.translation() = at;
  T.rotate(Eigen::AngleAxisd{yaw_rad, Vector3d::UnitZ()});
  return T;
}

/// A way around a square, back to the start: node 4 is node 0 again, but odometry has it `drift` away.
PoseGraph square(const Vector3d& drift) {
  const Pose T_step = pose_of({1.0, 0.0, 0.0}, 0.5 * std::numbers::pi);
  PoseGraph graph;
  graph.T_world_node.push_back(Pose::Identity());
  for (std::size_t i = 0; i < 4; ++i) {
    const Pose T_before = graph.T_world_node.back();
    Pose T_drifted = T_before * T_step;  // a quarter of the drift with every step, in the world's directions
    T_drifted.translation() += 0.25 * drift;
    graph.edges.push_back({i, i + 1, T_before.inverse() * T_drifted, 1e-6, 0.01, false});
    graph.T_world_node.push_back(T_drifted);
  }
  return graph;
}

class PoseGraphs : public testing::Test {
  void SetUp() override {
    if (pose_graph_solver().empty()) GTEST_SKIP() << "this build lacks libceres-dev";
  }
};

TEST_F(PoseGraphs, DriftAroundASquareIsSpreadEvenly) {
  // Turns are certain, so the problem is linear: of the drift d, n equal steps of variance s² and a closure of variance
  // c² leave d c² / (n s² + c²) at the end, and every step takes an equal share of what is corrected.
  const Vector3d drift{0.08, -0.04, 0.02};
  PoseGraph graph = square(drift);
  const double c = 0.005;
  graph.edges.push_back({0, 4, Pose::Identity(), 1e-6, c, false});
  const auto solved = solve_pose_graph(graph);
  ASSERT_TRUE(solved) << solved.error().to_string();
  EXPECT_LT(solved->final_cost, solved->initial_cost);
  const Vector3d left = drift * (c * c / (4.0 * 0.01 * 0.01 + c * c));
  for (std::size_t i = 0; i < 5; ++i) {
    const Vector3d corrected = graph.T_world_node[i].translation() - static_cast<double>(i) / 4.0 * (drift - left);
    EXPECT_LT((solved->T_world_node[i].translation() - corrected).norm(), 1e-6) << i;
  }
}

TEST_F(PoseGraphs, TurnsThatDriftAreClosed) {
  PoseGraph graph = square(Vector3d::Zero());
  Pose T_world_node{Pose::Identity()};
  for (std::size_t i = 0; i < 4; ++i) {  // every turn is one degree too far
    graph.edges[i].T_from_to.rotate(Eigen::AngleAxisd{std::numbers::pi / 180.0, Vector3d::UnitZ()});
    graph.edges[i].rotation_sigma_rad = 0.01;
    T_world_node = T_world_node * graph.edges[i].T_from_to;
    graph.T_world_node[i + 1] = T_world_node;
  }
  const double before = graph.T_world_node[4].translation().norm();
  ASSERT_GT(before, 0.03);
  graph.edges.push_back({0, 4, Pose::Identity(), 1e-4, 1e-4, true});
  const auto solved = solve_pose_graph(graph);
  ASSERT_TRUE(solved);
  EXPECT_TRUE(solved->dropped.empty());
  EXPECT_LT(solved->T_world_node[4].translation().norm(), 0.001);
  EXPECT_LT(rotation_angle_rad(solved->T_world_node[4]), 0.001);
  for (std::size_t i = 1; i < 4; ++i) {
    const double turn = rotation_angle_rad(solved->T_world_node[i - 1].inverse() * solved->T_world_node[i]);
    EXPECT_NEAR(turn, 0.5 * std::numbers::pi, 0.003) << i;
  }
}

TEST_F(PoseGraphs, AWrongClosureIsDropped) {
  PoseGraph graph = square({0.01, 0.0, 0.0});
  graph.edges.push_back({0, 4, Pose::Identity(), 0.001, 0.001, true});
  const auto without = solve_pose_graph(graph);
  graph.edges.push_back({0, 3, pose_of({0.5, 0.5, 0.0}), 0.001, 0.001, true});  // truly at (0, 1)
  const auto with = solve_pose_graph(graph);
  ASSERT_TRUE(without && with);
  EXPECT_TRUE(without->dropped.empty());
  EXPECT_EQ(with->dropped, std::vector<std::size_t>{5});
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LT((with->T_world_node[i].translation() - without->T_world_node[i].translation()).norm(), 1e-9) << i;
  }
}

TEST_F(PoseGraphs, EqualInputGivesEqualBits) {
  PoseGraph graph = square({0.08, -0.04, 0.02});
  graph.edges.push_back({0, 4, Pose::Identity(), 0.001, 0.001, true});
  const auto a = solve_pose_graph(graph);
  const auto b = solve_pose_graph(graph);
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(a->T_world_node[i].matrix(), b->T_world_node[i].matrix());
}

TEST(PoseGraphInput, IsChecked) {
  EXPECT_EQ(solve_pose_graph({}).error().code, Errc::invalid_argument);
  PoseGraph graph = square(Vector3d::Zero());
  graph.edges.pop_back();
  graph.edges.push_back({0, 4, Pose::Identity(), 0.001, 0.001, true});
  EXPECT_NE(solve_pose_graph(graph).error().message.find("closures alone"), std::string::npos);
  graph = square(Vector3d::Zero());
  graph.edges[1].to = 9;
  EXPECT_EQ(solve_pose_graph(graph).error().code, Errc::invalid_argument);
  graph = square(Vector3d::Zero());
  graph.edges[1].translation_sigma_m = 0.0;
  EXPECT_EQ(solve_pose_graph(graph).error().code, Errc::invalid_argument);
  if (!pose_graph_solver().empty()) return;
  EXPECT_EQ(solve_pose_graph(square(Vector3d::Zero())).error().code, Errc::unavailable);
}

}  // namespace
}  // namespace saccade
