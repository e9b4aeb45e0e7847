// SPDX-License-Identifier: Apache-2.0
#pragma once
// label_margins: certainty of each point's label. next_best_click: where another control point would settle most. Not
// in the thesis.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade {

/// Path length of each point in path units, start cost included; kPathUnits where none is shorter than Ω_max.
struct LabelPaths {
  std::vector<std::uint32_t> own;    ///< ω₁, to its own root
  std::vector<std::uint32_t> other;  ///< ω₂, to the nearest root with another label
};

/// Computes path lengths through the whole graph. Runs Dijkstra's algorithm once more, inside the regions of the
/// labels: a shortest path from another label enters a point's region where the path's part inside begins.
/// @param label_of_root  in the order of forest.roots(), none of them kNoLabel. O(edges reached by the forest), one
/// thread; 8 bytes per point while it works.
[[nodiscard]] LabelPaths label_paths(const ShortestPathForest& forest, std::span<const std::uint32_t> label_of_root);

/// Returns the margin 1 − ω₁ / ω₂, in [0, 1]: 0 where two labels are equally near and where there is none, 1 at control
/// points. It has no unit and does not depend on the scale of weights or Ω_max: one half means that another label is
/// twice as far. It also falls to 0 towards the limit of what labels reach, because ω₂ is at most Ω_max.
[[nodiscard]] inline float label_margin(std::uint32_t own, std::uint32_t other) {
  if (own >= other) return 0.0F;
  return 1.0F - static_cast<float>(own) / static_cast<float>(other);
}

/// Returns the margin of each point's label; 1 where it is painted or locked. Not in the thesis. Cost as label_paths.
[[nodiscard]] std::vector<float> label_margins(const Annotation& annotation);

struct BestClick {
  std::uint32_t point{0};
  std::uint32_t label{kNoLabel};  ///< current label of the point
  double gain{0.0};               ///< gain in points
};

/// Finds the best next control point. A point that is neither painted nor locked has the doubt d = 1 − margin. A new
/// control point that takes a point from a path ω by a path ω' settles it by d⁸ (1 − ω' / ω); the gain is the sum.
/// Using d alone, or counting points alone, leads to far worse clicks (docs/guides/annotation.md). With strong_borders
/// a click begins with the start cost of a guarded_click. Candidates are the centres (region_centre) of the most
/// doubtful regions of those points that carry half of all doubt.
/// @param margins  label_margins of this annotation.
/// @param ends     cloud_ends, or empty.
/// @return nullopt: nothing is in doubt. O(points + edges visited by trials, which are bounded), one thread.
[[nodiscard]] std::optional<BestClick> next_best_click(const Annotation& annotation, std::span<const float> margins,
                                                       std::span<const std::uint8_t> ends);

/// Returns the gain of one point, as in next_best_click.
[[nodiscard]] double click_gain(const Annotation& annotation, std::span<const float> margins, std::uint32_t point);

}  // namespace saccade
