// SPDX-License-Identifier: Apache-2.0
#pragma once
// search_leaves: the vector kernel that finds the nearest neighbours of the points of leaves.

#include <cstddef>
#include <cstdint>

#include "saccade/cloud/internal/leaf_tree.hpp"

namespace saccade {

inline constexpr std::size_t kMostNeighbours{64};

/// The k nearest other points of each point of leaves [begin, end), the nearest first, equally near ones in ascending
/// order: row i of `rows` belongs to site i, and numbers are those of sites. All points of a leaf look for theirs
/// together, nearest boxes first. Expects 1 ≤ k ≤ 64 and more than k sites. The same on every instruction set.
void search_leaves(const LeafTree& tree, std::size_t k, std::size_t begin, std::size_t end, std::uint32_t* rows);

}  // namespace saccade
