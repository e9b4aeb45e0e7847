// SPDX-License-Identifier: Apache-2.0
#pragma once
// RegionOfInterest: what attracts the robot, whatever it came from.

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

/// What drew the attention.
enum class AttentionOrigin {
  hand_action,
  segment,    ///< SalientObjects
  workspace,  ///< the whole of it, or a region that somebody named
};

/// The one currency between attention and planning: everything after it works on regions and does not know where they
/// came from.
struct RegionOfInterest {
  Region bounds{};
  double saliency{0.0};  ///< comparable among regions of one origin; larger draws more
  AttentionOrigin origin{AttentionOrigin::hand_action};
  std::string why;  ///< one line for people
  /// Its number in the record of a run. Views of regions with one number count for that number together.
  std::size_t index{0};
  /// false: looked at only where no region before it has a view worth taking, however salient it is.
  bool rival{true};
  /// The segmented surface that the region is part of, and its segment there; nullptr: of no segment.
  std::shared_ptr<const SalientSurface> surface{};
  std::uint32_t segment{0};
  /// In place of a segment: the whole surface, each segment by its saliency.
  static constexpr std::uint32_t kAllSegments{~0U};
};

/// A sphere around each action, in their order. Thesis §2.2.2: radius 0.2 m.
/// @return invalid_argument for a radius that is not positive or a position that is not finite.
[[nodiscard]] Result<std::vector<RegionOfInterest>> regions_of_interest(std::span<const HandAction> actions,
                                                                        double radius_m = 0.2);

}  // namespace saccade
