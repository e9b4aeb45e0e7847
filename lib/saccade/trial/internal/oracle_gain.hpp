// SPDX-License-Identifier: Apache-2.0
#pragma once
// OracleGain: what one would gain who knew the scene; a bound for planners that do not.

#include "saccade/explore/planners.hpp"
#include "saccade/trial/internal/missing_surface.hpp"

namespace saccade {

/// Counts, of about kOraclePoints observable points of the true objects, those that can be seen from a view and that
/// the map's mesh does not have yet (Metrics::coverage), 80° from their normal at most, nothing true in between.
/// Greedy, so no bound on better sequences of views. O(camera centres · points that are missing · log triangles).
class OracleGain final : public Gain {
 public:
  /// @param camera  that looks; @param tilt_rad  by how much it is tilted up and down at a view.
  OracleGain(Truth truth, const PinholeCamera& camera, double tilt_rad);
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// All views that show something, by decreasing number of points. Points are no rays: no threshold applies.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  Truth truth_;
  PinholeCamera camera_;
};

/// The line of the oracle in the table of planners; its setup needs the truth.
[[nodiscard]] NamedPlanner oracle_planner();

}  // namespace saccade
