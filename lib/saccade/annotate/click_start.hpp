// SPDX-License-Identifier: Apache-2.0
#pragma once
// click_start, guarded_click: where the path of a later click begins, so that it corrects what lies behind a border and
// takes nothing before it. Not in the thesis (docs/design/annotation-leaks.md).

#include <cstdint>

#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade {

/// Returns the start cost, in the unit of the costs, for a new root at this point. The shortest path from the point's
/// root to the point crosses its strongest border where four edges in a row cost most; the start cost is the path's
/// length before them. The new root then takes what the path entered there. A point before the border whose own path is
/// not longer than that is out of reach. At a tie the border nearer to the point counts.
/// @return 0 for a point without a root. O(edges of the path's points), one thread; independent of the thread count.
[[nodiscard]] double click_start(const ShortestPathForest& forest, std::uint32_t point);

/// Returns the action that a person's click stands for. With NeighbourhoodConfig::strong_borders, a single new control
/// point of a label that has others gets click_start, unless it has a start cost. Other actions stay unchanged. The
/// first click of a label starts at 0: it must take an object whole.
[[nodiscard]] AnnotationAction guarded_click(const Annotation& annotation, AnnotationAction action);

}  // namespace saccade
