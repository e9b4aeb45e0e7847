// SPDX-License-Identifier: Apache-2.0
// Plans a motion of the built-in arm to a camera pose, around a post that is in the way, and prints where the arm is.
#include <cstdio>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/reachability.hpp"
#include "saccade/arm/urdf.hpp"

int main() {
  using namespace saccade;
  const ArmModel arm = find_robot("comau_smart_six")->arm;
  const auto collision = ArmCollision::create(arm);
  const auto planner = MotionPlanner::create(*collision);
  const auto reachability = Reachability::create(*collision);

  // What is around: nothing but a post. A map that follows the camera takes the place of this one.
  TsdfConfig config;
  config.workspace = Box{{-0.3, -0.3, 0.0}, {0.3, 0.3, 0.3}};
  auto map = TsdfMap::create(config);
  if (!map || !map->free(*config.workspace).ok()) return 1;
  const ObstacleConfig post{.fixtures = {Box{{-0.05, -0.15, 0.0}, {0.05, -0.05, 1.9}}}};
  const auto obstacles = ObstacleMap::create(map->snapshot(), post, {});

  Configuration start = arm.middle();
  start[0] = -1.4;
  Configuration there = start;
  there[0] = 0.5;
  const PoseGoals goals = reachability->goals(camera_pose(arm, there), start, *obstacles);
  if (goals.refusal) return std::printf("%s\n", std::string{to_string(*goals.refusal)}.c_str()), 0;
  const auto outcome = planner->plan(start, goals.free, *obstacles);
  if (!outcome) return std::fprintf(stderr, "%s\n", outcome.error().to_string().c_str()), 1;
  if (!outcome->plan) return std::printf("%s\n", outcome->why.c_str()), 0;
  const Trajectory& trajectory = outcome->plan->trajectory;
  for (double t_s = 0.0; t_s < trajectory.duration_s(); t_s += 0.5) {
    const Eigen::Vector3d p_world = camera_pose(arm, trajectory.at(t_s).q).translation();
    std::printf("%.1f s: camera at %.2f %.2f %.2f m\n", t_s, p_world.x(), p_world.y(), p_world.z());
  }
  std::printf("%zu configurations, %.1f s\n", outcome->plan->path.size(), trajectory.duration_s());
}
