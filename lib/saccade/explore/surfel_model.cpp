// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/surfel_model.hpp"

#include <utility>

namespace saccade {

SurfelFusionConfig SurfelModel::default_config() {
  SurfelFusionConfig config;
  config.max_stretch = 4.0;  // a slant of 75°, as Keller et al. have it
  return config;
}

Status SurfelModel::fuse(const Frame& frame, const PinholeCamera& camera, const Executor& executor) {
  SACCADE_TRY([[maybe_unused]] const SurfelFusionReport report, fusion_.add_frame(frame, camera, executor));
  return {};
}

NamedPlanner surfel_planner(std::shared_ptr<const SurfelModel> model, const SurfelSightConfig& config) {
  NamedPlanner planner = surface_planner();
  planner.name = "surfels";
  planner.text = "views of surface that is expected beyond the seen surfels, in cm²";
  planner.make = [model = std::move(model), config](const PlannerSetup& setup) {
    PlannerSetup seen_by_surfels = setup;
    const MakeSight sight = surfel_sight(model->surfels(), config);
    seen_by_surfels.sight = [model, sight](std::shared_ptr<const ExpectedSurface> surface, const Executor& executor) {
      return sight(std::move(surface), executor);
    };
    return surface_planner().make(seen_by_surfels);
  };
  return planner;
}

}  // namespace saccade
