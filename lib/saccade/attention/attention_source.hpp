// SPDX-License-Identifier: Apache-2.0
#pragma once
// AttentionSource: where to look; WholeWorkspace and RegionsInTurn, which do not depend on what was seen.

#include <span>
#include <vector>

#include "saccade/attention/planning_context.hpp"
#include "saccade/attention/region_of_interest.hpp"

namespace saccade {

/// Regions worth looking at. One caller at a time; what it returns depends on the context alone, so that a run can be
/// resumed.
class AttentionSource {
 public:
  virtual ~AttentionSource() = default;
  /// @return the most salient region first; none: nothing draws attention.
  [[nodiscard]] virtual Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) = 0;
};

/// The map's workspace as one region.
class WholeWorkspace final : public AttentionSource {
 public:
  /// @return invalid_argument for a map without a workspace.
  [[nodiscard]] Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) override;
};

/// Given regions one after the other: each is left when none of its views is worth taking, and not returned to.
class RegionsInTurn final : public AttentionSource {
 public:
  explicit RegionsInTurn(std::span<const RegionOfInterest> regions);
  explicit RegionsInTurn(std::span<const Region> bounds);
  [[nodiscard]] Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) override;

 private:
  std::vector<RegionOfInterest> regions_;
};

}  // namespace saccade
