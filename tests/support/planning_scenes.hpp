// SPDX-License-Identifier: Apache-2.0
#pragma once
// Built-in scenes as an arm knows them after some views, and the configurations that look at them.

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "saccade/arm/reachability.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/views/view_sphere.hpp"

namespace saccade::test {

/// Boxes around what stands there from the beginning: supports and fixtures.
inline std::vector<Box> known_boxes(const Scene& scene) {
  std::vector<Box> boxes;
  const std::vector<ObjectMesh> meshes = true_meshes(scene).value();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].support && !scene.objects[i].fixture) continue;
    Eigen::AlignedBox3d around;
    for (const Eigen::Vector3f& p : meshes[i].mesh.vertices) around.extend(p.cast<double>());
    boxes.push_back({around.min(), around.max()});
  }
  return boxes;
}

/// The scan and `views` more from random directions, fused; what was not seen is an obstacle.
inline ObstacleMap seen_scene(const std::string& name, int views, std::uint64_t seed, const Executor& executor) {
  const Scene scene = find_scene(name).value();
  const RayScene rays = RayScene::build(scene).value();
  SimulatedRunConfig config;
  config.seed = seed;
  TsdfConfig map_config = config.map();
  map_config.workspace = scene.workspace;
  TsdfMap map = TsdfMap::create(map_config).value();
  SimulatedCamera camera = simulated_camera(rays, config).value();
  const std::vector<Pose> around = poses_of(view_sphere(Eigen::Vector3d{0.0, 0.0, 0.1}).value());
  std::mt19937_64 random{seed};
  std::vector<Pose> poses = scene.scan;
  for (int i = 0; i < views; ++i) poses.push_back(around[around.size() / 2 + random() % (around.size() / 4)]);
  for (const Pose& T_world_camera : poses) {
    const Frame frame = camera.capture(T_world_camera, executor);
    SACCADE_EXPECTS(map.integrate(config.camera, frame.depth, T_world_camera, executor).ok());
  }
  ObstacleConfig obstacles;
  obstacles.fixtures = known_boxes(scene);
  return ObstacleMap::create(map.snapshot(), obstacles, executor).value();
}

/// For each view pose that the arm can take, its free configurations.
inline std::vector<std::vector<Configuration>> free_views(const Reachability& reachability,
                                                          const ObstacleMap& obstacles) {
  std::vector<std::vector<Configuration>> views;
  for (const Eigen::Vector3d& center : {Eigen::Vector3d{-0.3, 0.0, 0.1}, {0.0, 0.0, 0.1}, {0.3, 0.1, 0.15}}) {
    ViewSphereConfig sphere;
    sphere.radii_m = {0.5, 0.8};
    const std::vector<Pose> poses = poses_of(view_sphere(center, sphere).value());
    for (const Pose& T_world_camera : poses) {
      PoseGoals goals = reachability.goals(T_world_camera, reachability.arm().middle(), obstacles);
      if (!goals.refusal) views.push_back(std::move(goals.free));
    }
  }
  return views;
}

}  // namespace saccade::test
