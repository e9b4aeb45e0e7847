// SPDX-License-Identifier: Apache-2.0
// AX = XB with exact motions, with wrong ones among them and with too few; clocks by made-up turns.
#include "saccade/tracking/internal/mount_equation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saccade/core/angle.hpp"
#include "saccade/core/seeded_random.hpp"
#include "saccade/tracking/internal/clock_match.hpp"

namespace saccade {
namespace {

Pose some_pose(SeededRandom& random, double turn_rad, double shift_m) {
  const auto direction = [&] {
    return Eigen::Vector3d{random.normal(), random.normal(), random.normal()}.normalized();
  };
  Pose T{Pose::Identity()};
  T.linear() = Eigen::AngleAxisd{turn_rad * random.unit(), direction()}.toRotationMatrix();
  T.translation() = shift_m * random.unit() * direction();
  return T;
}

double distance(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).norm(); }

TEST(MountEquation, IsExactForExactMotionsAndHoldsWithWrongOnesAmongThem) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SeededRandom random{seed};
    const Pose X = some_pose(random, 3.0, 0.3);
    const Pose T_base_world = some_pose(random, 3.0, 2.0);
    std::vector<Pose> flange;
    std::vector<Pose> camera;
    for (int k = 0; k < 12; ++k) {
      flange.push_back(some_pose(random, 60_deg, 0.5));
      camera.push_back(T_base_world.inverse() * flange.back() * X);
    }
    std::vector<MotionPair> motions;
    add_motions(flange, camera, motions);
    ASSERT_EQ(motions.size(), 66U);
    const std::optional<Pose> exact = solve_mount(motions);
    ASSERT_TRUE(exact.has_value());
    EXPECT_LT(distance(*exact, X), 1e-9);
    for (int k = 0; k < 8; ++k) {  // an alignment that slid by some centimetres and degrees
      motions[random.below(motions.size())].T_camera_camera =
          motions[random.below(motions.size())].T_camera_camera * some_pose(random, 5_deg, 0.05);
    }
    const std::optional<Pose> robust = solve_mount(motions);
    ASSERT_TRUE(robust.has_value());
    EXPECT_LT(distance(*robust, X), 1e-4) << seed;
  }
}

TEST(MountEquation, HasNoSolutionForTurnsAboutOneAxisOrNone) {
  for (const double turn : {0.0, 0.2}) {
    std::vector<Pose> poses;
    for (int k = 0; k < 6; ++k) {
      Pose T{Pose::Identity()};
      T.linear() = Eigen::AngleAxisd{turn * k, Eigen::Vector3d{1.0, 2.0, 2.0} / 3.0}.toRotationMatrix();
      T.translation() = Eigen::Vector3d{0.1 * k, 0.0, 0.02 * k * k};
      poses.push_back(T);
    }
    std::vector<MotionPair> motions;
    add_motions(poses, poses, motions);
    EXPECT_FALSE(solve_mount(motions).has_value());
    const Turns turns = turns_of(poses);
    EXPECT_NEAR(turns.rms_rad[1], 0.0, 1e-6);
    if (turn > 0.0) {
      EXPECT_NEAR(std::abs(turns.axes_flange.col(0).dot(Eigen::Vector3d{1.0, 2.0, 2.0} / 3.0)), 1.0, 1e-9);
    }
  }
  EXPECT_FALSE(solve_mount({}).has_value());
}

/// Flange at 100 Hz over 4 s with an angle that a function tells; its camera at 25 Hz, its clock 80 ms ahead.
ClockMatch match_turning(double (*angle_rad)(double time_s), double max_offset_s = 0.5) {
  const auto pose = [&](double time_s) {
    Pose T{Pose::Identity()};
    T.linear() = Eigen::AngleAxisd{angle_rad(time_s), Eigen::Vector3d::UnitY()}.toRotationMatrix();
    return T;
  };
  std::vector<FlangeSample> samples;
  for (int k = -100; k <= 500; ++k) samples.push_back({0.01 * k, pose(0.01 * k)});
  std::vector<TimedPose> camera;
  for (int k = 0; k <= 100; ++k) camera.push_back({0.04 * k + 0.08, pose(0.04 * k)});
  return match_clocks(FlangeRecord{samples}, camera, max_offset_s);
}

TEST(ClockMatch, FindsTheOffsetWhereTurnsMatchOrSaysWhyNot) {
  const auto uneven = [](double t) { return 0.3 * std::sin(1.3 * t) + 0.1 * std::sin(3.1 * t); };
  const ClockMatch found = match_turning(uneven);
  ASSERT_TRUE(found.offset_s.has_value()) << found.why;
  EXPECT_NEAR(*found.offset_s, -0.08, 1e-3);
  EXPECT_NE(match_turning([](double t) { return 0.4 * t; }).why.find("hardly changed"), std::string::npos);
  EXPECT_NE(match_turning([](double t) { return 0.05 * std::sin(20.0 * t); }).why.find("repeats"), std::string::npos);
  EXPECT_FALSE(match_turning(uneven, 0.05).offset_s.has_value());
}

}  // namespace
}  // namespace saccade
