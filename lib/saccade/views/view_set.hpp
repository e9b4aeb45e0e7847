// SPDX-License-Identifier: Apache-2.0
#pragma once
// best_sequence: the sequence of views that makes most known, soonest.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/views/promise.hpp"

namespace saccade {

/// Returns the indices of at most `count` promises, in the order that makes most known soonest. A view's addition to
/// those before it counts once for each view from there on, which is the area under the curve of known space. A voxel
/// counts with the largest worth that one of them promises. Uses the greedy choice, improved by exchanging single views
/// while that helps. Returns fewer where no other adds anything. Ties go to the lower index. O(rounds · count ·
/// promises · voxels), with at most four rounds.
[[nodiscard]] std::vector<std::size_t> best_sequence(std::span<const Promise> promises, std::size_t count,
                                                     const Executor& executor);

/// Returns the joint worth of promises: a voxel counts once, with the largest worth that one of them promises.
[[nodiscard]] double worth_together(std::span<const Promise> promises);

}  // namespace saccade
