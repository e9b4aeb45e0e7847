// SPDX-License-Identifier: Apache-2.0
// A gain of one's own: what a view shows, divided by how far the camera would have to fly to it.
#include <cstdio>

#include "saccade/scene/scene.hpp"
#include "saccade/trial/simulated_run.hpp"

using namespace saccade;

class RaysPerMetre final : public Gain {
 public:
  RaysPerMetre(const GainConfig& rays, Eigen::Vector3d home) : rays_{rays}, home_{std::move(home)} {}

  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> poses) override {
    SACCADE_TRY(std::vector<double> gains, rays_.evaluate(context, region, poses));
    for (std::size_t i = 0; i < poses.size(); ++i) gains[i] /= 0.1 + (poses[i].translation() - home_).norm();
    return gains;
  }

 private:
  RayGain rays_;
  Eigen::Vector3d home_;
};

int main() {
  const Executor executor;
  SimulatedRunConfig config;
  config.voxel_size_m = 0.012;
  config.camera = config.camera.scaled_to_width(160);
  config.exploration.max_views = 3;

  const auto truth = GroundTruth::build(*RayScene::build(random_clutter(5, 4)), 0.006, executor);
  WholeWorkspace attention;
  SphereViews views;
  RaysPerMetre gain{{config.camera}, {0.0, -0.8, 0.8}};
  ViewPlanner planner{attention, views, gain, {.min_gain = 50.0}};  // rays per metre
  const auto run = run_simulated(*truth, config, planner, executor);
  if (!run) return std::fprintf(stderr, "%s\n", run.error().to_string().c_str()), 1;
  for (const ViewRecord& view : run->views) {
    std::printf("gain %.0f rays/m, coverage %.0f %%\n", view.gain_predicted, 100.0 * *view.measures.coverage);
  }
}
