// SPDX-License-Identifier: Apache-2.0
#pragma once
// GraphRoom: memory for the graph of a cloud, and a folder for one that needs more.

#include <cstddef>
#include <filesystem>
#include <limits>

#include "saccade/annotate/neighbourhood.hpp"

namespace saccade {

struct GraphRoom {
  std::size_t memory_bytes{std::numeric_limits<std::size_t>::max()};  ///< a graph that needs more goes to disk
  std::filesystem::path folder{"/var/tmp"};                           ///< for files of it; not a file system in memory

  /// Tells whether the graph of that many points goes to disk.
  [[nodiscard]] bool needs_disk(std::size_t points, const NeighbourhoodConfig& config) const;
};

/// Builds a cloud's graph where there is room for it. A graph on disk is the same one to the bit: its nodes lie in the
/// order of a k-d tree's leaves, so that a path goes through few pages. Errors of Neighbourhood::build and
/// DiskMemory::in; io_failure where the disk has no room.
[[nodiscard]] Result<Neighbourhood> build_graph(const PointCloud& cloud, const NeighbourhoodConfig& config,
                                                const GraphRoom& room, const Executor& executor,
                                                const Progress& progress = {});

}  // namespace saccade
