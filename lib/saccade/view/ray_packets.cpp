// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/view/ray_packets.cpp"
#include "saccade/core/simd_kernels.hpp"

#include <bit>

#include "saccade/map/ray_lanes-inl.hpp"
#include "saccade/view/ray_packets.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::view_kernels::HWY_NAMESPACE {
namespace {

using namespace lanes::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): the vocabulary of these kernels

/// Some rays of a packet on their way.
class Walkers {
 public:
  HWY_INLINE Walkers(const RayPacket& packet, std::size_t first, const FlatStops& stops) : stops_{stops} {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF d = hn::Load(f_, packet.d[axis].data() + first);
      const M parallel = hn::Lt(hn::Abs(d), hn::Set(f_, kParallel));
      rays_.o[axis] = hn::Set(f_, packet.origin.fraction[axis]);
      rays_.d[axis] = hn::IfThenZeroElse(parallel, d);
      rays_.inv[axis] = hn::IfThenElse(parallel, hn::Set(f_, HUGE_VALF), hn::Div(hn::Set(f_, 1.0F), d));
      rays_.forward[axis] = hn::Gt(rays_.inv[axis], hn::Zero(f_));
    }
    active_ = hn::FirstN(f_, packet.count - first);
  }

  /// From a slab of voxels to where the rays leave the box of scoring voxels; returns how many are left.
  HWY_INLINE std::size_t start(const RayPacket& packet, float max_t) {
    const Index3& origin = packet.origin.voxel;
    const RayLanes::Span region =
        rays_.clip(planes(stops_.scoring_voxels.lo - origin), planes(stops_.scoring_voxels.hi - origin));
    entered_ = ray_start();
    const auto major = static_cast<std::size_t>(packet.major);
    if (packet.slab > 0) {
      const VF ahead = hn::Set(f_, static_cast<float>(packet.slab));
      const VF plane = hn::IfThenElse(rays_.forward[major], ahead, hn::Sub(hn::Set(f_, 1.0F), ahead));
      entered_ = {rays_.crossing(major, plane), hn::Set(i_, packet.major)};
    }
    exit_ = earlier(past_depth(max_t), region.exit);
    active_ = hn::And(hn::And(active_, region.inside), before(region.enter, region.exit));
    active_ = hn::And(active_, before(entered_, exit_));
    const std::size_t cast = hn::CountTrue(f_, active_);
    if (cast == 0) return 0;
    const Index3 size = stops_.voxels.hi - stops_.voxels.lo;
    const std::array<std::int32_t, 3> strides{1, size.x, size.x * size.y};
    const std::array<std::int32_t, 3> from_lo{origin.x - stops_.voxels.lo.x, origin.y - stops_.voxels.lo.y,
                                              origin.z - stops_.voxels.lo.z};
    const VF far = hn::Set(f_, 4194304.0F);
    voxel_ = hn::Zero(i_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF p = rays_.position(axis, entered_, hn::Neg(far), far, active_);
      next_.plane[axis] = rays_.plane_ahead(axis, p);
      next_.t[axis] = rays_.crossing(axis, next_.plane[axis]);
      const VI stride = hn::Set(i_, strides[axis]);
      voxel_ = hn::Add(voxel_, hn::Mul(hn::Add(hn::ConvertTo(i_, p), hn::Set(i_, from_lo[axis])), stride));
      const M forward = rays_.forward[axis];
      onward_[axis] = hn::IfThenElse(forward, hn::Set(f_, 1.0F), hn::Set(f_, -1.0F));
      stride_[axis] = hn::IfThenElse(hn::RebindMask(i_, forward), stride, hn::Neg(stride));
    }
    voxel_ = hn::IfThenElseZero(hn::RebindMask(i_, active_), voxel_);
    return cast;
  }

  /// Until every ray is stopped or has left; returns those that scored, a bit each.
  HWY_INLINE std::uint64_t walk(float min_t) {
    M scored = none();
    while (any(active_)) {
      const VI bits = bits_of_voxels();
      const M stopped = hn::And(active_, has(bits, FlatStops::kStops));
      if (any(stopped)) {
        const M late_enough = hn::Ge(entered_.t, hn::Set(f_, min_t));
        const M entered = hn::RebindMask(f_, hn::Gt(entered_.axis, hn::Set(i_, -1)));  // not the camera's own voxel
        const M counts = hn::And(hn::And(stopped, has(bits, FlatStops::kScores)), hn::And(late_enough, entered));
        scored = hn::Or(scored, counts);
        active_ = hn::AndNot(stopped, active_);
      }
      step();
    }
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(f_, scored, bytes.data());
    return std::bit_cast<std::uint64_t>(bytes) & ((std::uint64_t{1} << hn::Lanes(f_)) - 1);
  }

 private:
  static std::array<float, 3> planes(const Index3& voxel) {
    return {static_cast<float>(voxel.x), static_cast<float>(voxel.y), static_cast<float>(voxel.z)};
  }

  HWY_INLINE void step() {
    const NextPlanes::First leave = next_.first();
    active_ = hn::And(active_, before(leave.event, exit_));
    cross(0, hn::AndNot(hn::Or(leave.y, leave.z), active_));
    cross(1, hn::AndNot(leave.z, hn::And(leave.y, active_)));
    cross(2, hn::And(leave.z, active_));
    entered_ = select(active_, leave.event, entered_);
  }
  /// NextPlanes::advance.
  HWY_INLINE void cross(std::size_t axis, M rays) {
    next_.plane[axis] = hn::IfThenElse(rays, hn::Add(next_.plane[axis], onward_[axis]), next_.plane[axis]);
    next_.t[axis] = hn::IfThenElse(rays, rays_.crossing(axis, next_.plane[axis]), next_.t[axis]);
    voxel_ = hn::Add(voxel_, hn::IfThenElseZero(hn::RebindMask(i_, rays), stride_[axis]));
  }

  /// Of the voxels the rays are in, in the lowest two bits. They lie in the table: it holds all cameras and the box
  /// that rays end in, so all between.
  [[nodiscard]] HWY_INLINE VI bits_of_voxels() const {
    const VI word = hn::ShiftRight<4>(voxel_);
    const VI words = hn::GatherIndex(i_, reinterpret_cast<const std::int32_t*>(stops_.bits.data()), word);
    const VI place = hn::ShiftLeft<1>(hn::And(voxel_, hn::Set(i_, FlatStops::kVoxelsPerWord - 1)));
    return hn::BitCast(i_, hn::Shr(hn::BitCast(u_, words), hn::BitCast(u_, place)));
  }
  [[nodiscard]] HWY_INLINE static M has(VI bits, std::uint32_t bit) {
    return hn::RebindMask(f_, hn::Ne(hn::And(bits, hn::Set(i_, static_cast<std::int32_t>(bit))), hn::Zero(i_)));
  }

  static constexpr F f_{};
  static constexpr I i_{};
  static constexpr hn::RebindToUnsigned<F> u_{};
  const FlatStops& stops_;
  RayLanes rays_;
  M active_;
  Event entered_;  ///< the voxels that the rays are in
  Event exit_;
  NextPlanes next_;
  std::array<VF, 3> onward_;  ///< ± 1
  std::array<VI, 3> stride_;  ///< ± of the table
  VI voxel_;                  ///< in the table
};

PacketTally cast_packets_simd(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t) {
  PacketTally tally;
  for (std::size_t first = 0; first < packet.count; first += hn::Lanes(F{})) {
    Walkers walkers{packet, first, stops};
    const std::size_t cast = walkers.start(packet, max_t);
    if (cast == 0) continue;
    tally.cast += cast;
    tally.scored |= walkers.walk(min_t) << first;
  }
  return tally;
}

}  // namespace
}  // namespace saccade::view_kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace view_kernels {
namespace {

HWY_EXPORT(cast_packets_simd);

}  // namespace
}  // namespace view_kernels

PacketTally cast_packets(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t) {
  using namespace view_kernels;
  return HWY_DYNAMIC_DISPATCH(cast_packets_simd)(packet, stops, min_t, max_t);
}

}  // namespace saccade
#endif  // HWY_ONCE
