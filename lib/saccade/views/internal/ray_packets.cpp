// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/views/internal/ray_packets.cpp"
#include "saccade/core/simd_kernels.hpp"

#include <algorithm>
#include <utility>

#include "saccade/map/ray_lanes-inl.hpp"
#include "saccade/views/internal/ray_packets.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::view_kernels::HWY_NAMESPACE {
namespace {

using namespace lanes::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): these kernels use all of it

/// Unfinished rays, one per lane.
class Walkers {
 public:
  HWY_INLINE Walkers(const LatticePoint& origin, const FlatStops& stops) : stops_{stops} {
    for (std::size_t axis = 0; axis < 3; ++axis) rays_.o[axis] = hn::Set(f_, origin.fraction[axis]);
    const Index3 size = stops_.voxels.hi - stops_.voxels.lo;
    strides_ = {1, size.x, size.x * size.y};
  }

  /// Starts the packet's rays from `first` on at a slab of voxels, until they leave the box of scoring voxels; returns
  /// how many of them meet it.
  HWY_INLINE std::size_t start(const RayPacket& packet, std::size_t first, float max_t) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF d = hn::Load(f_, packet.d[axis].data() + first);
      const M parallel = hn::Lt(hn::Abs(d), hn::Set(f_, kParallel));
      rays_.d[axis] = hn::IfThenZeroElse(parallel, d);
      rays_.inv[axis] = hn::IfThenElse(parallel, hn::Set(f_, HUGE_VALF), hn::Div(hn::Set(f_, 1.0F), d));
      rays_.forward[axis] = hn::Gt(rays_.inv[axis], hn::Zero(f_));
    }
    const Index3& origin = packet.origin.voxel;
    const RayLanes::Span region =
        rays_.clip(planes(stops_.scoring_voxels.lo - origin), planes(stops_.scoring_voxels.hi - origin));
    Event entered = ray_start();
    const auto major = static_cast<std::size_t>(packet.major);
    if (packet.slab > 0) {
      const VF ahead = hn::Set(f_, static_cast<float>(packet.slab));
      const VF plane = hn::IfThenElse(rays_.forward[major], ahead, hn::Sub(hn::Set(f_, 1.0F), ahead));
      entered = {rays_.crossing(major, plane), hn::Set(i_, packet.major)};
    }
    exit_ = earlier(past_depth(max_t), region.exit);
    active_ = hn::And(hn::FirstN(f_, packet.count - first), hn::And(region.inside, before(region.enter, region.exit)));
    active_ = hn::And(active_, before(entered, exit_));
    const std::size_t cast = hn::CountTrue(f_, active_);
    if (cast == 0) return 0;
    const std::array<std::int32_t, 3> from_lo{origin.x - stops_.voxels.lo.x, origin.y - stops_.voxels.lo.y,
                                              origin.z - stops_.voxels.lo.z};
    const VF far = hn::Set(f_, 4194304.0F);
    voxel_ = hn::Zero(i_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF p = rays_.position(axis, entered, hn::Neg(far), far, active_);
      plane_[axis] = rays_.plane_ahead(axis, p);
      const VI along = hn::Add(hn::ConvertTo(i_, p), hn::Set(i_, from_lo[axis]));
      voxel_ = hn::Add(voxel_, hn::Mul(along, hn::Set(i_, strides_[axis])));
    }
    voxel_ = hn::IfThenElseZero(hn::RebindMask(i_, active_), voxel_);
    entered_t_ = packet.slab > 0 ? entered.t : hn::Set(f_, kNever);
    ray_ = hn::Iota(i_, static_cast<std::int32_t>(first));
    return cast;
  }

  /// Continues with the last of the waiting rays, one per lane.
  HWY_INLINE void go_on(RayQueue& waiting) {
    const std::size_t taken = std::min(waiting.count, hn::Lanes(f_));
    const std::size_t first = waiting.count -= taken;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rays_.inv[axis] = hn::LoadU(f_, waiting.inv[axis].data() + first);
      rays_.forward[axis] = hn::Gt(rays_.inv[axis], hn::Zero(f_));
      plane_[axis] = hn::LoadU(f_, waiting.plane[axis].data() + first);
    }
    active_ = hn::FirstN(f_, taken);
    entered_t_ = hn::LoadU(f_, waiting.entered_t.data() + first);
    exit_ = {hn::LoadU(f_, waiting.exit_t.data() + first), hn::LoadU(i_, waiting.exit_axis.data() + first)};
    voxel_ = hn::IfThenElseZero(hn::RebindMask(i_, active_), hn::LoadU(i_, waiting.voxel.data() + first));
    ray_ = hn::LoadU(i_, waiting.ray.data() + first);
  }

  /// Appends the active rays to the waiting ones.
  HWY_INLINE void wait(RayQueue& waiting) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(rays_.inv[axis], waiting.count, waiting.inv[axis]);
      put(plane_[axis], waiting.count, waiting.plane[axis]);
    }
    put(entered_t_, waiting.count, waiting.entered_t);
    put(exit_.t, waiting.count, waiting.exit_t);
    put(exit_.axis, waiting.count, waiting.exit_axis);
    put(voxel_, waiting.count, waiting.voxel);
    put(ray_, waiting.count, waiting.ray);
    waiting.count += hn::CountTrue(f_, active_);
  }

  /// Walks until at most `at_most` rays are active; returns those that scored. Stopped rays continue meanwhile without
  /// effect, so no step waits for a look-up of the previous one.
  HWY_INLINE M walk(float min_t, std::size_t at_most) {
    const VF counts_from = hn::Set(f_, min_t);
    const VI stops = hn::Set(i_, static_cast<std::int32_t>(FlatStops::kStops));
    const VI scores = hn::Set(i_, static_cast<std::int32_t>(FlatStops::kScores));
    // Local copies: members that a pointer may alias would be written back at every look-up.
    Way x = way(0);
    Way y = way(1);
    Way z = way(2);
    VI voxel = voxel_;
    VF entered_t = entered_t_;
    M active = active_;
    M scored = none();
    M done = none();
    while (hn::CountTrue(f_, hn::AndNot(done, active)) > at_most) {
      const VI bits = bits_of(voxel);
      const M stopped = hn::AndNot(done, hn::And(active, hn::RebindMask(f_, hn::TestBit(bits, stops))));
      const M counts = hn::And(hn::RebindMask(f_, hn::TestBit(bits, scores)), hn::Ge(entered_t, counts_from));
      scored = hn::Or(scored, hn::And(stopped, counts));
      done = hn::Or(done, stopped);
      // As NextPlanes::first, but each axis tests the exit separately.
      const M y_first = hn::Lt(y.t, x.t);
      const VF t_xy = hn::IfThenElse(y_first, y.t, x.t);
      const M z_first = hn::Lt(z.t, t_xy);
      const VF t = hn::IfThenElse(z_first, z.t, t_xy);
      const M by_x = hn::And(hn::Lt(x.t, x.exit_t), hn::AndNot(hn::Or(y_first, z_first), active));
      const M by_y = hn::And(hn::Lt(y.t, y.exit_t), hn::AndNot(z_first, hn::And(y_first, active)));
      const M by_z = hn::And(hn::Lt(z.t, z.exit_t), hn::And(z_first, active));
      active = hn::Or(hn::Or(by_x, by_y), by_z);
      voxel = hn::Add(voxel, hn::Add(x.cross(by_x), hn::Add(y.cross(by_y), z.cross(by_z))));
      entered_t = hn::IfThenElse(active, t, entered_t);
    }
    plane_ = {x.plane, y.plane, z.plane};
    voxel_ = voxel;
    entered_t_ = entered_t;
    active_ = hn::AndNot(done, active);
    return scored;
  }

  /// Returns one bit per ray of the packet.
  [[nodiscard]] HWY_INLINE std::uint64_t bits_of(M rays_in_lanes) const {
    alignas(64) std::array<std::int32_t, hn::MaxLanes(I{})> rays;
    hn::Store(hn::Compress(ray_, hn::RebindMask(i_, rays_in_lanes)), i_, rays.data());
    const std::size_t count = hn::CountTrue(f_, rays_in_lanes);
    std::uint64_t bits{0};
    for (std::size_t i = 0; i < count; ++i) bits |= std::uint64_t{1} << static_cast<unsigned>(rays[i]);
    return bits;
  }

 private:
  static constexpr float kNever{-1.0F};  ///< entered: the camera's own voxel, which does not count

  static std::array<float, 3> planes(const Index3& voxel) {
    return {static_cast<float>(voxel.x), static_cast<float>(voxel.y), static_cast<float>(voxel.z)};
  }

  /// Stores the values of active rays contiguously. (A compressed store takes some processors ten times as long.)
  template <class V, class Values>
  HWY_INLINE void put(V value, std::size_t at, Values& values) const {
    const hn::DFromV<V> d;
    hn::StoreU(hn::Compress(value, hn::RebindMask(d, active_)), d, values.data() + at);
  }

  /// Rays along one axis.
  struct Way {
    VF o;
    VF inv;
    VF onward;  ///< ± 1
    VI stride;  ///< ± the table's stride
    VF exit_t;  ///< upper bound of crossings of this axis before the ray's exit
    VF plane;   ///< next plane
    VF t;       ///< time of its crossing

    /// As NextPlanes::advance; returns the change of the voxel's index.
    HWY_INLINE VI cross(M rays) {
      plane = hn::IfThenElse(rays, hn::Add(plane, onward), plane);
      t = hn::IfThenElse(rays, hn::Mul(hn::Sub(plane, o), inv), t);
      return hn::IfThenElseZero(hn::RebindMask(i_, rays), stride);
    }
  };
  [[nodiscard]] HWY_INLINE Way way(std::size_t axis) const {
    const M forward = rays_.forward[axis];
    const VI stride = hn::Set(i_, strides_[axis]);
    const M wins_tie = hn::RebindMask(f_, hn::Lt(hn::Set(i_, static_cast<std::int32_t>(axis)), exit_.axis));
    return {rays_.o[axis],
            rays_.inv[axis],
            hn::IfThenElse(forward, hn::Set(f_, 1.0F), hn::Set(f_, -1.0F)),
            hn::IfThenElse(hn::RebindMask(i_, forward), stride, hn::Neg(stride)),
            hn::IfThenElse(wins_tie, next_after(exit_.t), exit_.t),
            plane_[axis],
            rays_.crossing(axis, plane_[axis])};
  }
  /// Returns the smallest number above t ≥ 0.
  [[nodiscard]] static HWY_INLINE VF next_after(VF t) {
    const VF positive = hn::Add(t, hn::Zero(f_));  // −0 becomes 0
    return hn::BitCast(f_, hn::Add(hn::BitCast(i_, positive), hn::Set(i_, 1)));
  }

  /// Returns the bits of the rays' voxels, in the lowest two bits. The voxels lie in the table, which holds all
  /// cameras, the box in which rays end, and the space between.
  [[nodiscard]] HWY_INLINE VI bits_of(VI voxel) const {
    const VI word = hn::ShiftRight<4>(voxel);
    const VI words = hn::GatherIndex(i_, reinterpret_cast<const std::int32_t*>(stops_.bits.data()), word);
    const VI place = hn::ShiftLeft<1>(hn::And(voxel, hn::Set(i_, FlatStops::kVoxelsPerWord - 1)));
    return hn::BitCast(i_, hn::Shr(hn::BitCast(u_, words), hn::BitCast(u_, place)));
  }

  static constexpr F f_{};
  static constexpr I i_{};
  static constexpr hn::RebindToUnsigned<F> u_{};
  const FlatStops& stops_;
  std::array<std::int32_t, 3> strides_;  ///< strides of the table
  RayLanes rays_;
  VI ray_;        ///< index in the packet
  M active_;      ///< rays before their exits
  VF entered_t_;  ///< time of entering the current voxel
  Event exit_;
  std::array<VF, 3> plane_;  ///< next planes
  VI voxel_;                 ///< index in the table
};

/// Returns the number of active rays of a vector at which they wait to be joined with those of other vectors.
HWY_INLINE std::size_t few() {
  const std::size_t lanes = hn::Lanes(F{});
  return lanes >= 8 ? lanes / 2 : 0;
}

/// Returns how many rays meet the box of scoring voxels. Calls `ended` with those in the walkers that scored.
template <class Ended>
HWY_INLINE std::uint64_t cast(const RayPacket& packet, float min_t, float max_t, RayQueue& waiting, Walkers& walkers,
                              const Ended& ended) {
  const std::size_t lanes = hn::Lanes(F{});
  std::uint64_t cast{0};
  for (std::size_t first = 0; first < packet.count; first += lanes) {
    const std::size_t started = walkers.start(packet, first, max_t);
    if (started == 0) continue;
    cast += started;
    if (started > few()) ended(walkers.walk(min_t, few()));
    walkers.wait(waiting);
    while (waiting.count >= lanes) {
      walkers.go_on(waiting);
      ended(walkers.walk(min_t, few()));
      walkers.wait(waiting);
    }
  }
  return cast;
}

PacketTally cast_with_others_simd(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t,
                                  RayQueue& waiting) {
  Walkers walkers{packet.origin, stops};
  PacketTally tally;
  tally.cast = cast(packet, min_t, max_t, waiting, walkers,
                    [&](M scored) HWY_ATTR { tally.scored += hn::CountTrue(F{}, scored); });
  return tally;
}

std::uint64_t finish_rays_simd(const LatticePoint& origin, const FlatStops& stops, float min_t, RayQueue& waiting) {
  if (waiting.count == 0) return 0;
  Walkers walkers{origin, stops};
  walkers.go_on(waiting);
  return hn::CountTrue(F{}, walkers.walk(min_t, 0));
}

ScoringRays cast_alone_simd(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t) {
  Walkers walkers{packet.origin, stops};
  RayQueue waiting;
  ScoringRays rays;
  const auto add = [&](M scored) HWY_ATTR { rays.which |= walkers.bits_of(scored); };
  rays.cast = cast(packet, min_t, max_t, waiting, walkers, add);
  if (waiting.count == 0) return rays;
  walkers.go_on(waiting);
  add(walkers.walk(min_t, 0));
  return rays;
}

}  // namespace
}  // namespace saccade::view_kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace view_kernels {
namespace {

HWY_EXPORT(cast_with_others_simd);
HWY_EXPORT(finish_rays_simd);
HWY_EXPORT(cast_alone_simd);

}  // namespace
}  // namespace view_kernels

PacketTally cast_with_others(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t,
                             RayQueue& waiting) {
  using namespace view_kernels;
  return HWY_DYNAMIC_DISPATCH(cast_with_others_simd)(packet, stops, min_t, max_t, waiting);
}

std::uint64_t finish_rays(const LatticePoint& origin, const FlatStops& stops, float min_t, RayQueue& waiting) {
  using namespace view_kernels;
  return HWY_DYNAMIC_DISPATCH(finish_rays_simd)(origin, stops, min_t, waiting);
}

ScoringRays cast_alone(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t) {
  using namespace view_kernels;
  return HWY_DYNAMIC_DISPATCH(cast_alone_simd)(packet, stops, min_t, max_t);
}

}  // namespace saccade
#endif  // HWY_ONCE
