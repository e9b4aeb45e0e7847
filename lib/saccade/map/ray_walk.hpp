// SPDX-License-Identifier: Apache-2.0
#pragma once
// LatticeWalk and walk_cells[_from] (voxels, bricks or sectors along a ray), walk_map (sectors, then bricks),
// first_voxel.

#include <optional>

#include "saccade/map/ray_math.hpp"
#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

constexpr int kVoxelLevel{0};
constexpr int kBrickLevel{3};
constexpr int kSectorLevel{6};

/// Walk through the cells of 2^kLevel voxels along a ray: always across the plane with the earliest event.
template <int kLevel>
class LatticeWalk {
 public:
  /// Starts in the cell that holds `voxel`, a voxel of the ray (absolute coordinates).
  SACCADE_HD LatticeWalk(const LatticeRay& ray, const Index3& voxel) : ray_{&ray} {
    const std::int32_t v[3]{voxel.x, voxel.y, voxel.z};
    const std::int32_t origin[3]{ray.origin.x, ray.origin.y, ray.origin.z};
    for (int axis = 0; axis < 3; ++axis) {
      cell_[axis] = v[axis] >> kLevel;
      step_[axis] = ray.positive(axis) ? 1 : -1;
      const std::int32_t ahead = (cell_[axis] + (ray.positive(axis) ? 1 : 0)) * (1 << kLevel);
      plane_[axis] = ahead - origin[axis];
      t_[axis] = ray.crossing(axis, plane_[axis]);
    }
  }

  /// Absolute index at this level.
  [[nodiscard]] SACCADE_HD Index3 cell() const { return {cell_[0], cell_[1], cell_[2]}; }
  /// Returns the event at which the ray leaves the cell.
  [[nodiscard]] SACCADE_HD RayEvent next() const {
    RayEvent event{t_[0], 0};
    if (t_[1] < event.t) event = {t_[1], 1};
    if (t_[2] < event.t) event = {t_[2], 2};
    return event;
  }
  /// Crosses the plane of next().
  SACCADE_HD void step(int axis) {
    if (axis == 0) {
      advance(0);
    } else if (axis == 1) {
      advance(1);
    } else {
      advance(2);
    }
  }

 private:
  SACCADE_HD void advance(int axis) {
    cell_[axis] += step_[axis];
    plane_[axis] += step_[axis] * (1 << kLevel);
    t_[axis] = ray_->crossing(axis, plane_[axis]);
  }

  const LatticeRay* ray_;
  std::int32_t cell_[3];
  std::int32_t step_[3];
  std::int32_t plane_[3];  // next plane, relative to the origin's voxel
  float t_[3];             // time of crossing it
};

/// Calls visit(index, RaySpan) for each cell of 2^kLevel voxels that the ray visits within the span, in order, until it
/// returns true. Returns true if stopped. With kVoxelLevel this is the voxel-by-voxel walk that defines which voxels a
/// ray visits. Coarser levels visit exactly the cells that hold those voxels. The spans join without gaps. `first` is
/// the voxel at span.enter, for callers that know it. O(cells); no allocation.
template <int kLevel, class Visit>
SACCADE_HD bool walk_cells_from(const Index3& first, const LatticeRay& ray, const RaySpan& span, Visit&& visit) {
  if (span.empty()) return false;
  LatticeWalk<kLevel> walk{ray, first};
  RayEvent enter = span.enter;
  for (;;) {
    const RayEvent leave = walk.next();
    const bool last = !before(leave, span.exit);
    if (visit(walk.cell(), RaySpan{enter, last ? span.exit : leave})) return true;
    if (last) return false;
    walk.step(leave.axis);
    enter = leave;
  }
}
template <int kLevel, class Visit>
SACCADE_HD bool walk_cells(const LatticeRay& ray, const RaySpan& span, Visit&& visit) {
  if (span.empty()) return false;
  return walk_cells_from<kLevel>(voxel_at_event(ray, span.enter), ray, span, visit);
}

/// Walks the map. enter_sector(sector index, const Sector*, RaySpan) decides whether to enter a sector (nullptr: all
/// unknown). In sectors that it enters, the walk calls visit_brick(brick index, const Sector*, child index, RaySpan)
/// for the bricks along the ray, which returns true to stop. Returns whether it was stopped. Within a brick, continue
/// with walk_cells<kVoxelLevel> and the brick's span.
template <class EnterSector, class VisitBrick>
bool walk_map(const LatticeRay& ray, const RaySpan& span, const SectorTable& sectors, EnterSector&& enter_sector,
              VisitBrick&& visit_brick) {
  return walk_cells<kSectorLevel>(ray, span, [&](const Index3& index, const RaySpan& in_sector) {
    const Sector* sector = sectors.find(index);
    if (!enter_sector(index, sector, in_sector)) return false;
    return walk_cells<kBrickLevel>(ray, in_sector, [&](const Index3& brick, const RaySpan& in_brick) {
      return visit_brick(brick, sector, child_index(brick), in_brick);
    });
  });
}

/// Voxel states that stop a ray.
struct StopAt {
  bool unknown{true};
  bool occupied{true};
};

/// Voxel met by a ray, its state, and the depth at which the ray enters it.
struct VoxelHit {
  Index3 voxel;
  VoxelState state{VoxelState::unknown};
  float t{0.0F};
};

/// Returns the first voxel of the ray within the span that is unknown or occupied, as asked for (eq. 2.11). Skips empty
/// space by the sectors' summaries and the bricks' masks; the result is that of the voxel-by-voxel walk.
[[nodiscard]] inline std::optional<VoxelHit> first_voxel(const LatticeRay& ray, const RaySpan& span,
                                                         const SectorTable& sectors, const StopAt& stop = {}) {
  std::optional<VoxelHit> hit;
  const auto enter_sector = [&](const Index3&, const Sector* sector, const RaySpan&) {
    return sector != nullptr || stop.unknown;
  };
  const auto visit_brick = [&](const Index3&, const Sector* sector, int child, const RaySpan& in_brick) {
    const bool has_unknown = stop.unknown && (sector == nullptr || sector->has_unknown.test(child));
    const bool has_occupied = stop.occupied && sector != nullptr && sector->has_occupied.test(child);
    if (!has_unknown && !has_occupied) return false;
    const BrickRef* brick = sector == nullptr ? nullptr : &sector->bricks[static_cast<std::size_t>(child)];
    return walk_cells<kVoxelLevel>(ray, in_brick, [&](const Index3& voxel, const RaySpan& in_voxel) {
      const VoxelState state = brick == nullptr ? VoxelState::unknown : state_of(brick->voxel(child_index(voxel)));
      const bool stops =
          (state == VoxelState::unknown && stop.unknown) || (state == VoxelState::occupied && stop.occupied);
      if (stops) hit = VoxelHit{voxel, state, in_voxel.enter.t};
      return stops;
    });
  };
  walk_map(ray, span, sectors, enter_sector, visit_brick);
  return hit;
}

}  // namespace saccade
