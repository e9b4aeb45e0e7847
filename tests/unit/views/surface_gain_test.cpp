// SPDX-License-Identifier: Apache-2.0
// Gains in cm² of views of a half-seen box, on maps written by hand.
#include "saccade/views/surface_gain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/half_seen_box.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using test::half_seen_box;
using test::half_seen_box_at;
using test::written_map;

double gain_from(const TsdfSnapshot& map, const Vector3d& camera_m) {
  SurfaceGain gain{{.sensor = {160, 120, 131.25, 131.25, 79.5, 59.5, 0.1, 2.0}}};
  const Executor executor;
  const Pose pose = look_at(camera_m, {0.0, 0.0, 0.05});
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  return gain.evaluate({map, executor}, all, std::span{&pose, 1}).value().front();
}

/// A box in the air; all that is known around it lies before its side towards +x.
VoxelState box_in_the_unknown(const Vector3d& p) {
  const bool ahead = std::abs(p.y()) < 0.05 && std::abs(p.z() - 0.15) < 0.05;
  if (!ahead || p.x() < 0.04) return VoxelState::unknown;
  return p.x() < 0.05 ? VoxelState::occupied : VoxelState::empty;
}

TEST(SurfaceGain, LooksThroughUnknownSpaceOnceNothingElseIsPromised) {
  const TsdfSnapshot map = written_map(box_in_the_unknown);
  const Executor executor;
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  const Pose aside = look_at({0.1, 0.8, 0.15}, {0.0, 0.0, 0.15});
  const auto best = [&](double doubtful_share, std::span<const CheckedView> checked) {
    SurfaceGain gain{{.sensor = {160, 120, 131.25, 131.25, 79.5, 59.5, 0.1, 2.0}, .doubtful_share = doubtful_share}};
    PlanningContext context{map, executor};
    context.checked = checked;
    return gain.best(context, all, std::span{&aside, 1}, 1).value().views.front().gain;
  };
  EXPECT_EQ(best(0.0, {}), 0.0);
  EXPECT_GT(best(0.1, {}), 0.5);
  EXPECT_NEAR(best(0.2, {}), 2.0 * best(0.1, {}), 1e-9);
  const CheckedView in_vain{aside, 0.0};
  EXPECT_EQ(best(0.1, std::span{&in_vain, 1}), 0.0);
}

TEST(SurfaceGain, IsTheAreaThatIsExpectedInThePicture) {
  const TsdfSnapshot map = half_seen_box();
  EXPECT_NEAR(gain_from(map, {-0.6, 0.0, 0.1}), 65.0, 20.0);
  EXPECT_LT(gain_from(map, {0.6, 0.0, 0.1}), 10.0);
  const double two_sides = gain_from(map, {-0.45, 0.45, 0.1});
  EXPECT_NEAR(two_sides, 130.0, 30.0);
}

TEST(SurfaceGain, TheThreadCountChangesNoBit) {
  const TsdfSnapshot map = half_seen_box();
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  std::vector<Pose> poses;
  for (int i = 0; i < 60; ++i)
    poses.push_back(look_at({0.6 * std::cos(i), 0.6 * std::sin(i), 0.01 * i}, {0.0, 0.0, 0.05}));
  std::vector<std::vector<double>> gains;
  for (const std::size_t threads : {1U, 2U, 5U}) {
    SurfaceGain gain{{}};
    const Executor executor = Executor::with_threads(threads);
    gains.push_back(gain.evaluate({map, executor}, all, poses).value());
  }
  EXPECT_GT(*std::max_element(gains[0].begin(), gains[0].end()), 50.0);
  EXPECT_EQ(gains[1], gains[0]);
  EXPECT_EQ(gains[2], gains[0]);
}

TEST(SurfaceGain, PosesThatAreNoneAreRefused) {
  SurfaceGain gain{{}};
  const Executor executor;
  const TsdfSnapshot map = half_seen_box();
  std::array<Pose, 2> poses{Pose::Identity(), Pose::Identity()};
  poses[1].translation().x() = std::nan("");
  const auto refused = gain.evaluate({map, executor}, {}, poses);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().to_string().find("pose 1"), std::string::npos);
}

TEST(SurfaceGain, NothingIsSeenThroughATable) {
  const TsdfSnapshot map = half_seen_box();
  EXPECT_EQ(gain_from(map, {-0.6, 0.0, -0.05}), 0.0);
  EXPECT_EQ(gain_from(map, {0.0, 0.0, -0.6}), 0.0);
}

TEST(SurfaceGain, UnknownSpaceInBetweenHides) {
  const TsdfSnapshot map = written_map([](const Vector3d& p) {
    return p.x() < -0.15 && p.x() > -0.25 && p.z() > 0.0 ? VoxelState::unknown : half_seen_box_at(p);
  });
  EXPECT_LT(gain_from(map, {-0.6, 0.0, 0.1}), 25.0);
  EXPECT_NEAR(gain_from(map, {0.0, 0.6, 0.1}), 65.0, 20.0);
}

}  // namespace
}  // namespace saccade
