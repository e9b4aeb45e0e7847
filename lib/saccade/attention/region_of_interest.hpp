// SPDX-License-Identifier: Apache-2.0
#pragma once
// RegionOfInterest: space worth looking at, from any source.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

struct SalientSurface;

/// Source of attention.
enum class AttentionOrigin {
  hand_action,
  segment,    ///< SalientObjects
  workspace,  ///< the whole workspace, or a region that the user gave
};

/// Region handed from attention to planning, which works on regions without regard to their source.
struct RegionOfInterest {
  Region bounds{};
  double saliency{0.0};  ///< comparable among regions of one origin; larger is more salient
  AttentionOrigin origin{AttentionOrigin::hand_action};
  std::string why;  ///< one line for people
  /// Number in the record of a run. Views of regions with one number count for that number together.
  std::size_t index{0};
  /// false: considered only where no earlier region has a view worth taking, whatever its saliency.
  bool rival{true};
  /// Segmented surface that the region is part of, with its segment below; nullptr: no segment.
  std::shared_ptr<const SalientSurface> surface{};
  std::uint32_t segment{0};
  /// Value of `segment` for the whole surface, each segment weighted by its saliency.
  static constexpr std::uint32_t kAllSegments{~0U};
};

/// Returns a sphere around each action, in their order. Thesis §2.2.2: radius 0.2 m.
/// @return invalid_argument for a radius that is not positive or a position that is not finite.
[[nodiscard]] Result<std::vector<RegionOfInterest>> regions_of_interest(std::span<const HandAction> actions,
                                                                        double radius_m = 0.2);

}  // namespace saccade
