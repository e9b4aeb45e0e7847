// SPDX-License-Identifier: Apache-2.0
// Asks for the next best view of what was seen so far: no robot, no simulation, no files.
#include <iostream>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/explore/view_planner.hpp"

namespace {

/// A frame of one's own camera: here a box of 20 cm on a plane, seen from above.
saccade::DepthImage my_depth(const saccade::PinholeCamera& camera) {
  saccade::DepthImage depth{camera.width, camera.height, 0.8F};
  for (int v = camera.height / 3; v < 2 * camera.height / 3; ++v) {
    for (int u = camera.width / 3; u < 2 * camera.width / 3; ++u) depth(u, v) = 0.6F;
  }
  return depth;
}

}  // namespace

int main() {
  saccade::TsdfConfig config;
  config.voxel_size_m = 0.01;
  config.workspace = saccade::Box{{-0.5, -0.5, 0.0}, {0.5, 0.5, 0.6}};
  saccade::TsdfMap map = saccade::TsdfMap::create(config).value();
  const saccade::Executor executor = saccade::Executor::with_threads(0);  // all cores
  const saccade::PinholeCamera camera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.3, 2.0};
  const saccade::Pose above = saccade::look_at({0.0, 0.0, 0.8}, {0.0, 0.0, 0.0});
  for (int frame = 0; frame < 5; ++frame) {  // your frames and poses
    if (!map.integrate(camera, my_depth(camera), above, executor)) return 1;
  }

  saccade::SalientObjects attention;  // or RegionsInTurn, or a source of your own
  saccade::ContourViews views{{.distances_m = {0.6, 0.8}}};
  saccade::RayGain gain{{.sensor = camera}};
  saccade::ViewPlanner planner{attention, views, gain};
  const auto ranking = planner.rank({map.content(), executor});
  if (!ranking) return std::cerr << ranking.error().to_string() << '\n', 1;
  if (ranking->empty()) return std::cout << "nothing is worth another look\n", 0;
  std::cout << "gain " << ranking->best().gain << " rays of " << ranking->candidates() << " candidates, from\n"
            << ranking->best().T_world_camera.matrix() << '\n';  // go there, look, fuse, ask again
}
