// SPDX-License-Identifier: Apache-2.0
// Views chosen on surfels and on a volume, the frames of each in both maps: what the choice is worth, and what the map.
#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

#include "saccade/core/statistics.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/trial/surfel_measures.hpp"

namespace saccade {
namespace {

/// Surfels and a fine volume of the same frames.
class BothMaps final : public SurfaceModel {
 public:
  BothMaps(std::shared_ptr<SurfelModel> surfels, const TsdfConfig& volume)
      : surfels_{std::move(surfels)}, volume_{TsdfMap::create(volume).value()} {}
  [[nodiscard]] Status fuse(const Frame& frame, const PinholeCamera& camera, const Executor& executor) override {
    SACCADE_TRY([[maybe_unused]] const FusionStats stats,
                volume_.integrate(camera, frame.depth, *frame.T_world_camera, executor));
    return surfels_->fuse(frame, camera, executor);
  }
  [[nodiscard]] double of_volume(const GroundTruth& truth, const Executor& executor) const {
    return measure_map(truth, volume_.content(), executor).coverage.value();
  }
  [[nodiscard]] double of_surfels(const GroundTruth& truth, double within_m, const Executor& executor) const {
    return measure_surfels(truth, volume_.content(), surfels_->surfels(), UnknownSurfelConfig{}.min_weight, within_m,
                           executor)
        .coverage.value();
  }

 private:
  std::shared_ptr<SurfelModel> surfels_;
  TsdfMap volume_;
};

struct Coverages {
  double of_volume;
  double of_surfels;
};

/// Coverage after at most three views of a flying camera, chosen on one kind of map.
Coverages explored(const std::string& name, MapKind chosen_on) {
  const Executor executor = Executor::with_threads(0);
  const RayScene rays = RayScene::build(find_scene(name).value()).value();
  const GroundTruth truth = GroundTruth::build(rays, kTruthSpacing_m, executor).value();
  SimulatedRunConfig config;
  config.exploration.max_views = 3;
  TsdfConfig fine = config.map();
  fine.workspace = rays.scene().workspace;
  config.map_kind = chosen_on;
  TsdfConfig planned = config.map();
  planned.workspace = rays.scene().workspace;
  const auto surfels = std::make_shared<SurfelModel>(SurfelModel::create().value());
  BothMaps maps{surfels, fine};
  if (chosen_on == MapKind::surfels) config.strategy = surfel_planner(surfels);
  TsdfMap map = TsdfMap::create(planned).value();
  MaskedCamera camera =
      MaskedCamera::create(simulated_camera(rays, config).value(),
                           std::make_unique<FreeRobot>(flying_camera(rays).value()), nullptr, executor)
          .value();
  ViewPlanner planner = make_planner(config, config.camera, regions_of(rays.scene(), config.strategy), &truth);
  Explorer explorer{{map, camera, camera.robot(), executor, nullptr, nullptr, {}, nullptr, {}, &maps},
                    config.exploration};
  RunRecord run;
  run.scan = explorer.scan(rays.scene().scan).value();
  run = explorer.explore(planner, run).value();
  EXPECT_FALSE(run.views.empty()) << name;
  return {maps.of_volume(truth, executor), maps.of_surfels(truth, config.voxel_size_m, executor)};
}

TEST(SurfelExplorationEvidence, TheChoiceIsComparedInEqualMaps) {
  std::vector<double> all;
  for (const std::string name : {"tabletop-1", "tabletop-2", "clutter:101", "clutter:102"}) {
    for (const MapKind kind : {MapKind::volume, MapKind::surfels}) {
      const Coverages coverages = explored(name, kind);
      const std::string key = name + "." + std::string{to_string(kind)};
      RecordProperty(key + ".of_volume", std::to_string(coverages.of_volume));
      RecordProperty(key + ".of_surfels", std::to_string(coverages.of_surfels));
      std::cout << key << ": " << coverages.of_volume << " of the volume, " << coverages.of_surfels << " of surfels\n";
      all.push_back(coverages.of_volume);
      all.push_back(coverages.of_surfels);
    }
  }
  ASSERT_EQ(all.size(), 16U);
  for (const double coverage : all) EXPECT_GT(coverage, 0.85);
}

}  // namespace
}  // namespace saccade
