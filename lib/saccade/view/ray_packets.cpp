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
    const Index3 lo = stops_.bricks.lo * kBrickEdge;
    const std::array<std::int32_t, 3> from_lo{origin.x - lo.x, origin.y - lo.y, origin.z - lo.z};
    const VF far = hn::Set(f_, 4194304.0F);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF p = rays_.position(axis, entered_, hn::Neg(far), far, active_);
      next_.plane[axis] = rays_.plane_ahead(axis, p);
      next_.t[axis] = rays_.crossing(axis, next_.plane[axis]);
      voxel_[axis] = hn::Add(hn::ConvertTo(i_, p), hn::Set(i_, from_lo[axis]));
    }
    find_slots();
    return cast;
  }

  /// Until every ray is stopped or has left; returns those that scored, a bit each.
  HWY_INLINE std::uint64_t walk(float min_t) {
    M scored = none();
    while (any(active_)) {
      const VI word = word_index();
      const M stopped = hn::And(active_, has_bit(stops_.stop, word));
      if (any(stopped)) {
        const M late_enough = hn::Ge(entered_.t, hn::Set(f_, min_t));
        const M entered = hn::RebindMask(f_, hn::Gt(entered_.axis, hn::Set(i_, -1)));  // not the camera's own voxel
        const M counts = hn::And(hn::And(stopped, has_bit(stops_.score, word)), hn::And(late_enough, entered));
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
    const std::array<VI, 3> was = voxel_;
    next_.advance(rays_, 0, hn::AndNot(hn::Or(leave.y, leave.z), active_), 1, voxel_[0]);
    next_.advance(rays_, 1, hn::AndNot(leave.z, hn::And(leave.y, active_)), 1, voxel_[1]);
    next_.advance(rays_, 2, hn::And(leave.z, active_), 1, voxel_[2]);
    entered_ = select(active_, leave.event, entered_);
    const VI changed =
        hn::Or(hn::Or(hn::Xor(was[0], voxel_[0]), hn::Xor(was[1], voxel_[1])), hn::Xor(was[2], voxel_[2]));
    if (any(hn::RebindMask(f_, hn::Gt(changed, hn::Set(i_, kBrickEdge - 1))))) find_slots();
  }

  /// Of the rays' bricks. They lie in the tables: these hold all cameras and the box that rays end in, so all between.
  HWY_INLINE void find_slots() {
    const IndexBox& box = stops_.bricks;
    const VI row =
        hn::Add(hn::Mul(hn::ShiftRight<3>(voxel_[2]), hn::Set(i_, box.hi.y - box.lo.y)), hn::ShiftRight<3>(voxel_[1]));
    const VI index = hn::Add(hn::Mul(row, hn::Set(i_, box.hi.x - box.lo.x)), hn::ShiftRight<3>(voxel_[0]));
    const VI safe = hn::IfThenElseZero(hn::RebindMask(i_, active_), index);
    slot_words_ = hn::ShiftLeft<4>(hn::GatherIndex(i_, stops_.slots.data(), safe));
  }
  /// Of the rays' voxels, in the tables of words: two words per slice, the rows 4 … 7 in the second.
  [[nodiscard]] HWY_INLINE VI word_index() const {
    const VI slice = hn::And(voxel_[2], hn::Set(i_, 7));
    const VI half = hn::And(hn::ShiftRight<2>(voxel_[1]), hn::Set(i_, 1));
    return hn::Add(slot_words_, hn::Or(hn::ShiftLeft<1>(slice), half));
  }
  [[nodiscard]] HWY_INLINE M has_bit(const std::vector<std::uint32_t>& words, VI word) const {
    const VI bits = hn::GatherIndex(i_, reinterpret_cast<const std::int32_t*>(words.data()), word);
    const VI row = hn::And(voxel_[1], hn::Set(i_, 3));
    const VI bit = hn::Or(hn::ShiftLeft<3>(row), hn::And(voxel_[0], hn::Set(i_, 7)));
    const VI shifted = hn::BitCast(i_, hn::Shr(hn::BitCast(u_, bits), hn::BitCast(u_, bit)));
    return hn::RebindMask(f_, hn::Ne(hn::And(shifted, hn::Set(i_, 1)), hn::Zero(i_)));
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
  std::array<VI, 3> voxel_;  ///< relative to the first voxel of the tables
  VI slot_words_;            ///< first words of their bricks
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
