// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelModel: surfels as the model of an exploration. surfel_planner: chooses views on it.

#include <utility>

#include "saccade/explore/planners.hpp"
#include "saccade/explore/surface_model.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/views/surfel_sight.hpp"

namespace saccade {

/// Surfels fused from the frames of an exploration. Colours are averages.
class SurfelModel final : public SurfaceModel {
 public:
  /// Errors: those of SurfelFusion::create.
  /// @param map  the surfels of an exploration that goes on
  [[nodiscard]] static Result<SurfelModel> create(const SurfelFusionConfig& config = default_config(),
                                                  SurfelMap map = {}) {
    SACCADE_TRY(SurfelFusion fusion, SurfelFusion::create(config, std::move(map)));
    return SurfelModel{std::move(fusion)};
  }
  /// Returns the configuration of explorations: discs whose rims stand off a surface would count as that surface, and
  /// hide others.
  [[nodiscard]] static SurfelFusionConfig default_config();
  /// Errors: those of SurfelFusion::add_frame. O(surfels + pixels).
  [[nodiscard]] Status fuse(const Frame& frame, const PinholeCamera& camera, const Executor& executor) override;

  [[nodiscard]] const SurfelMap& surfels() const { return fusion_.map(); }
  /// Returns the heap bytes of the surfels.
  [[nodiscard]] std::size_t memory_bytes() const { return surfels().memory_bytes(); }

 private:
  explicit SurfelModel(SurfelFusion fusion) : fusion_{std::move(fusion)} {}
  SurfelFusion fusion_;
};

/// Returns the planner of surface_planner(), with lines of sight among the surfels of a model (surfel_sight). The map
/// says what is free and where surface may be expected; its voxels may be as coarse as an arm needs.
/// @param model its place must not change while the planner is in use; the planner shares it
[[nodiscard]] NamedPlanner surfel_planner(std::shared_ptr<const SurfelModel> model,
                                          const SurfelSightConfig& config = {});

}  // namespace saccade
