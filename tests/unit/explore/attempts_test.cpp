// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/attempts.hpp"

#include <gtest/gtest.h>

#include "saccade/core/angle.hpp"

namespace saccade {
namespace {

/// A view of all 960 candidates, of which the robot can take 129, that kept all of its promise.
ViewRecord kept(const Pose& T_world_camera) {
  ViewRecord view;
  view.T_world_camera = T_world_camera;
  view.gain_predicted = view.gain_observed = 192.0;
  view.candidates = 960;
  view.evaluated = 129;
  view.refused.add(Refusal::no_ik, 831);
  return view;
}

/// A view whose promise none of the rays that check finds.
ViewRecord unchecked(const Pose& T_world_camera) {
  ViewRecord view = kept(T_world_camera);
  view.gain_predicted = 80.0;
  view.gain_observed = ViewRecord{}.gain_observed;
  return view;
}

Pose rolled(const Pose& T_world_camera, double roll_rad) {
  return T_world_camera * Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitZ()};
}

class AttemptsTest : public ::testing::Test {
 protected:
  const Pose T_world_first_{look_at({0.5, 0.5, 0.6}, {0.0, 0.0, 0.0})};
  const Pose T_world_look_{look_at({-0.393, -0.115, 0.628}, {0.1, 0.2, 0.0})};
};

// As with a cell's arm, which turned its camera four times at one place for the same 80 rays.
TEST_F(AttemptsTest, ALookWhosePromiseCannotBeCheckedIsTakenInOneRollAlone) {
  const std::vector<ViewRecord> views{kept(T_world_first_), unchecked(T_world_look_)};
  const Attempts attempts{views};
  for (const double roll_rad : {0.0, 90_deg, 180_deg, 270_deg, 7_deg}) {
    EXPECT_TRUE(attempts.contains(0, rolled(T_world_look_, roll_rad))) << roll_rad;
    EXPECT_FALSE(attempts.contains(1, rolled(T_world_look_, roll_rad))) << "another region";
    EXPECT_FALSE(attempts.was_refused(0, rolled(T_world_look_, roll_rad)));
  }
  const Pose turned = T_world_look_ * Eigen::AngleAxisd{1_deg, Eigen::Vector3d::UnitX()};
  EXPECT_FALSE(attempts.contains(0, turned));
  EXPECT_FALSE(attempts.contains(0, Eigen::Translation3d{0.001, 0.0, 0.0} * T_world_look_));
  EXPECT_EQ(attempts.views_of(0), 2U);
  EXPECT_EQ(attempts.checked().size(), 1U);
}

TEST_F(AttemptsTest, OtherRollsOfACheckedLookMayFollow) {
  const std::vector<ViewRecord> views{kept(T_world_first_)};
  const Attempts attempts{views};
  EXPECT_TRUE(attempts.contains(0, T_world_first_));
  EXPECT_FALSE(attempts.contains(0, rolled(T_world_first_, 90_deg)));
}

TEST_F(AttemptsTest, OtherRollsMayFollowWherePlannersPromiseNothing) {
  const std::vector<ViewRecord> views{unchecked(T_world_first_), unchecked(T_world_look_)};
  const Attempts attempts{views};
  EXPECT_TRUE(attempts.contains(0, T_world_look_));
  EXPECT_FALSE(attempts.contains(0, rolled(T_world_look_, 90_deg)));
}

TEST_F(AttemptsTest, OtherRollsMayFollowWhereChanceChooses) {
  ViewRecord by_chance = unchecked(T_world_look_);
  by_chance.evaluated = 24;
  const std::vector<ViewRecord> views{kept(T_world_first_), by_chance};
  EXPECT_FALSE(Attempts{views}.contains(0, rolled(T_world_look_, 90_deg)));
}

}  // namespace
}  // namespace saccade
