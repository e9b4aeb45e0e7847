// SPDX-License-Identifier: Apache-2.0
#pragma once
// PathReach: path and root of a node in one number, and the neighbours that get nearer along a node. For Algorithm 8.

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>

#include "saccade/annotate/neighbourhood.hpp"

namespace saccade {

/// Path in the upper half, the root's point in the lower: smaller is nearer.
using PathReach = std::uint64_t;

inline constexpr unsigned kPathShift{32};
inline constexpr PathReach kNoPath{PathReach{kPathUnits} << kPathShift};

[[nodiscard]] inline PathReach reach_of(std::uint32_t path, std::uint32_t root) {
  return PathReach{path} << kPathShift | root;
}
[[nodiscard]] inline std::uint32_t path_of(PathReach reach) { return static_cast<std::uint32_t>(reach >> kPathShift); }
[[nodiscard]] inline std::uint32_t root_of_reach(PathReach reach) { return static_cast<std::uint32_t>(reach); }

/// Loads a reach that other threads may lower at the same time.
[[nodiscard]] inline PathReach load_reach(PathReach& reach) {
  return std::atomic_ref<PathReach>{reach}.load(std::memory_order_relaxed);
}

/// Calls lower(neighbour, reach) for each neighbour that is nearer along this node than it is now.
template <class Lower>
[[gnu::always_inline]] inline void for_nearer_neighbours(const Neighbourhood& neighbourhood, PathReach* reach,
                                                         std::uint32_t node, PathReach to_node, const Lower& lower) {
  constexpr std::size_t kEdgesAtOnce{32};
  const std::span<const Neighbourhood::Edge> edges = neighbourhood.edges(node);
  for (std::size_t first = 0; first < edges.size(); first += kEdgesAtOnce) {
    const std::size_t count = std::min(kEdgesAtOnce, edges.size() - first);
    std::uint32_t nearer{0};  // found without branches, because few are nearer
    for (std::size_t e = 0; e < count; ++e) {
      const Neighbourhood::Edge& edge = edges[first + e];
      const bool is_nearer = to_node + reach_of(edge.cost, 0) < load_reach(reach[edge.node]);
      nearer |= (is_nearer ? 1U : 0U) << e;
    }
    for (; nearer != 0; nearer &= nearer - 1) {
      const Neighbourhood::Edge& edge = edges[first + static_cast<std::size_t>(std::countr_zero(nearer))];
      lower(edge.node, to_node + reach_of(edge.cost, 0));
    }
  }
}

}  // namespace saccade
