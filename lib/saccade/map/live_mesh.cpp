// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/mesh.hpp"

#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/internal/mesh_join.hpp"
#include "saccade/map/map_changes.hpp"

namespace saccade {
namespace {

/// Update of one sector from the previous mesh to the next.
struct SectorStep {
  Index3 key;
  const Mask512* stale{nullptr};  ///< nullptr: nothing
  MeshSector* previous{nullptr};  ///< nullptr: it owned nothing
  MeshExtraction::Extracted next;
  std::vector<Index3> replaced;
};

/// Returns the sectors that own something or have stale bricks; both lists and the result are in z-y-x order.
std::vector<SectorStep> steps_of(std::vector<MeshSector>& sectors, const std::vector<SectorBricks>& stale) {
  std::vector<SectorStep> steps;
  auto previous = sectors.begin();
  auto changed = stale.begin();
  while (previous != sectors.end() || changed != stale.end()) {
    const bool has_previous =
        previous != sectors.end() && (changed == stale.end() || !zyx_less(changed->sector, previous->key));
    const bool has_changed =
        changed != stale.end() && (previous == sectors.end() || !zyx_less(previous->key, changed->sector));
    SectorStep& step = steps.emplace_back();
    step.key = has_previous ? previous->key : changed->sector;
    if (has_previous) step.previous = &*previous++;
    if (has_changed) step.stale = &(changed++)->bricks;
  }
  return steps;
}

bool has_triangles(const MeshSector* sector, int child) {
  const MeshBrick* brick = sector == nullptr ? nullptr : sector->find(child);
  return brick != nullptr && brick->triangle_count > 0;
}

void take(const MeshExtraction& extraction, SectorStep& step) {
  if (step.stale == nullptr) {
    step.next.sector = std::move(*step.previous);
    return;
  }
  step.next = extraction.extract(step.key, *step.stale, step.previous);
  step.stale->for_each([&](std::size_t i) {
    const auto child = static_cast<int>(i);
    if (has_triangles(step.previous, child) || has_triangles(&step.next.sector, child)) {
      step.replaced.push_back(step.key * kSectorEdge + child_offset(child));
    }
  });
}

}  // namespace

LiveMesh::LiveMesh(const MeshConfig& config) : config_{config}, sectors_{std::vector<MeshSector>{}} {}

MeshUpdate LiveMesh::update(const TsdfSnapshot& map, const Executor& executor) {
  SACCADE_EXPECTS(map_.grid.empty() || map.config.voxel_size_m == map_.config.voxel_size_m);
  const Stopwatch stopwatch;
  MeshUpdate update;
  const std::vector<SectorBricks> changed = changed_sectors(map_.grid, map.grid, executor);
  for (const SectorBricks& sector : changed) update.bricks_changed += static_cast<std::size_t>(sector.bricks.count());
  const std::vector<SectorBricks> stale = with_neighbors(changed);
  std::vector<SectorStep> steps = steps_of(*sectors_, stale);
  const MeshExtraction extraction{map, config_};
  executor.parallel_for(steps.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) take(extraction, steps[i]);
  });
  std::vector<MeshSector> sectors;
  for (SectorStep& step : steps) {
    update.bricks_extracted += step.next.bricks;
    update.bricks.insert(update.bricks.end(), step.replaced.begin(), step.replaced.end());
    if (!step.next.sector.bricks.empty()) sectors.push_back(std::move(step.next.sector));
  }
  *sectors_ = std::move(sectors);
  map_ = map;
  update.ms = stopwatch.elapsed_ms();
  return update;
}

TriangleMesh LiveMesh::mesh(const Executor& executor) const { return join_mesh(*sectors_, executor); }

TriangleMesh LiveMesh::mesh_of(const Index3& brick) const { return mesh_of_brick(*sectors_, brick); }

}  // namespace saccade
