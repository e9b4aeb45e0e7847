// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/map/internal/raycast_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

#include "saccade/map/internal/cell_lanes-inl.hpp"
#include "saccade/map/internal/raycast_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::tile_cast::HWY_NAMESPACE {
namespace {

/// Packet of rays of the tile within one brick.
class Packet {
 public:
  HWY_INLINE Packet(const TileRays& rays, const Index3& lo, const SurfaceBrick& surface, std::size_t first)
      : cells_{surface.cells.words.data()} {
    in_cells_.values = surface.voxels.data();
    in_cells_.brick_lo = {static_cast<float>(lo.x), static_cast<float>(lo.y), static_cast<float>(lo.z)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      in_cells_.rays.o[axis] = hn::Set(f_, rays.o[axis]);
      in_cells_.rays.d[axis] = hn::Load(f_, rays.d[axis].data() + first);
      in_cells_.rays.inv[axis] = hn::Load(f_, rays.inv[axis].data() + first);
      in_cells_.rays.forward[axis] = hn::Gt(in_cells_.rays.inv[axis], hn::Zero(f_));
    }
    const IndexBox& box = surface.box;
    box_lo_ = {static_cast<float>(lo.x + box.lo.x), static_cast<float>(lo.y + box.lo.y),
               static_cast<float>(lo.z + box.lo.z)};
    box_hi_ = {static_cast<float>(lo.x + box.hi.x), static_cast<float>(lo.y + box.hi.y),
               static_cast<float>(lo.z + box.hi.z)};
  }

  /// Finds the part of the rays within the box. Returns false when every ray misses it or ended earlier.
  HWY_INLINE bool enter(float farthest_m, const Event& ended) {
    const RayLanes::Span span = in_cells_.rays.clip(box_lo_, box_hi_);
    enter_ = span.enter;
    exit_ = earlier(span.exit, past_depth(farthest_m));
    active_ = hn::And(hn::And(span.inside, before(enter_, exit_)), before(enter_, ended));
    return any(active_);
  }

  /// Walks through the cells until each ray has met the surface or left the box.
  HWY_INLINE void walk() {
    start();
    entered_t_ = enter_.t;
    stopped_ = front_ = none();
    cell_ = hn::Zero(i_);
    change_ = {hn::Zero(f_), hn::Zero(f_), hn::Zero(f_), hn::Zero(f_)};
    while (any(active_)) {
      // Moves on to the next cell with a surface. Rays that have reached one wait for the others, since a look into a
      // cell costs more than steps.
      M walking = active_;
      M waiting = none();
      for (;;) {
        const M found = hn::And(walking, has_surface());
        waiting = hn::Or(waiting, found);
        walking = step(hn::AndNot(found, walking));
        if (!any(walking)) break;
      }
      active_ = waiting;
      if (!any(active_)) return;
      cross(active_);
      active_ = step(hn::AndNot(stopped_, active_));
    }
  }

  HWY_INLINE void store(std::size_t first, std::uint32_t brick, TileHits& hits) const {
    if (!any(stopped_)) return;
    const auto keep = [&](M mask, VF value, float* to) HWY_ATTR { hn::BlendedStore(value, mask, f_, to + first); };
    const auto keep_int = [&](M mask, VI value, std::int32_t* to)
                              HWY_ATTR { hn::BlendedStore(value, hn::RebindMask(i_, mask), i_, to + first); };
    keep(stopped_, enter_.t, hits.brick_t.data());
    keep_int(stopped_, enter_.axis, hits.brick_axis.data());
    if (!any(front_)) return keep(stopped_, hn::Zero(f_), hits.t.data());
    const auto cell = in_cells_.load_cell(cell_);
    const VF t = in_cells_.find_zero(cell, change_);
    std::array<VF, 3> fraction;
    in_cells_.fraction_at(cell, t, fraction);
    std::array<VF, 3> gradient;
    in_cells_.find_gradient(front_, cell_, cell, fraction, gradient);
    keep(stopped_, hn::IfThenElseZero(front_, t), hits.t.data());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      keep(front_, fraction[axis], hits.fraction[axis].data());
      keep(front_, gradient[axis], hits.gradient[axis].data());
    }
    keep_int(front_, cell_, hits.cell.data());
    keep_int(front_, hn::Set(i_, static_cast<std::int32_t>(brick)), reinterpret_cast<std::int32_t*>(hits.brick.data()));
  }

 private:
  /// Finds the first cells that the rays enter.
  HWY_INLINE void start() {
    index_ = hn::Zero(i_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF p =
          in_cells_.rays.position(axis, enter_, hn::Set(f_, box_lo_[axis]), hn::Set(f_, box_hi_[axis] - 1.0F), active_);
      next_.plane[axis] = in_cells_.rays.plane_ahead(axis, p);
      next_.t[axis] = in_cells_.rays.crossing(axis, next_.plane[axis]);
      const VI in_brick = hn::ConvertTo(i_, hn::Sub(p, hn::Set(f_, in_cells_.brick_lo[axis])));
      index_ = hn::Add(index_, hn::Mul(in_brick, hn::Set(i_, kStride[axis])));
    }
    index_ = hn::And(index_, hn::Set(i_, kBrickVoxels - 1));  // arbitrary for rays outside the box
  }

  /// Moves rays to their next cells; returns the rays that have one.
  HWY_INLINE M step(M rays) {
    const NextPlanes::First leave = next_.first();
    const M moved = hn::And(rays, before(leave.event, exit_));
    next_.advance(in_cells_.rays, 0, hn::AndNot(hn::Or(leave.y, leave.z), moved), kStride[0], index_);
    next_.advance(in_cells_.rays, 1, hn::AndNot(leave.z, hn::And(leave.y, moved)), kStride[1], index_);
    next_.advance(in_cells_.rays, 2, hn::And(leave.z, moved), kStride[2], index_);
    entered_t_ = hn::IfThenElse(moved, leave.event.t, entered_t_);
    return moved;
  }

  [[nodiscard]] HWY_INLINE M has_surface() const {
    const auto* words = reinterpret_cast<const std::int32_t*>(cells_);
    VI word;
    if constexpr (hn::MaxLanes(I{}) == 16) {
      word = hn::TableLookupLanes(hn::LoadU(i_, words), hn::IndicesFromVec(i_, hn::ShiftRight<5>(index_)));
    } else {
      word = hn::GatherIndex(i_, words, hn::ShiftRight<5>(index_));
    }
    const VI bit = hn::And(index_, hn::Set(i_, 31));
    const VI shifted = hn::BitCast(i_, hn::Shr(hn::BitCast(u_, word), hn::BitCast(u_, bit)));
    return hn::RebindMask(f_, hn::Ne(hn::And(shifted, hn::Set(i_, 1)), hn::Zero(i_)));
  }

  /// First half of cross_cell for the lanes of a mask: tells whether the sign of v changes between entering and
  /// leaving.
  HWY_INLINE void cross(M lanes) {
    const VF t0 = entered_t_;
    const VF t1 = hn::Min(next_.first().event.t, exit_.t);
    const auto cell = in_cells_.load_cell(index_);
    const VF v0 = in_cells_.value_at(cell, t0);
    const VF v1 = in_cells_.value_at(cell, t1);
    const M enters_outside = hn::Gt(v0, hn::Zero(f_));
    const M stops = hn::And(lanes, hn::Xor(enters_outside, hn::Gt(v1, hn::Zero(f_))));
    stopped_ = hn::Or(stopped_, stops);
    front_ = hn::Or(front_, hn::And(stops, enters_outside));
    cell_ = hn::IfThenElse(hn::RebindMask(i_, stops), index_, cell_);
    change_ = {hn::IfThenElse(stops, t0, change_.t0), hn::IfThenElse(stops, t1, change_.t1),
               hn::IfThenElse(stops, v0, change_.v0), hn::IfThenElse(stops, v1, change_.v1)};
  }

  static constexpr std::array<int, 3> kStride{1, kBrickEdge, kBrickEdge* kBrickEdge};
  static constexpr F f_{};
  static constexpr I i_{};
  static constexpr hn::RebindToUnsigned<F> u_{};
  const std::uint64_t* cells_;
  std::array<float, 3> box_lo_;  ///< planes of the box around the cells
  std::array<float, 3> box_hi_;
  CellLanes in_cells_;
  Event enter_, exit_;  ///< where the rays enter and leave the box
  M active_, stopped_, front_;
  VI index_;      ///< child_index of the rays' cells
  VF entered_t_;  ///< depth at which they entered them
  NextPlanes next_;
  VI cell_;            ///< cell in which the ray stopped, …
  SignChange change_;  ///< … and how v changed in it
};

float cast_in_brick_simd(const TileRays& rays, const Index3& lo, const SurfaceBrick& surface,
                         const SurfaceTiles::Entry& entry, TileHits& hits) {
  const F f;
  const I i;
  VF farthest = hn::Zero(f);
  for (std::size_t first = 0; first < kTileRays; first += hn::Lanes(f)) {
    const Event ended{hn::Load(f, hits.brick_t.data() + first), hn::Load(i, hits.brick_axis.data() + first)};
    const bool in_block = ((entry.blocks >> (first / SurfaceTiles::kBlockRays)) & 1) != 0;
    if (in_block && any(hn::Ge(ended.t, hn::Set(f, entry.nearest_m)))) {
      Packet packet{rays, lo, surface, first};
      if (packet.enter(rays.farthest_m, ended)) {
        packet.walk();
        packet.store(first, entry.brick, hits);
      }
    }
    farthest = hn::Max(farthest, hn::Load(f, hits.brick_t.data() + first));
  }
  return hn::GetLane(hn::MaxOfLanes(f, farthest));
}

}  // namespace
}  // namespace saccade::tile_cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade::tile_cast {
namespace {

HWY_EXPORT(cast_in_brick_simd);

}  // namespace

float cast_in_brick(const TileRays& rays, const Index3& lo, const SurfaceBrick& surface,
                    const SurfaceTiles::Entry& entry, TileHits& hits) {
  return HWY_DYNAMIC_DISPATCH(cast_in_brick_simd)(rays, lo, surface, entry, hits);
}

}  // namespace saccade::tile_cast
#endif  // HWY_ONCE
