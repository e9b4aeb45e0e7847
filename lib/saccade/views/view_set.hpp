// SPDX-License-Identifier: Apache-2.0
#pragma once
// best_together: views that make known more together than any others.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/views/promise.hpp"

namespace saccade {

/// Returns the indices of at most `count` promises that are worth most together, in the order in which they were found:
/// a voxel counts once, with the most that one of them promises of it. The greedy choice, which is worth at least
/// 1 − 1/e of the best possible one, improved by exchanging one view for another while that helps. Fewer where no other
/// adds anything. Ties go to the lower index. O(rounds · count · voxels promised), with four rounds at most.
[[nodiscard]] std::vector<std::size_t> best_together(std::span<const Promise> promises, std::size_t count,
                                                     const Executor& executor);

/// What promises are worth together, as best_together counts.
[[nodiscard]] double worth_together(std::span<const Promise> promises);

}  // namespace saccade
