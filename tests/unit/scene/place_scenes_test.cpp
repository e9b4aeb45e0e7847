// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/place_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "saccade/core/angle.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade {
namespace {

double turn_between(const Pose& a, const Pose& b) {
  return std::acos(
      std::clamp(a.linear().col(2).head<2>().normalized().dot(b.linear().col(2).head<2>().normalized()), -1.0, 1.0));
}

TEST(PlaceScenes, SeedsDrawOtherScenes) {
  for (const std::string kind : {"loop:", "alike:"}) {
    const PlaceScene one = place_scene(kind + "1").value();
    EXPECT_TRUE(one.scene.validate()) << kind;
    EXPECT_GT(one.scene.objects.size(), 10U);
    const auto hash = [&](const std::string& seed) {
      return scene_hash(RayScene::build(place_scene(kind + seed).value().scene).value());
    };
    EXPECT_EQ(hash("1"), hash("1"));
    EXPECT_NE(hash("1"), hash("3"));
  }
}

TEST(PlaceScenes, TheLoopReturnsAndAlikePathsDoNot) {
  const PlaceScene loop = place_scene("loop:1").value();
  const std::vector<Pose> around = carried_poses(loop.path, 111);  // 1.1 turns, so the 101st is back
  EXPECT_LT(turn_between(around[0], around[100]), 6.0_deg);
  EXPECT_GT(turn_between(around[0], around[50]), 170.0_deg);
  EXPECT_LT((around[0].translation() - around[100].translation()).norm(), 0.2);
  const PlaceScene walls = place_scene("alike:2").value();
  const std::vector<Pose> most = carried_poses(walls.path, 101);  // 300°: 60° are missing, an image is 57° wide
  EXPECT_GT(turn_between(most[0], most[100]), 54.0_deg);
  const PlaceScene bays = place_scene("alike:1").value();
  const std::vector<Pose> past = carried_poses(bays.path, 51);
  for (std::size_t i = 5; i < past.size(); ++i) {
    EXPECT_GT(past[i].translation().x(), past[i - 5].translation().x()) << i;
  }
}

TEST(PlaceScenes, BaysAndWallsAreEqual) {
  const RayScene walls = RayScene::build(place_scene("alike:4").value().scene).value();
  const RayScene room = RayScene::build(place_scene("loop:4").value().scene).value();
  const Eigen::Vector3d eye{0.0, 0.0, 1.2};
  const auto distance = [&](const RayScene& scene, double azimuth_rad, double height) {
    const Eigen::Vector3d direction{std::cos(azimuth_rad), std::sin(azimuth_rad), height};
    return scene.cast(eye, direction.normalized())->t;
  };
  int different{0};
  for (int i = 0; i < 40; ++i) {
    const double azimuth = 0.04 * i;
    const double height = -0.5 + 0.02 * i;
    EXPECT_NEAR(distance(walls, azimuth, height), distance(walls, azimuth + 90.0_deg, height), 1e-3) << i;
    if (std::abs(distance(room, azimuth, height) - distance(room, azimuth + 90.0_deg, height)) > 0.05) ++different;
  }
  EXPECT_GT(different, 10);
}

TEST(PlaceScenes, NamesAreChecked) {
  EXPECT_EQ(place_scene("loop").error().code, Errc::not_found);
  EXPECT_EQ(place_scene("atrium:1").error().code, Errc::not_found);
  EXPECT_EQ(place_scene("loop:x").error().code, Errc::invalid_argument);
  EXPECT_EQ(place_scene("alike:").error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
