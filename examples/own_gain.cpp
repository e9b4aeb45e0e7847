// SPDX-License-Identifier: Apache-2.0
// A gain of one's own: what a view shows, divided by how far the camera would have to fly to it.
#include <cstdio>

#include "saccade/explore/simulated_run.hpp"
#include "saccade/scene/random_clutter.hpp"

int main() {
  using namespace saccade;
  const Executor executor;
  SimulatedRunConfig config;
  config.voxel_size_m = 0.012;
  config.camera = coarser(config.camera, 160);
  config.exploration.max_views = 3;
  config.exploration.min_gain = 50.0;  // rays per metre

  const auto truth = Truth::build(*RayScene::build(random_clutter(5, 4)), 0.006, executor);
  const Eigen::Vector3d home{0.0, -0.8, 0.8};
  const GainFunction rays = ray_gain({config.camera});
  const GainFunction rays_per_metre = [&](const TsdfSnapshot& map, const Region& region, std::span<const Pose> poses,
                                          const Executor& on) -> Result<std::vector<double>> {
    SACCADE_TRY(std::vector<double> gains, rays(map, region, poses, on));
    for (std::size_t i = 0; i < poses.size(); ++i) gains[i] /= 0.1 + (poses[i].translation() - home).norm();
    return gains;
  };

  const auto run = run_simulated(*truth, config, SphereStrategy{config.sphere, rays_per_metre}, executor);
  if (!run) return std::fprintf(stderr, "%s\n", run.error().to_string().c_str()), 1;
  for (const MeasuredView& view : run->views) {
    std::printf("gain %.0f rays/m, coverage %.0f %%\n", view.view.gain, 100.0 * view.after.metrics.coverage);
  }
}
