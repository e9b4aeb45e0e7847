// SPDX-License-Identifier: Apache-2.0
#pragma once
// naive_forest: shortest paths from roots by their definition, edge by edge until nothing changes.

#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade::test {

/// Per point path units and root of the shortest path below Ω_max.
using NaiveForest = std::vector<std::optional<std::pair<std::uint64_t, std::uint32_t>>>;

inline NaiveForest naive_forest(const Neighbourhood& graph, std::span<const Root> roots) {
  NaiveForest best(graph.size());
  for (const Root& root : roots) {
    best[root.point] = {static_cast<std::uint64_t>(root.start_cost / graph.config().max_path * kPathUnits), root.point};
  }
  // A root may be nearer to another one than its own start.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t point = 0; point < graph.size(); ++point) {
      for (const Neighbourhood::Edge& edge : graph.edges(graph.node_of(point))) {
        const auto& beyond = best[graph.point_of(edge.node)];
        if (!beyond || beyond->first + edge.cost >= kPathUnits) continue;
        const std::pair candidate{beyond->first + edge.cost, beyond->second};
        if (best[point] && *best[point] <= candidate) continue;
        best[point] = candidate;
        changed = true;
      }
    }
  }
  return best;
}

}  // namespace saccade::test
