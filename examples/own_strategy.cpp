// SPDX-License-Identifier: Apache-2.0
// A strategy of one's own: once around the region, 90 degrees further with each view, whatever the map holds.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "saccade/explore/simulated_run.hpp"
#include "saccade/scene/random_clutter.hpp"

using namespace saccade;

class OnceAround final : public Strategy {
 public:
  [[nodiscard]] Result<Proposals> propose(const Situation& situation) const override {
    Proposals proposals;
    proposals.by_gain = false;
    if (situation.views_of_region >= 4) return proposals;  // nothing to propose: the region is done
    const Box box = bounds(situation.region);
    const Eigen::Vector3d center = 0.5 * (box.min + box.max);
    const double azimuth_rad = 0.5 * std::numbers::pi * static_cast<double>(situation.views_of_region);
    const Eigen::Vector3d offset{0.7 * std::cos(azimuth_rad), 0.7 * std::sin(azimuth_rad), 0.6};
    proposals.views.push_back({look_at(center + offset, center)});
    return proposals;
  }
};

int main() {
  SimulatedRunConfig config;
  config.voxel_size_m = 0.012;
  config.camera = coarser(config.camera, 160);
  const auto truth = Truth::build(*RayScene::build(random_clutter(5, 4)), 0.006, Executor{});
  const auto run = run_simulated(*truth, config, OnceAround{}, Executor{});
  if (!run) return std::fprintf(stderr, "%s\n", run.error().to_string().c_str()), 1;
  std::printf("coverage %.0f %% after %zu views\n", 100.0 * run->final().metrics.coverage, run->views.size());
}
