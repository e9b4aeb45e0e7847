// SPDX-License-Identifier: Apache-2.0
#pragma once
// best_sequence: views that make known most, soonest, one after the other.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/views/promise.hpp"

namespace saccade {

/// Returns the indices of at most `count` promises that show most, soonest, in their order: what a view adds to those
/// before it counts as often as there are views from there on, which is the area under the curve of what is known. A
/// voxel counts with the most that one of them promises of it. The greedy choice, improved by exchanging one view for
/// another while that helps. Fewer where no other adds anything. Ties go to the lower index.
/// O(rounds · count · promises · voxels), with four rounds at most.
[[nodiscard]] std::vector<std::size_t> best_sequence(std::span<const Promise> promises, std::size_t count,
                                                     const Executor& executor);

/// What promises are worth together: a voxel counts once, with the most that one of them promises of it.
[[nodiscard]] double worth_together(std::span<const Promise> promises);

}  // namespace saccade
