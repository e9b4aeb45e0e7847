// SPDX-License-Identifier: Apache-2.0
// No include guard of the usual kind: files with vector kernels include this once per instruction set.
// RayLanes: the exact walk of ray_math.hpp for many rays from one origin, one per lane. Each function agrees to the bit
// with the function that its comment names.
#if defined(SACCADE_MAP_RAY_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SACCADE_MAP_RAY_LANES_INL
#undef SACCADE_MAP_RAY_LANES_INL
#else
#define SACCADE_MAP_RAY_LANES_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace saccade::lanes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using M = hn::Mask<F>;

HWY_INLINE bool any(M mask) { return !hn::AllFalse(F{}, mask); }
HWY_INLINE M none() { return hn::Lt(hn::Zero(F{}), hn::Zero(F{})); }
HWY_INLINE M select(M mask, M yes, M no) { return hn::Or(hn::And(mask, yes), hn::AndNot(mask, no)); }

/// Vector form of RayEvent.
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
HWY_INLINE Event earlier(const Event& a, const Event& b) { return select(before(b, a), b, a); }
/// Vector forms of kRayStart and after_depth.
HWY_INLINE Event ray_start() { return {hn::Zero(F{}), hn::Set(I{}, -1)}; }
HWY_INLINE Event past_depth(float t) { return {hn::Set(F{}, t), hn::Set(I{}, 3)}; }

/// Rays from one origin; o, d and inv as in LatticeRay. Planes are relative to the origin's voxel.
struct RayLanes {
  std::array<VF, 3> o;
  std::array<VF, 3> d;
  std::array<VF, 3> inv;
  std::array<M, 3> forward;  ///< LatticeRay::positive

  [[nodiscard]] HWY_INLINE VF crossing(std::size_t axis, VF plane) const {
    return hn::Mul(hn::Sub(plane, o[axis]), inv[axis]);
  }

  /// Vector form of clip: the part of the rays between the planes of a box; `inside` is false where the box lies
  /// behind.
  struct Span {
    M inside;
    Event enter;
    Event exit;
  };
  [[nodiscard]] HWY_INLINE Span clip(const std::array<float, 3>& box_lo, const std::array<float, 3>& box_hi) const {
    const F f;
    const I i;
    const VF zero = hn::Zero(f);
    const VF infinity = hn::Set(f, HUGE_VALF);
    Span span{hn::Eq(zero, zero), ray_start(), {infinity, hn::Set(i, 3)}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF lo = hn::Set(f, box_lo[axis]);
      const VF hi = hn::Set(f, box_hi[axis]);
      const M ahead = select(forward[axis], hn::Gt(hi, zero), hn::Le(lo, zero));
      const M starts_before = select(forward[axis], hn::Gt(lo, zero), hn::Le(hi, zero));
      span.inside = hn::And(span.inside, ahead);
      const Event in{crossing(axis, hn::IfThenElse(forward[axis], lo, hi)), hn::Set(i, static_cast<int>(axis))};
      const Event out{crossing(axis, hn::IfThenElse(forward[axis], hi, lo)), in.axis};
      span.enter = select(hn::And(starts_before, before(span.enter, in)), in, span.enter);
      span.exit = earlier(span.exit, out);
    }
    return span;
  }

  /// Vector form of position_at for the rays of a mask: their position along an axis after all crossings up to and
  /// including the event. It must lie between `lowest` and `highest`, which save some steps of settling.
  [[nodiscard]] HWY_INLINE VF position(std::size_t axis, const Event& event, VF lowest, VF highest, M rays) const {
    const F f;
    const VF zero = hn::Zero(f);
    const VF one = hn::Set(f, 1.0F);
    const VI this_axis = hn::Set(I{}, static_cast<int>(axis));
    // No ray goes back beyond its origin's voxel.
    lowest = hn::IfThenElse(forward[axis], hn::Max(lowest, zero), lowest);
    highest = hn::IfThenElse(forward[axis], highest, hn::Min(highest, zero));
    VF p = hn::Floor(hn::Add(o[axis], hn::Mul(event.t, d[axis])));
    p = hn::Min(hn::Max(p, lowest), highest);
    for (;;) {
      // The planes behind and ahead of the voxel: the first has been crossed, the second has not.
      const VF behind = hn::IfThenElse(forward[axis], p, hn::Add(p, one));
      const VF ahead = hn::IfThenElse(forward[axis], hn::Add(p, one), p);
      const M is_first = hn::Eq(p, hn::IfThenElse(forward[axis], lowest, highest));
      const M is_last = hn::Eq(p, hn::IfThenElse(forward[axis], highest, lowest));
      const M too_far = hn::AndNot(is_first, before(event, {crossing(axis, behind), this_axis}));
      const M too_near = hn::AndNot(hn::Or(is_last, before(event, {crossing(axis, ahead), this_axis})), rays);
      const M wrong = hn::And(rays, hn::Or(too_far, too_near));
      if (!any(wrong)) return p;
      const M up = select(forward[axis], too_near, too_far);
      p = hn::IfThenElse(wrong, hn::IfThenElse(up, hn::Add(p, one), hn::Sub(p, one)), p);
    }
  }
  /// Returns the plane through which a ray leaves voxel p of an axis.
  [[nodiscard]] HWY_INLINE VF plane_ahead(std::size_t axis, VF p) const {
    return hn::Add(p, hn::IfThenElseZero(forward[axis], hn::Set(F{}, 1.0F)));
  }
};

/// Vector form of LatticeWalk: the times at which the rays cross their next plane of each axis.
struct NextPlanes {
  std::array<VF, 3> plane;
  std::array<VF, 3> t;

  struct First {
    Event event;
    M y;  ///< the first event is on axis y, or on z where `z` is set
    M z;
  };
  [[nodiscard]] HWY_INLINE First first() const {
    const I i;
    const M y = hn::Lt(t[1], t[0]);
    const VF earlier_xy = hn::IfThenElse(y, t[1], t[0]);
    const M z = hn::Lt(t[2], earlier_xy);
    const VI axis_xy = hn::IfThenElseZero(hn::RebindMask(i, y), hn::Set(i, 1));
    return {{hn::IfThenElse(z, t[2], earlier_xy), hn::IfThenElse(hn::RebindMask(i, z), hn::Set(i, 2), axis_xy)}, y, z};
  }
  /// Moves the rays of a mask across a plane of an axis; `index` changes by ± stride.
  HWY_INLINE void advance(const RayLanes& rays, std::size_t axis, M crossing, int stride, VI& index) {
    const F f;
    const I i;
    const VF one = hn::Set(f, 1.0F);
    const M forward = rays.forward[axis];
    const VF next = hn::IfThenElse(forward, hn::Add(plane[axis], one), hn::Sub(plane[axis], one));
    const VI by = hn::Set(i, stride);
    const VI moved = hn::IfThenElse(hn::RebindMask(i, forward), hn::Add(index, by), hn::Sub(index, by));
    plane[axis] = hn::IfThenElse(crossing, next, plane[axis]);
    t[axis] = hn::IfThenElse(crossing, rays.crossing(axis, next), t[axis]);
    index = hn::IfThenElse(hn::RebindMask(i, crossing), moved, index);
  }
};

}  // namespace
}  // namespace saccade::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per target
