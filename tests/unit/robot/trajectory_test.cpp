// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/motion_planner.hpp"

#include <gtest/gtest.h>

#include "support/sliding_arms.hpp"
#include "support/trajectory_checks.hpp"

namespace saccade {
namespace {

using test::joints;

/// A joint that does 2 rad/s and 10 rad/s², and one that does 1 and 2.
ArmModel two_joints() {
  ArmDescription description = test::plane_arm({JointKind::revolute, JointKind::revolute}).description();
  description.joints[0].limits = {-3.0, 3.0, 2.0, 10.0};
  description.joints[1].limits = {-3.0, 3.0, 1.0, 2.0};
  return ArmModel::create(description).value();
}

PieceIsFree always(bool free) {
  return [free](const Trajectory::Piece&) { return free; };
}

TEST(Trajectory, OneJointSpeedsUpCruisesAndBrakes) {
  const ArmModel arm = two_joints();
  const JointPath path{joints({0.0, 0.0}), joints({1.0, 0.0})};
  const Trajectory trajectory = parametrise(arm, path);
  // 0.2 s to 2 rad/s over 0.2 rad, 0.6 rad in 0.3 s, and 0.2 s to brake.
  EXPECT_NEAR(trajectory.duration_s(), 0.7, 1e-12);
  ASSERT_EQ(trajectory.pieces().size(), 3U);
  EXPECT_NEAR(trajectory.at(0.1).q[0], 0.05, 1e-12);
  EXPECT_NEAR(trajectory.at(0.1).speed[0], 1.0, 1e-12);
  EXPECT_NEAR(trajectory.at(0.35).q[0], 0.5, 1e-12);
  EXPECT_NEAR(trajectory.at(0.35).speed[0], 2.0, 1e-12);
  EXPECT_NEAR(trajectory.at(0.6).q[0], 0.95, 1e-12);
  EXPECT_NEAR(trajectory.at(0.6).speed[0], 1.0, 1e-12);
  EXPECT_EQ(trajectory.at(0.35).q[1], 0.0);
  test::expect_sound(arm, path, trajectory);
}

TEST(Trajectory, AShortLineNeverReachesItsSpeed) {
  const ArmModel arm = two_joints();
  const Trajectory trajectory = parametrise(arm, {joints({0.0, 0.0}), joints({0.1, 0.0})});
  EXPECT_NEAR(trajectory.duration_s(), 2.0 * std::sqrt(0.1 / 10.0), 1e-12);
  ASSERT_GE(trajectory.pieces().size(), 2U);
  EXPECT_NEAR(trajectory.at(0.5 * trajectory.duration_s()).speed[0], 1.0, 1e-12);
}

TEST(Trajectory, TheSlowestJointSetsThePace) {
  const ArmModel arm = two_joints();
  const JointPath path{joints({0.5, 0.0}), joints({1.5, 1.0})};
  const Trajectory trajectory = parametrise(arm, path);
  EXPECT_NEAR(trajectory.duration_s(), 0.5 + 0.5 + 0.5, 1e-12);  // the second joint, alone
  for (double t_s = 0.0; t_s < 1.5; t_s += 0.01) {
    const Trajectory::State state = trajectory.at(t_s);
    EXPECT_NEAR(state.q[0] - 0.5, state.q[1], 1e-12);
    EXPECT_NEAR(state.speed[0], state.speed[1], 1e-12);
  }
  test::expect_sound(arm, path, trajectory);
}

TEST(Trajectory, StandsStillBeforeAndAfter) {
  const ArmModel arm = two_joints();
  const Trajectory trajectory = parametrise(arm, {joints({0.0, 0.2}), joints({1.0, -0.2})});
  for (const double t_s : {-1.0, 0.0}) {
    EXPECT_TRUE(trajectory.at(t_s).q.isApprox(joints({0.0, 0.2})));
    EXPECT_TRUE(trajectory.at(t_s).speed.isZero());
  }
  for (const double t_s : {trajectory.duration_s(), trajectory.duration_s() + 5.0}) {
    EXPECT_LT((trajectory.at(t_s).q - joints({1.0, -0.2})).norm(), 1e-12);
    EXPECT_LT(trajectory.at(t_s).speed.norm(), 1e-9);
  }
}

TEST(Trajectory, NothingOrOneConfigurationIsNoMotion) {
  const ArmModel arm = two_joints();
  EXPECT_TRUE(parametrise(arm, {}).empty());
  EXPECT_EQ(parametrise(arm, {}).duration_s(), 0.0);
  EXPECT_EQ(Trajectory{}.duration_s(), 0.0);
  EXPECT_THROW(static_cast<void>(Trajectory{}.at(0.0)), ContractViolation);
  const Configuration q = joints({0.3, -0.4});
  for (const JointPath& path : {JointPath{q}, JointPath{q, q}, JointPath{q, q, q}}) {
    const Trajectory still = parametrise(arm, path, always(true));
    ASSERT_EQ(still.pieces().size(), 1U);
    EXPECT_EQ(still.duration_s(), 0.0);
    EXPECT_EQ(still.end(), q);
    EXPECT_EQ(still.at(1.0).q, q);
    EXPECT_TRUE(still.at(0.0).speed.isZero());
    EXPECT_EQ(rest_to_rest_s(arm, path), 0.0);
  }
}

TEST(Trajectory, ConfigurationsThatComeTwiceArePassedOver) {
  const ArmModel arm = two_joints();
  const Configuration a = joints({0.0, 0.0});
  const Configuration b = joints({1.0, 0.3});
  const Configuration c = joints({0.4, -0.8});
  for (const bool turning : {false, true}) {
    const Trajectory once = parametrise(arm, {a, b, c}, always(turning));
    const Trajectory often = parametrise(arm, {a, a, b, b, b, c, c}, always(turning));
    EXPECT_EQ(often.pieces().size(), once.pieces().size());
    EXPECT_EQ(often.duration_s(), once.duration_s());
    test::expect_sound(arm, {a, b, c}, often);
  }
}

TEST(Trajectory, StepsOfRoundingAreNoLines) {
  const ArmModel arm = two_joints();
  for (const double tiny : {5e-324, 1e-310, 1e-300, 1e-200, 1e-100, 1e-20, 1e-16}) {
    const Configuration a = joints({0.0, 0.0});
    const Configuration b = joints({tiny, -tiny});
    const Configuration c = joints({1.0, 0.5});
    const JointPath paths[]{{a, b}, {a, b, c}, {a, b, a, c}, {c, a, b}};
    for (const JointPath& path : paths) {
      for (const bool turning : {false, true}) {
        const Trajectory trajectory = parametrise(arm, path, always(turning));
        test::expect_sound(arm, path, trajectory);
        ASSERT_TRUE(std::isfinite(rest_to_rest_s(arm, path))) << tiny;
        EXPECT_NEAR(rest_to_rest_s(arm, path), parametrise(arm, path).duration_s(), 1e-7) << tiny;
      }
    }
  }
}

TEST(Trajectory, StopsInEveryCornerUnlessItMayTurn) {
  const ArmModel arm = two_joints();
  const JointPath path{joints({0.0, 0.0}), joints({1.0, 0.2}), joints({1.2, 1.0}), joints({0.3, 1.1})};
  for (const Trajectory& stopping : {parametrise(arm, path), parametrise(arm, path, always(false))}) {
    test::expect_sound(arm, path, stopping);
    double t_s = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      EXPECT_LT((stopping.at(t_s).q - path[i]).norm(), test::kMet) << i;
      EXPECT_LT(stopping.at(t_s).speed.norm(), test::kMet) << i;
      if (i + 1 < path.size()) t_s += rest_to_rest_s(arm, path[i], path[i + 1]);
    }
    EXPECT_NEAR(stopping.duration_s(), rest_to_rest_s(arm, path), 1e-12);
    EXPECT_NEAR(t_s, stopping.duration_s(), 1e-12);
  }
  const Trajectory turning = parametrise(arm, path, always(true));
  test::expect_sound(arm, path, turning);
  EXPECT_LT(turning.duration_s(), 0.95 * rest_to_rest_s(arm, path));
  for (double t_s = 0.05; t_s < turning.duration_s() - 0.05; t_s += 1e-3) {
    EXPECT_GT(turning.at(t_s).speed.norm(), 1e-3) << t_s;  // it never stops between
  }
}

TEST(Trajectory, AsksAboutTheTurnsThatItTakes) {
  const ArmModel arm = two_joints();
  const JointPath path{joints({0.0, 0.0}), joints({1.0, 0.0}), joints({1.0, 1.0}), joints({0.0, 1.0})};
  // A parabola may stay within 0.1 of its corner: it cuts at most half of the shares asked for.
  std::vector<Trajectory::Piece> allowed;
  const Trajectory turning = parametrise(arm, path, [&](const Trajectory::Piece& piece) {
    const Configuration middle = piece.q + 0.5 * piece.duration_s * piece.speed +
                                 0.125 * piece.duration_s * piece.duration_s * piece.acceleration;
    const bool near = std::min((middle - path[1]).norm(), (middle - path[2]).norm()) < 0.1;
    if (near) allowed.push_back(piece);
    return near;
  });
  test::expect_sound(arm, path, turning);
  ASSERT_EQ(allowed.size(), 2U);
  for (const Trajectory::Piece& asked : allowed) {
    const bool used =
        std::any_of(turning.pieces().begin(), turning.pieces().end(), [&](const Trajectory::Piece& piece) {
          return (piece.q - asked.q).norm() < test::kMet && piece.duration_s >= asked.duration_s - test::kMet;
        });
    EXPECT_TRUE(used);
  }
  double farthest = 0.0;
  for (double t_s = 0.0; t_s < turning.duration_s(); t_s += 1e-3) {
    farthest = std::max(farthest, test::on_path(turning.at(t_s).q, path).away);
  }
  EXPECT_LT(farthest, 0.1 + 1e-6);
  EXPECT_GT(farthest, 0.01);
}

TEST(Trajectory, ThereAndBackNeverPassesTheCorner) {
  const ArmModel arm = two_joints();
  const Configuration a = joints({0.0, 0.0});
  const Configuration b = joints({1.0, 0.5});
  for (const bool turning : {false, true}) {
    const Trajectory trajectory = parametrise(arm, {a, b, a}, always(turning));
    test::expect_sound(arm, {a, b, a}, trajectory);
    double farthest = 0.0;
    for (double t_s = 0.0; t_s <= trajectory.duration_s(); t_s += 1e-3) {
      const Configuration q = trajectory.at(t_s).q;
      EXPECT_LT(test::distance_from_line(q, a, b), 1e-9);
      farthest = std::max(farthest, q[0]);
    }
    EXPECT_GT(farthest, 0.5);
    EXPECT_LE(farthest, 1.0 + 1e-12);
  }
}

}  // namespace
}  // namespace saccade
