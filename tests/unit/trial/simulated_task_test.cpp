// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/simulated_task.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "saccade/attention/dip_detector.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

std::vector<SceneChange> changes_between(const char* before, const char* after) {
  return scene_changes(find_scene(before).value(), find_scene(after).value()).value();
}

std::vector<std::string> names_of(const std::vector<SceneChange>& changes) {
  std::vector<std::string> names;
  for (const SceneChange& change : changes) names.push_back(change.object);
  return names;
}

TEST(SceneChanges, ABottleAppears) {
  const std::vector<SceneChange> changes = changes_between("bottle-before", "bottle");
  ASSERT_EQ(names_of(changes), std::vector<std::string>{"bottle"});
  EXPECT_FALSE(changes[0].was);
  ASSERT_TRUE(changes[0].is);
  EXPECT_LT((0.5 * (changes[0].is->min + changes[0].is->max) - Eigen::Vector3d{0.03, 0.02, 0.12}).norm(), 1e-3);
  EXPECT_NEAR(changes[0].is->max.z(), 0.24, 1e-6);
}

TEST(SceneChanges, AndBackwardsItVanishes) {
  const std::vector<SceneChange> changes = changes_between("bottle", "bottle-before");
  ASSERT_EQ(names_of(changes), std::vector<std::string>{"bottle"});
  EXPECT_TRUE(changes[0].was);
  EXPECT_FALSE(changes[0].is);
}

TEST(SceneChanges, AJugMoves) {
  const std::vector<SceneChange> changes = changes_between("jug-before", "jug");
  ASSERT_EQ(names_of(changes), std::vector<std::string>{"jug"});
  ASSERT_TRUE(changes[0].was && changes[0].is);
  const Eigen::Vector3d moved_m = changes[0].is->min - changes[0].was->min;
  EXPECT_LT((moved_m - Eigen::Vector3d{0.74, -0.11, -0.02}).norm(), 1e-6);
}

TEST(SceneChanges, WhatVanishedComesFirst) {
  Scene before = find_scene("jug").value();
  Scene after = before;
  after.objects.back().T_world_object.translation().z() += 0.01;
  after.objects.back().color = {1, 2, 3};
  SceneObject cup = before.objects.back();
  cup.name = "cup";
  after.objects.insert(after.objects.begin(), cup);
  cup.name = "mug";
  before.objects.push_back(cup);
  after.max_deviation_m = 0.001;
  EXPECT_EQ(names_of(scene_changes(before, after).value()), (std::vector<std::string>{"mug", "cup", "jug"}));
}

TEST(SceneChanges, ColoursAndTheOrderOfObjectsAreNone) {
  const Scene before = find_scene("jug").value();
  Scene after = before;
  std::swap(after.objects.front(), after.objects.back());
  after.objects.front().color = {1, 2, 3};
  EXPECT_TRUE(scene_changes(before, after).value().empty());
}

void expect_refused(const Scene& before, const Scene& after, const std::string& part) {
  const auto changes = scene_changes(before, after);
  ASSERT_FALSE(changes);
  EXPECT_EQ(changes.error().code, Errc::invalid_argument);
  EXPECT_NE(changes.error().to_string().find(part), std::string::npos) << changes.error().to_string();
}

TEST(SceneChanges, OneCellIsExpected) {
  const Scene before = find_scene("jug-before").value();
  Scene wider = find_scene("jug").value();
  wider.workspace.max.x() += 0.1;
  expect_refused(before, wider, "different workspaces");
  Scene moved_table = find_scene("jug").value();
  for (SceneObject& object : moved_table.objects) {
    if (object.name == "table") object.T_world_object.translation().z() -= 0.1;
  }
  expect_refused(before, moved_table, "\"table\", a support or fixture");
}

TEST(SimulatedHand, ActsAtTheUpperPartsOfTheObjects) {
  const Scene before = find_scene("jug-before").value();
  const std::vector<SceneChange> changes = changes_between("jug-before", "jug");
  const SimulatedHand hand = simulated_hand(before, changes, 1).value();
  ASSERT_EQ(hand.places.size(), 2U);
  EXPECT_TRUE(hand.places[0].picked_up);
  EXPECT_FALSE(hand.places[1].picked_up);
  for (const HandPlace& place : hand.places) {
    const Box& object = place.picked_up ? *changes[0].was : *changes[0].is;
    EXPECT_EQ(place.object, "jug");
    EXPECT_GT(place.position_m.z(), 0.5 * (object.min.z() + object.max.z()));
    EXPECT_LT((place.position_m - 0.5 * (object.min + object.max)).norm(), 0.12);
  }
  EXPECT_NE(simulated_hand(before, changes, 2).value().trajectory.front().position_m,
            hand.trajectory.front().position_m);
  const SimulatedHand again = simulated_hand(before, changes, 1).value();
  ASSERT_EQ(again.trajectory.size(), hand.trajectory.size());
  for (std::size_t i = 0; i < hand.trajectory.size(); ++i) {
    EXPECT_EQ(again.trajectory[i].position_m, hand.trajectory[i].position_m);
  }
}

TEST(SimulatedHand, CarriesTheJugOverTheBriefcase) {
  const Scene before = find_scene("jug-before").value();
  const std::vector<SceneChange> changes = changes_between("jug-before", "jug");
  const Box& jug = *changes[0].was;
  std::size_t over{0};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const SimulatedHand hand = simulated_hand(before, changes, seed).value();
    // Half way between the places the jug's lowest point is as far below the sensor as when it was picked up.
    const double hangs_m = hand.places[0].position_m.z() - jug.min.z();
    for (const HandSample& sample : hand.trajectory) {
      const Eigen::Vector3d& p = sample.position_m;
      if (std::abs(p.x() - 0.02) > 0.1 || std::abs(p.y()) > 0.06) continue;
      EXPECT_GT(p.z() - hangs_m, 0.24) << "seed " << seed;
      ++over;
    }
  }
  EXPECT_GT(over, 500U);
}

TEST(SimulatedHand, NeedsSomethingToDo) {
  const Scene before = find_scene("jug-before").value();
  const auto idle = simulated_hand(before, {}, 1);
  ASSERT_FALSE(idle);
  EXPECT_EQ(idle.error().code, Errc::invalid_argument);
  EXPECT_NE(idle.error().message.find("nothing changes"), std::string::npos);
  const std::vector<SceneChange> changes = changes_between("jug-before", "jug");
  EXPECT_FALSE(simulated_hand(before, changes, 1, {.grip_share = 1.5}));
  EXPECT_FALSE(simulated_hand(before, changes, 1, {.wrist_m = -0.1}));
  EXPECT_FALSE(simulated_hand(before, changes, 1, {.motion = {.rate_hz = 0.0}}));
}

/// Tells whether the detector finds each place within 0.1 m, in their order, and nothing else.
bool found_all(const SimulatedHand& hand) {
  const DipResult found = detect_dips(hand.trajectory).value();
  if (found.actions.size() != hand.places.size()) return false;
  for (std::size_t i = 0; i < hand.places.size(); ++i) {
    if ((found.actions[i].position_m - hand.places[i].position_m).norm() > 0.1) return false;
  }
  return true;
}

TEST(SimulatedHand, ItsPlacesAreFoundAndNothingElse) {
  const int cases = test::scaled_cases(250);
  for (const auto& [was, is] :
       {std::pair{"bottle-before", "bottle"}, {"jug-before", "jug"}, {"bottle", "bottle-before"}}) {
    const Scene before = find_scene(was).value();
    const std::vector<SceneChange> changes = changes_between(was, is);
    int found{0};
    for (int seed = 0; seed < cases; ++seed) {
      found += found_all(simulated_hand(before, changes, static_cast<std::uint64_t>(seed)).value()) ? 1 : 0;
    }
    std::cout << was << " to " << is << ": " << found << " of " << cases << " seeds\n";
    EXPECT_GE(100 * found, 99 * cases) << was << " to " << is;
  }
}

}  // namespace
}  // namespace saccade
