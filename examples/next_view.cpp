// SPDX-License-Identifier: Apache-2.0
// Fuses depth frames into a map, and asks where to look next: no robot, no simulation, no files.
#include <iostream>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/explore/view_planner.hpp"

int main() {
  const saccade::Executor executor = saccade::Executor::with_threads(0);  // all cores
  const saccade::Box workspace{{-0.5, -0.5, 0.0}, {0.5, 0.5, 0.6}};       // metres; outside of it nothing is unknown
  saccade::TsdfMap map = saccade::TsdfMap::create({.voxel_size_m = 0.01, .workspace = workspace}).value();

  const saccade::PinholeCamera camera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.3, 2.0};      // pixels, f, centre, range
  const saccade::Pose T_world_camera = saccade::look_at({0.0, 0.0, 0.8}, {0.0, 0.0, 0.0});  // your robot knows it
  saccade::DepthImage depth{camera.width, camera.height, 0.8F};  // your camera's frame; here a box on a table
  for (int v = 40; v < 80; ++v) {
    for (int u = 53; u < 106; ++u) depth(u, v) = 0.6F;
  }
  for (int frame = 0; frame < 5; ++frame) {
    const auto fused = map.integrate(camera, depth, T_world_camera, executor);
    if (!fused) return std::cerr << fused.error().to_string() << '\n', 1;
  }

  saccade::SalientObjects attention;                         // what is worth looking at; or a source of your own
  saccade::ContourViews views{{.distances_m = {0.6, 0.8}}};  // from where
  saccade::RayGain gain{{.sensor = camera}};                 // what a view would show
  saccade::ViewPlanner planner{attention, views, gain};
  const auto ranking = planner.rank({map.content(), executor});
  if (!ranking) return std::cerr << ranking.error().to_string() << '\n', 1;
  if (ranking->empty()) return std::cout << "no view is worth taking\n", 0;
  std::cout << "gain " << ranking->best().gain << " rays of " << ranking->candidates() << " candidates, from\n"
            << ranking->best().T_world_camera.matrix() << '\n';  // go there, fuse what the camera sees, ask again
}
