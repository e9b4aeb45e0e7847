// SPDX-License-Identifier: Apache-2.0
#pragma once
// next_best_click: where another control point would settle most. Not in the thesis.

#include <cstdint>
#include <optional>
#include <span>

#include "saccade/annotate/annotation.hpp"

namespace saccade {

struct BestClick {
  std::uint32_t point{0};
  std::uint32_t label{kNoLabel};  ///< that the point has now
  double gain{0.0};               ///< in points
};

/// A point that is not painted is in doubt by d = 1 − margin. A control point with path lengths ω' of its own settles
/// each point that it takes from paths ω by d⁸ (1 − ω' / ω); the gain is their sum: d alone, and taking alone, lead to
/// far worse clicks (docs/annotation.md). Tried are the centres (region_centre) of the most
/// doubtful regions of those points that have half of all doubt.
/// @param margins  label_margins of this annotation.
/// @param ends     cloud_ends, or none.
/// @return none: nothing is in doubt. O(points + edges that trials look at, which are bounded), one thread.
[[nodiscard]] std::optional<BestClick> next_best_click(const Annotation& annotation, std::span<const float> margins,
                                                       std::span<const std::uint8_t> ends);

/// The gain of one point. As next_best_click.
[[nodiscard]] double click_gain(const Annotation& annotation, std::span<const float> margins, std::uint32_t point);

}  // namespace saccade
