// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/map/raycast_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

#include "saccade/map/cell_lanes-inl.hpp"
#include "saccade/map/raycast_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::tile_cast::HWY_NAMESPACE {
namespace {

/// Crossings of lattice planes, ordered by t, then by axis.
struct Event {
  VF t;
  VI axis;
};
HWY_INLINE M before(const Event& a, const Event& b) {
  return hn::Or(hn::Lt(a.t, b.t), hn::And(hn::Eq(a.t, b.t), hn::RebindMask(F{}, hn::Lt(a.axis, b.axis))));
}
HWY_INLINE Event select(M mask, const Event& yes, const Event& no) {
  return {hn::IfThenElse(mask, yes.t, no.t), hn::IfThenElse(hn::RebindMask(I{}, mask), yes.axis, no.axis)};
}

/// Some rays of the tile within one brick.
class Packet {
 public:
  HWY_INLINE Packet(const TileRays& rays, const Index3& lo, const SurfaceBrick& surface, std::size_t first)
      : cells_{surface.cells.words.data()} {
    in_cells_.values = surface.voxels.data();
    in_cells_.brick_lo = {static_cast<float>(lo.x), static_cast<float>(lo.y), static_cast<float>(lo.z)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      in_cells_.o[axis] = hn::Set(f_, rays.o[axis]);
      in_cells_.d[axis] = hn::Load(f_, rays.d[axis].data() + first);
      inv_[axis] = hn::Load(f_, rays.inv[axis].data() + first);
      forward_[axis] = hn::Gt(inv_[axis], hn::Zero(f_));
    }
    const IndexBox& box = surface.box;
    box_lo_ = {static_cast<float>(lo.x + box.lo.x), static_cast<float>(lo.y + box.lo.y),
               static_cast<float>(lo.z + box.lo.z)};
    box_hi_ = {static_cast<float>(lo.x + box.hi.x), static_cast<float>(lo.y + box.hi.y),
               static_cast<float>(lo.z + box.hi.z)};
  }

  /// The rays' part within the box; false when no ray that did not end earlier enters it.
  HWY_INLINE bool enter(float farthest_m, const Event& ended) {
    const VF infinity = hn::Set(f_, HUGE_VALF);
    enter_ = {hn::Zero(f_), hn::Set(i_, -1)};
    exit_ = {infinity, hn::Set(i_, 3)};
    M inside = hn::Eq(infinity, infinity);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF lo = hn::Set(f_, box_lo_[axis]);
      const VF hi = hn::Set(f_, box_hi_[axis]);
      const M ahead = select_mask(forward_[axis], hn::Gt(hi, hn::Zero(f_)), hn::Le(lo, hn::Zero(f_)));
      const M starts_before = select_mask(forward_[axis], hn::Gt(lo, hn::Zero(f_)), hn::Le(hi, hn::Zero(f_)));
      inside = hn::And(inside, ahead);
      const Event in{crossing(axis, hn::IfThenElse(forward_[axis], lo, hi)), hn::Set(i_, static_cast<int>(axis))};
      const Event out{crossing(axis, hn::IfThenElse(forward_[axis], hi, lo)), in.axis};
      enter_ = select(hn::And(starts_before, before(enter_, in)), in, enter_);
      exit_ = select(before(out, exit_), out, exit_);
    }
    const Event limit{hn::Set(f_, farthest_m), hn::Set(i_, 3)};
    exit_ = select(before(limit, exit_), limit, exit_);
    active_ = hn::And(hn::And(inside, before(enter_, exit_)), before(enter_, ended));
    return any(active_);
  }

  /// Walks through the cells until every ray has met the surface or left the box.
  HWY_INLINE void walk() {
    start();
    entered_t_ = enter_.t;
    stopped_ = front_ = hn::Lt(hn::Zero(f_), hn::Zero(f_));
    cell_ = hn::Zero(i_);
    change_ = {hn::Zero(f_), hn::Zero(f_), hn::Zero(f_), hn::Zero(f_)};
    while (any(active_)) {
      // On to the next cell with a surface; rays that are at one wait for the others, since looking costs more than
      // steps.
      M walking = active_;
      M waiting = hn::Lt(hn::Zero(f_), hn::Zero(f_));
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
    in_cells_.find_gradient(cell_, cell, fraction, gradient);
    keep(stopped_, hn::IfThenElseZero(front_, t), hits.t.data());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      keep(front_, fraction[axis], hits.fraction[axis].data());
      keep(front_, gradient[axis], hits.gradient[axis].data());
    }
    keep_int(front_, cell_, hits.cell.data());
    keep_int(front_, hn::Set(i_, static_cast<std::int32_t>(brick)), reinterpret_cast<std::int32_t*>(hits.brick.data()));
  }

 private:
  static HWY_INLINE M select_mask(M mask, M yes, M no) { return hn::Or(hn::And(mask, yes), hn::AndNot(mask, no)); }
  [[nodiscard]] HWY_INLINE VF crossing(std::size_t axis, VF plane) const {
    return hn::Mul(hn::Sub(plane, in_cells_.o[axis]), inv_[axis]);
  }

  /// The cells in which the rays are once every crossing up to and including enter_ has happened: position_at.
  HWY_INLINE void start() {
    index_ = hn::Zero(i_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF zero = hn::Zero(f_);
      const VF one = hn::Set(f_, 1.0F);
      const VI this_axis = hn::Set(i_, static_cast<int>(axis));
      // A ray that starts between the box's planes of an axis comes no further back than its origin's voxel.
      const VF lo = hn::Set(f_, box_lo_[axis]);
      const VF last = hn::Set(f_, box_hi_[axis] - 1.0F);
      const VF lowest = hn::IfThenElse(forward_[axis], hn::Max(lo, zero), lo);
      const VF highest = hn::IfThenElse(forward_[axis], last, hn::Min(last, zero));
      VF p = hn::Floor(hn::Add(in_cells_.o[axis], hn::Mul(enter_.t, in_cells_.d[axis])));
      p = hn::Min(hn::Max(p, lowest), highest);
      for (;;) {
        // The planes before and behind the cell along the ray: the first was crossed, the second was not.
        const VF behind = hn::IfThenElse(forward_[axis], p, hn::Add(p, one));
        const VF ahead = hn::IfThenElse(forward_[axis], hn::Add(p, one), p);
        const M is_first = hn::Eq(p, hn::IfThenElse(forward_[axis], lowest, highest));
        const M is_last = hn::Eq(p, hn::IfThenElse(forward_[axis], highest, lowest));
        const M too_far = hn::AndNot(is_first, before(enter_, {crossing(axis, behind), this_axis}));
        const M too_near =
            hn::AndNot(hn::Or(is_last, before(enter_, {crossing(axis, ahead), this_axis})), hn::Eq(one, one));
        const M wrong = hn::And(active_, hn::Or(too_far, too_near));
        if (!any(wrong)) break;
        const M up = select_mask(forward_[axis], too_near, too_far);
        p = hn::IfThenElse(wrong, hn::IfThenElse(up, hn::Add(p, one), hn::Sub(p, one)), p);
      }
      plane_[axis] = hn::Add(p, hn::IfThenElseZero(forward_[axis], one));
      next_t_[axis] = crossing(axis, plane_[axis]);
      const VI in_brick = hn::ConvertTo(i_, hn::Sub(p, hn::Set(f_, in_cells_.brick_lo[axis])));
      index_ = hn::Add(index_, hn::Mul(in_brick, hn::Set(i_, kStride[axis])));
    }
    index_ = hn::And(index_, hn::Set(i_, kBrickVoxels - 1));  // of rays that are not in the box: anything
  }

  /// Takes rays to their next cells, across the plane that they cross first; returns those that have one.
  HWY_INLINE M step(M rays) {
    const M y_first = hn::Lt(next_t_[1], next_t_[0]);
    const VF earlier = hn::IfThenElse(y_first, next_t_[1], next_t_[0]);
    const M z_first = hn::Lt(next_t_[2], earlier);
    const VI axis_xy = hn::IfThenElseZero(hn::RebindMask(i_, y_first), hn::Set(i_, 1));
    const Event leave{hn::IfThenElse(z_first, next_t_[2], earlier),
                      hn::IfThenElse(hn::RebindMask(i_, z_first), hn::Set(i_, 2), axis_xy)};
    const M moved = hn::And(rays, before(leave, exit_));
    advance<0>(hn::AndNot(hn::Or(y_first, z_first), moved));
    advance<1>(hn::AndNot(z_first, hn::And(y_first, moved)));
    advance<2>(hn::And(z_first, moved));
    entered_t_ = hn::IfThenElse(moved, leave.t, entered_t_);
    return moved;
  }
  template <std::size_t kAxis>
  HWY_INLINE void advance(M rays) {
    const VF one = hn::Set(f_, 1.0F);
    const VF plane = hn::IfThenElse(forward_[kAxis], hn::Add(plane_[kAxis], one), hn::Sub(plane_[kAxis], one));
    const VI stride = hn::Set(i_, kStride[kAxis]);
    const M forward = forward_[kAxis];
    const VI index = hn::IfThenElse(hn::RebindMask(i_, forward), hn::Add(index_, stride), hn::Sub(index_, stride));
    plane_[kAxis] = hn::IfThenElse(rays, plane, plane_[kAxis]);
    next_t_[kAxis] = hn::IfThenElse(rays, crossing(kAxis, plane), next_t_[kAxis]);
    index_ = hn::IfThenElse(hn::RebindMask(i_, rays), index, index_);
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

  /// First half of cross_cell, for the lanes of a mask: whether the sign of v changes between entering and leaving.
  HWY_INLINE void cross(M lanes) {
    const VF t0 = entered_t_;
    const VF t1 = hn::Min(hn::Min(next_t_[0], next_t_[1]), hn::Min(next_t_[2], exit_.t));
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
  std::array<VF, 3> inv_;
  std::array<M, 3> forward_;
  Event enter_, exit_;  ///< of the box
  M active_, stopped_, front_;
  VI index_;                  ///< child_index of the rays' cells
  VF entered_t_;              ///< when they entered them
  std::array<VF, 3> plane_;   ///< the planes that they cross next, relative to the origin's voxel …
  std::array<VF, 3> next_t_;  ///< … and when
  VI cell_;                   ///< in which the ray stopped, …
  SignChange change_;         ///< … and how v changed in it
};

float cast_in_brick_simd(const TileRays& rays, const Index3& lo, const SurfaceBrick& surface, std::uint32_t brick,
                         TileHits& hits) {
  const F f;
  const I i;
  VF farthest = hn::Zero(f);
  for (std::size_t first = 0; first < kTileRays; first += hn::Lanes(f)) {
    Packet packet{rays, lo, surface, first};
    const Event ended{hn::Load(f, hits.brick_t.data() + first), hn::Load(i, hits.brick_axis.data() + first)};
    if (packet.enter(rays.farthest_m, ended)) {
      packet.walk();
      packet.store(first, brick, hits);
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

float cast_in_brick(const TileRays& rays, const Index3& lo, const SurfaceBrick& surface, std::uint32_t brick,
                    TileHits& hits) {
  return HWY_DYNAMIC_DISPATCH(cast_in_brick_simd)(rays, lo, surface, brick, hits);
}

}  // namespace saccade::tile_cast
#endif  // HWY_ONCE
