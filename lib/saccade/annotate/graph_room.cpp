// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/graph_room.hpp"

namespace saccade {

bool GraphRoom::needs_disk(std::size_t points, const NeighbourhoodConfig& config) const {
  return Neighbourhood::building_bytes(points, config) > memory_bytes;
}

Result<Neighbourhood> build_graph(const PointCloud& cloud, const NeighbourhoodConfig& config, const GraphRoom& room,
                                  const Executor& executor, const Progress& progress) {
  SACCADE_CHECK(config.validate());
  if (!room.needs_disk(cloud.positions_m.size(), config)) {
    return Neighbourhood::build(cloud, config, executor, progress);
  }
  SACCADE_TRY(const auto disk, DiskMemory::in(room.folder));
  try {
    return Neighbourhood::build(cloud, config, executor, progress, disk);
  } catch (const DiskFull& full) {
    return Error{Errc::io_failure, full.what(), "the neighbourhood graph"};
  }
}

}  // namespace saccade
