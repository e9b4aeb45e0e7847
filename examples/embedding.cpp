// SPDX-License-Identifier: Apache-2.0
// Fuses depth frames into a map, then asks it what it knows: occupied, empty, or never seen.
#include <iostream>

#include "saccade/map/tsdf_map.hpp"

int main() {
  saccade::TsdfConfig config;
  config.voxel_size_m = 0.01;
  auto map = saccade::TsdfMap::create(config);
  if (!map) {
    std::cerr << map.error().to_string() << '\n';
    return 1;
  }

  const saccade::PinholeCamera camera;                                       // 640×480, f = 525 px
  const saccade::DepthImage wall_at_1_m{camera.width, camera.height, 1.0F};  // metres along the optical axis
  const auto executor = saccade::Executor::with_threads(0);                  // all cores
  for (int frame = 0; frame < 5; ++frame) {
    const saccade::Pose T_world_camera{Eigen::Translation3d{0.02 * frame, 0.0, 0.0}};
    const auto stats = map->integrate(camera, wall_at_1_m, T_world_camera, executor);
    if (!stats) {
      std::cerr << stats.error().to_string() << '\n';
      return 1;
    }
  }

  const saccade::TsdfSnapshot snapshot = map->snapshot();  // a consistent copy; fusion may go on meanwhile
  const char* const names[] = {"unknown", "empty", "occupied"};
  for (const double z_m : {0.5, 1.005, 1.5}) {
    const auto voxel = saccade::voxel_at({0.0, 0.0, z_m}, config.voxel_size_m);
    std::cout << z_m << " m: " << names[static_cast<int>(snapshot.grid.state(voxel))] << '\n';
  }
}
