// SPDX-License-Identifier: Apache-2.0
#pragma once
// spread_in_parallel: thesis Algorithm 8 on several threads.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/annotate/internal/path_buckets.hpp"
#include "saccade/annotate/internal/path_reach.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Continues from a queue until it is empty and no further node gets nearer along an edge. Each thread has its own
/// queue, and takes half of the nearest nodes of another when that is empty. A reach, one per node, is only ever
/// lowered, so the result equals that of one thread in any order. A node is processed again if a slower thread later
/// reaches it along a shorter path; this is rare. Appends the processed nodes to `touched`, with some duplicates, in no
/// particular order.
void spread_in_parallel(const Neighbourhood& neighbourhood, std::span<PathReach> reaches, PathBuckets& queue,
                        const Executor& executor, std::vector<std::uint32_t>& touched);

}  // namespace saccade
