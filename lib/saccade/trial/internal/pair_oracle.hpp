// SPDX-License-Identifier: Apache-2.0
#pragma once
// PairOracle: the first of the two views that together would show most. best_pair. OracleViews: candidates wherever the
// true objects are incomplete in the map. A tighter bound for planners than OracleGain.

#include <bit>
#include <cstdint>
#include <optional>

#include "saccade/explore/planners.hpp"
#include "saccade/trial/internal/missing_surface.hpp"

namespace saccade {

/// Missing points that a view shows, one bit each.
using ShownPoints = std::vector<std::uint64_t>;

/// Two views, the one that shows more first.
struct ViewPair {
  std::size_t first{0};
  std::size_t second{0};
  std::size_t shown{0};  ///< points that at least one of them shows
};
/// Returns the pair with the largest union; at a tie the one with the best views first. nullopt for fewer than two
/// views. Views are visited by decreasing number of points. A pair shows at most the sum of what each shows, so the
/// search ends once the sum does not exceed the best union. The thread count never changes the pair.
[[nodiscard]] std::optional<ViewPair> best_pair(std::span<const ShownPoints> shown, const Executor& executor);

/// Poses of ContourViews, and a sphere of views around each cell of kOracleCell_m with missing points, about their
/// mean.
class OracleViews final : public ViewGenerator {
 public:
  OracleViews(GroundTruth truth, std::shared_ptr<ViewGenerator> contours, ViewSphereConfig sphere)
      : truth_{std::move(truth)}, contours_{std::move(contours)}, sphere_{std::move(sphere)} {}
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& context, const RegionOfInterest& region) override;

 private:
  GroundTruth truth_;
  std::shared_ptr<ViewGenerator> contours_;
  ViewSphereConfig sphere_;
};
constexpr double kOracleCell_m{0.15};

/// Gain that looks two views ahead: the best pair's views come first, the one that shows more in front, then all others
/// by what they show alone. The last view of a run is chosen alone. Cost: OracleGain, and a word operation per 64
/// points and candidate pair.
class PairOracle final : public Gain {
 public:
  /// @param camera  the real camera; @param tilt_rad  tilt up and down at a view.
  PairOracle(GroundTruth truth, const PinholeCamera& camera, double tilt_rad, std::size_t max_views);
  /// Counts the missing points that each view shows alone.
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// Returns all views that show something. No threshold applies.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  [[nodiscard]] std::vector<ShownPoints> shown_by(const PlanningContext& context,
                                                  std::span<const Pose> T_world_camera) const;

  GroundTruth truth_;
  PinholeCamera camera_;
  std::size_t max_views_;
};

/// Returns the entry of "oracle-2" in the table of planners; its setup needs the ground truth.
[[nodiscard]] NamedPlanner pair_oracle_planner();

}  // namespace saccade
