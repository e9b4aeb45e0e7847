// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/internal/tabletop.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// Adds floor and walls around the table, which a depth camera sees when it looks past it.
void add_room(Scene& scene) {
  const auto add = [&scene](const char* name, const Vector3d& size_m, const Vector3d& at) {
    SceneObject part;
    part.name = name;
    part.shape = BoxShape{size_m};
    part.T_world_object.translation() = at;
    part.color = {205, 205, 198};
    part.support = true;
    part.fixture = true;
    scene.objects.push_back(std::move(part));
  };
  add("floor", {6.2, 6.2, 0.1}, {0.0, 0.0, -0.85});
  add("wall-left", {0.1, 6.2, 3.0}, {-3.05, 0.0, -0.75});
  add("wall-right", {0.1, 6.2, 3.0}, {3.05, 0.0, -0.75});
  add("wall-front", {6.0, 0.1, 3.0}, {0.0, -3.05, -0.75});
  add("wall-back", {6.0, 0.1, 3.0}, {0.0, 3.05, -0.75});
}

}  // namespace

Scene empty_tabletop(std::string name) {
  Scene scene;
  scene.name = std::move(name);
  scene.workspace = Box{{-0.6, -0.4, -0.03}, {0.6, 0.4, 0.40}};
  SceneObject table;
  table.name = "table";
  table.shape = BoxShape{{1.2, 0.8, 0.04}};
  table.T_world_object.translation() = Vector3d{0.0, 0.0, -0.04};
  table.color = {196, 164, 120};
  table.texture = {Texture::Kind::speckle, 0.04, 0.8};
  table.support = true;
  scene.objects.push_back(std::move(table));
  add_room(scene);
  for (const double y : {0.0, -0.2}) scene.scan.push_back(look_at({-0.95, y, 0.17}, {-0.15, 0.0, 0.08}));
  return scene;
}

}  // namespace saccade
