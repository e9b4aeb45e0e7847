// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/ray_scene.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "saccade/scene/scene.hpp"

namespace saccade {
namespace {

std::string hash_of(Scene scene) {
  const auto rays = RayScene::build(std::move(scene));
  EXPECT_TRUE(rays);
  return rays ? scene_hash(*rays) : "";
}

TEST(SceneHash, ChangesWithAllThatACameraOrAMetricSees) {
  const Scene scene = random_clutter(3);
  const std::string hash = hash_of(scene);
  EXPECT_EQ(hash.size(), 16U);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(hash_of(scene), hash);
  const std::vector<std::function<void(Scene&)>> changes{
      [](Scene& s) { s.objects.back().T_world_object.translation().x() += 0.001; },
      [](Scene& s) { s.objects.back().support = !s.objects.back().support; },
      [](Scene& s) { s.objects.back().fixture = !s.objects.back().fixture; },
      [](Scene& s) { s.objects.pop_back(); },
      [](Scene& s) { s.max_deviation_m *= 4.0; },
      [](Scene& s) { s.workspace.max.z() += 0.01; },
      [](Scene& s) {
        s.regions.emplace_back(Sphere{{0.0, 0.0, 0.1}, 0.1});
      },
      [](Scene& s) {
        s.regions.emplace_back(Box{{0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}});
      },
      [](Scene& s) { s.scan.pop_back(); },
      [](Scene& s) { s.scan.back().translation().y() += 0.001; }};
  std::set<std::string> hashes{hash};
  for (const auto& change : changes) {
    Scene changed = scene;
    change(changed);
    hashes.insert(hash_of(changed));
  }
  EXPECT_EQ(hashes.size(), changes.size() + 1);
}

TEST(SceneHash, DoesNotChangeWithNamesAndColours) {
  Scene scene = random_clutter(3);
  const std::string hash = hash_of(scene);
  scene.name = "another";
  scene.objects.back().name = "renamed";
  scene.objects.back().color = {1, 2, 3};
  EXPECT_EQ(hash_of(scene), hash);
}

}  // namespace
}  // namespace saccade
