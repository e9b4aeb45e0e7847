// SPDX-License-Identifier: Apache-2.0
#pragma once
// spread_in_parallel: thesis Algorithm 8 by several threads.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/annotate/internal/path_buckets.hpp"
#include "saccade/annotate/internal/path_reach.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Goes on from a queue until it is empty and nothing that follows is nearer along any edge. Each thread has a queue of
/// its own, and takes half of the nearest nodes of another where that is empty. A reach, one per node, is only ever
/// lowered: what comes out is what one thread finds, whoever was first. A node that is reached before a thread that is
/// behind reaches it along a shorter path is gone through again: few are.
/// Appends the nodes that were gone through to `touched`: some of them twice, in no particular order.
void spread_in_parallel(const Neighbourhood& neighbourhood, std::span<PathReach> reaches, PathBuckets& queue,
                        const Executor& executor, std::vector<std::uint32_t>& touched);

}  // namespace saccade
