// SPDX-License-Identifier: Apache-2.0
#pragma once
// search_leaves: the vector kernel that finds the nearest neighbours of the points of leaves.

#include <cstddef>
#include <cstdint>

#include "saccade/cloud/internal/leaf_tree.hpp"

namespace saccade {

inline constexpr std::size_t kMostNeighbours{64};

/// Finds the k nearest other points of each point in leaves [begin, end), nearest first, equally near ones in ascending
/// order. Row i of `rows` belongs to site i and holds site numbers. The points of a leaf search together, nearest boxes
/// first. Expects 1 ≤ k ≤ 64 and more than k sites. The instruction set never changes the result.
void search_leaves(const LeafTree& tree, std::size_t k, std::size_t begin, std::size_t end, std::uint32_t* rows);

}  // namespace saccade
