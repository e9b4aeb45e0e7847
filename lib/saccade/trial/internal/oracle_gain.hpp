// SPDX-License-Identifier: Apache-2.0
#pragma once
// OracleGain: the gain with full knowledge of the scene; a bound for planners without it.

#include "saccade/explore/planners.hpp"
#include "saccade/trial/internal/missing_surface.hpp"

namespace saccade {

/// Counts, of about kOraclePoints observable points of the true objects, those that are visible from a view and missing
/// in the map's mesh (Metrics::coverage): at most 80° from their normal, with no true surface in between. Greedy, so no
/// bound for better sequences of views. O(camera centres · missing points · log triangles).
class OracleGain final : public Gain {
 public:
  /// @param camera  the real camera; @param tilt_rad  tilt up and down at a view.
  OracleGain(GroundTruth truth, const PinholeCamera& camera, double tilt_rad);
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// Returns all views that show something, by decreasing number of points. Points are not rays: no threshold applies.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  GroundTruth truth_;
  PinholeCamera camera_;
};

/// Returns the oracle's entry in the table of planners; its setup needs the ground truth.
[[nodiscard]] NamedPlanner oracle_planner();

}  // namespace saccade
