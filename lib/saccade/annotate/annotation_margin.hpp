// SPDX-License-Identifier: Apache-2.0
#pragma once
// label_margins: how sure the label of each point is; next_best_click: where another control point would settle most.
// Not in the thesis.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade {

/// Of each point, in path units, start costs included; kPathUnits: none is shorter than Ω_max.
struct LabelPaths {
  std::vector<std::uint32_t> own;    ///< ω₁, to the root that it belongs to
  std::vector<std::uint32_t> other;  ///< ω₂, to the nearest root with another label than that one
};

/// Paths go through the whole graph. Dijkstra's algorithm once more, inside the regions of the labels: a shortest path
/// from another label enters a point's region where its own part of the way begins.
/// @param label_of_root  in the order of forest.roots(), none of them kNoLabel.
/// O(edges of what the forest has reached), one thread; 8 bytes per point while it works.
[[nodiscard]] LabelPaths label_paths(const ShortestPathForest& forest, std::span<const std::uint32_t> label_of_root);

/// 1 − ω₁ / ω₂, in [0, 1]: 0 where two labels are equally near and where none is, 1 at control points. It has no unit
/// and does not depend on weights or Ω_max being scaled: half means that another label is twice as far. Towards the
/// end of what labels reach, ω₂ is Ω_max at most, it falls to 0, too.
[[nodiscard]] inline float label_margin(std::uint32_t own, std::uint32_t other) {
  if (own >= other) return 0.0F;
  return 1.0F - static_cast<float>(own) / static_cast<float>(other);
}

/// Of each point; 1 where it is painted. Not in the thesis. As label_paths.
[[nodiscard]] std::vector<float> label_margins(const Annotation& annotation);

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
