// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "saccade/map/internal/mesh_join.hpp"
#include "saccade/map/map_paging.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {
namespace {

constexpr int kBlockBits{2};  // blocks of 4³ sectors

struct BlockLess {
  bool operator()(const Index3& a, const Index3& b) const { return zyx_less(a, b); }
};

/// Returns the sectors of the map by block, in z-y-x order.
std::map<Index3, std::vector<Index3>, BlockLess> blocks_of(const TsdfGrid& grid) {
  std::map<Index3, std::vector<Index3>, BlockLess> blocks;
  for (const Index3& key : grid.sorted_sectors()) {
    blocks[{key.x >> kBlockBits, key.y >> kBlockBits, key.z >> kBlockBits}].push_back(key);
  }
  return blocks;
}

}  // namespace

Result<TriangleMesh> extract_mesh_by_parts(const TsdfSnapshot& map, const Executor& executor,
                                           const MeshConfig& config) {
  std::vector<MeshSector> sectors;
  for (const auto& [block, keys] : blocks_of(map.grid)) {
    const IndexBox near = IndexBox::cube(block * (1 << kBlockBits), 1 << kBlockBits).grown(1);
    SACCADE_TRY(TsdfGrid grid, with_in_memory(map.grid, map.grid.away_in(near), executor));
    const TsdfSnapshot part{map.config, std::move(grid)};
    const MeshExtraction extraction{part, config};
    std::vector<MeshSector> extracted(keys.size());
    executor.parallel_for(keys.size(), 1, [&, keys = std::span{keys}](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        extracted[i] = extraction.extract(keys[i], Mask512::all_set(), nullptr).sector;
      }
    });
    for (MeshSector& sector : extracted) {
      if (!sector.bricks.empty()) sectors.push_back(std::move(sector));
    }
  }
  std::sort(sectors.begin(), sectors.end(),
            [](const MeshSector& a, const MeshSector& b) { return zyx_less(a.key, b.key); });
  return join_mesh(sectors, executor);
}

}  // namespace saccade
