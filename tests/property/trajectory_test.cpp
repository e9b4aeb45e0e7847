// SPDX-License-Identifier: Apache-2.0
// Random paths of arms with one to twelve joints: what parametrise makes of them, beside an integration by small steps.
#include "saccade/arm/motion_planner.hpp"

#include <gtest/gtest.h>

#include "support/effort.hpp"
#include "support/sliding_arms.hpp"
#include "support/trajectory_checks.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kTrajectorySeed{51};

double within(double low, double high, std::mt19937_64& random) {
  return std::uniform_real_distribution<double>{low, high}(random);
}

/// Joints of every kind, speeds and accelerations over three orders of magnitude.
ArmModel random_arm(std::mt19937_64& random) {
  std::vector<JointKind> kinds(1 + random() % kMaxJoints);
  for (JointKind& kind : kinds) kind = static_cast<JointKind>(random() % 3);
  ArmDescription description = test::plane_arm(kinds, 0.1).description();
  for (ArmJoint& joint : description.joints) {
    joint.limits.speed = std::pow(10.0, within(-1.5, 1.5, random));
    joint.limits.acceleration = std::pow(10.0, within(-1.5, 1.5, random));
  }
  return ArmModel::create(description).value();
}

/// Long and short lines, joints that rest, configurations that come twice, ways that go back.
JointPath random_path(const ArmModel& arm, std::mt19937_64& random) {
  JointPath path{test::random_configuration(arm, random)};
  const std::size_t size = 2 + random() % 7;
  while (path.size() < size) {
    const Configuration& last = path.back();
    const std::uint64_t kind = random() % 8;
    if (kind == 0) {
      path.push_back(Configuration{last});
    } else if (kind == 1 && path.size() > 1) {
      path.push_back(Configuration{path[path.size() - 2]});
    } else if (kind == 2) {
      Configuration q = last;
      q[static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(arm.dof()))] += within(-0.5, 0.5, random);
      path.push_back(q);
    } else {
      const double share = kind < 5 ? std::pow(10.0, within(-9.0, 0.0, random)) : 1.0;
      path.push_back(last + share * (test::random_configuration(arm, random) - last));
    }
  }
  return path;
}

JointPath without_repeats(const JointPath& path) {
  JointPath corners;
  for (const Configuration& q : path) {
    if (corners.empty() || corners.back() != q) corners.push_back(q);
  }
  return corners;
}

struct Case {
  ArmModel arm;
  JointPath path;
};

Case random_case(int i) {
  std::mt19937_64 random{kTrajectorySeed + static_cast<std::uint64_t>(i)};
  const ArmModel arm = random_arm(random);
  return {arm, random_path(arm, random)};
}

PieceIsFree coin(std::uint64_t seed, unsigned odds) {
  return [random = std::mt19937_64{seed}, odds](const Trajectory::Piece&) mutable { return random() % odds != 0; };
}

TEST(TrajectoryProperty, MotionsAreContinuousAndWithinLimits) {
  const int cases = test::scaled_cases(3000);
  int ran = 0;
  int turned = 0;
  for (int i = 0; i < cases; ++i, ++ran) {
    const Case one = random_case(i);
    SCOPED_TRACE("seed " + std::to_string(kTrajectorySeed) + ", case " + std::to_string(i));
    const Trajectory stopping = parametrise(one.arm, one.path);
    test::expect_sound(one.arm, one.path, stopping);
    ASSERT_NEAR(stopping.duration_s(), rest_to_rest_s(one.arm, one.path), 1e-9 * (1.0 + stopping.duration_s()));
    const Trajectory free = parametrise(one.arm, one.path, coin(0, 1U << 31U));
    test::expect_sound(one.arm, one.path, free);
    ASSERT_LE(free.duration_s(), stopping.duration_s() + 1e-12);
    const Trajectory some = parametrise(one.arm, one.path, coin(static_cast<std::uint64_t>(i), 2));
    test::expect_sound(one.arm, one.path, some);
    ASSERT_LE(some.duration_s(), stopping.duration_s() + 1e-12);
    turned += free.duration_s() < stopping.duration_s() ? 1 : 0;
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(ran, cases);
  EXPECT_GT(turned, cases / 2);
}

TEST(TrajectoryProperty, EveryCornerIsMetWhenStopping) {
  const int cases = test::scaled_cases(1000);
  for (int i = 0; i < cases; ++i) {
    const Case one = random_case(i);
    const Trajectory stopping = parametrise(one.arm, one.path);
    double t_s = 0.0;
    for (std::size_t k = 0; k < one.path.size(); ++k) {
      if (k > 0) t_s += rest_to_rest_s(one.arm, one.path[k - 1], one.path[k]);
      const Trajectory::State state = stopping.at(t_s);
      ASSERT_LT((state.q - one.path[k]).lpNorm<Eigen::Infinity>(), 1e-9) << "case " << i << ", corner " << k;
      ASSERT_LT(state.speed.lpNorm<Eigen::Infinity>(), 1e-6) << "case " << i << ", corner " << k;
    }
  }
}

/// Between the middles of neighbouring lines the arm stays in the triangle that they enclose with the corner; so it
/// deviates by at most half of the shorter one, and passes every line's middle.
TEST(TrajectoryProperty, TurnsStayWithinHalfOfTheLinesBeside) {
  const int cases = test::scaled_cases(400);
  for (int i = 0; i < cases; ++i) {
    const Case one = random_case(i);
    const JointPath corners = without_repeats(one.path);
    const Trajectory turning = parametrise(one.arm, one.path, coin(0, 1U << 31U));
    for (std::size_t line = 0; line + 1 < corners.size(); ++line) {
      const Configuration middle = 0.5 * (corners[line] + corners[line + 1]);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Trajectory::Piece& piece : turning.pieces()) {
        const double d = piece.duration_s;
        const Configuration end = piece.q + d * piece.speed + 0.5 * d * d * piece.acceleration;
        nearest = std::min(nearest, test::distance_from_line(middle, piece.q, end));
      }
      ASSERT_LT(nearest, 1e-9) << "case " << i << ", line " << line;
    }
    if (corners.size() < 2) continue;
    for (int sample = 0; sample <= 500; ++sample) {
      const double t_s = turning.duration_s() * sample / 500.0;
      const Configuration q = turning.at(t_s).q;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t line = 0; line + 1 < corners.size(); ++line) {
        const double half = 0.5 * (corners[line + 1] - corners[line]).norm();
        least = std::min(least, test::distance_from_line(q, corners[line], corners[line + 1]) - half);
      }
      ASSERT_LE(least, 1e-9) << "case " << i << " at " << t_s << " s";
    }
  }
}

/// Adds up accelerations by small steps, piece by piece.
TEST(TrajectoryProperty, StatesAreThoseOfSummedAccelerations) {
  const int cases = test::scaled_cases(200);
  for (int i = 0; i < cases; ++i) {
    const Case one = random_case(i);
    const Trajectory turning = parametrise(one.arm, one.path, coin(static_cast<std::uint64_t>(i), 3));
    Configuration q = one.path.front();
    Configuration speed = Configuration::Zero(q.size());
    double t_s = 0.0;
    for (const Trajectory::Piece& piece : turning.pieces()) {
      constexpr int kStepsOfPiece{50};
      const double dt_s = piece.duration_s / kStepsOfPiece;
      for (int step = 0; step < kStepsOfPiece; ++step) {
        q += dt_s * (speed + 0.5 * dt_s * piece.acceleration);
        speed += dt_s * piece.acceleration;
        t_s += dt_s;
        const Trajectory::State state = turning.at(t_s);
        ASSERT_LT((state.q - q).lpNorm<Eigen::Infinity>(), 1e-8) << "case " << i << " at " << t_s << " s";
        ASSERT_LT((state.speed - speed).lpNorm<Eigen::Infinity>(), 1e-7) << "case " << i << " at " << t_s << " s";
      }
    }
    ASSERT_LT((q - one.path.back()).lpNorm<Eigen::Infinity>(), 1e-9);
  }
}

}  // namespace
}  // namespace saccade
