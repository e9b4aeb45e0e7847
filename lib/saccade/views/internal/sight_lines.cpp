// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/views/internal/sight_lines.cpp"
#include "saccade/core/simd_kernels.hpp"

#include "saccade/views/internal/sight_lines.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::view_kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// SightLines in registers.
class SightLanes {
 public:
  using D = hn::CappedTag<double, SightLines::kMost>;
  using I = hn::RebindToSigned<D>;
  using V = hn::Vec<D>;
  using VI = hn::Vec<I>;
  using M = hn::Mask<D>;

  HWY_INLINE SightLanes(const SightLines& lines, const SightClasses& classes)
      : lines_{lines},
        words_{reinterpret_cast<const std::int64_t*>(classes.words())},
        place_{load(lines.place)},
        share_{load(lines.share)},
        next_{load(lines.next[0]), load(lines.next[1]), load(lines.next[2])},
        left_{load(lines.left[0]), load(lines.left[1]), load(lines.left[2])},
        met_place_{load(lines.met_place)},
        met_share_{load(lines.met_share)},
        inside_{mask(lines.walking)},
        done_{mask(0)},
        met_{mask(lines.met)},
        returns_{mask(lines.returns)} {}

  HWY_INLINE void save(SightLines& lines) const {
    hn::Store(place_, i_, lines.place.data());
    hn::Store(share_, d_, lines.share.data());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      hn::Store(next_[axis], d_, lines.next[axis].data());
      hn::Store(left_[axis], i_, lines.left[axis].data());
    }
    hn::Store(met_place_, i_, lines.met_place.data());
    hn::Store(met_share_, d_, lines.met_share.data());
    lines.walking = bits(walking());
    lines.met = bits(met_);
    lines.returns = bits(returns_);
  }

  [[nodiscard]] HWY_INLINE M walking() const { return hn::AndNot(done_, inside_); }
  [[nodiscard]] HWY_INLINE std::size_t count() const { return hn::CountTrue(d_, walking()); }

  /// As SightLine::look.
  HWY_INLINE void look() {
    const VI words = hn::GatherIndex(i_, words_, hn::ShiftRight<5>(place_));
    const VI shift = hn::ShiftLeft<1>(hn::And(place_, hn::Set(i_, SightClasses::kPerWord - 1)));
    const VI seen = hn::And(hn::BitCast(i_, hn::Shr(hn::BitCast(u_, words), hn::BitCast(u_, shift))), hn::Set(i_, 3));
    const M fresh = hn::AndNot(met_, walking());
    const M surface = hn::And(walking(), is(seen, SightClass::surface));
    returns_ = hn::Or(returns_, hn::And(surface, met_));
    const M beyond = hn::And(fresh, hn::Gt(share_, load(lines_.past_region)));
    const M blocked = hn::And(fresh, is(seen, SightClass::blocks));
    done_ = hn::Or(hn::Or(done_, surface), hn::Or(beyond, blocked));
    const M meets = hn::AndNot(beyond, hn::And(fresh, is(seen, SightClass::promise)));
    met_place_ = hn::IfThenElse(hn::RebindMask(i_, meets), place_, met_place_);
    met_share_ = hn::IfThenElse(meets, share_, met_share_);
    met_ = hn::Or(met_, meets);
  }

  /// As SightLine::advance. Lines that have ended by a look go on without effect, so that no step waits for the look of
  /// the previous one.
  HWY_INLINE void advance() {
    const M x_first = hn::Le(next_[0], next_[1]);
    const V t_xy = hn::IfThenElse(x_first, next_[0], next_[1]);
    const M z_first = hn::Gt(t_xy, next_[2]);
    const V t = hn::IfThenElse(z_first, next_[2], t_xy);
    const M before_end = hn::And(inside_, hn::Lt(t, load(lines_.end)));
    const M by_xy = hn::AndNot(z_first, before_end);
    const M x_inside = cross(0, hn::And(x_first, by_xy), t);
    const M y_inside = cross(1, hn::AndNot(x_first, by_xy), t);
    const M z_inside = cross(2, hn::And(z_first, before_end), t);
    inside_ = hn::Or(x_inside, hn::Or(y_inside, z_inside));
    share_ = hn::IfThenElse(inside_, t, share_);
  }

 private:
  static HWY_INLINE V load(const SightLines::Lanes<double>& values) { return hn::Load(d_, values.data()); }
  static HWY_INLINE VI load(const SightLines::Lanes<std::int64_t>& values) { return hn::Load(i_, values.data()); }
  static HWY_INLINE M mask(std::uint32_t bits) {
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(bits)};
    return hn::LoadMaskBits(d_, bytes.data());
  }
  static HWY_INLINE std::uint32_t bits(M mask) {
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(d_, mask, bytes.data());
    return bytes[0];
  }
  static HWY_INLINE M is(VI seen, SightClass wanted) {
    return hn::RebindMask(d_, hn::Eq(seen, hn::Set(i_, static_cast<std::int64_t>(wanted))));
  }

  /// Crosses the next plane of an axis; returns the lines that do not leave the box by that.
  HWY_INLINE M cross(std::size_t axis, M lines, V t) {
    const M inside = hn::And(lines, hn::RebindMask(d_, hn::Ne(left_[axis], hn::Zero(i_))));
    const auto inside_i = hn::RebindMask(i_, inside);
    left_[axis] = hn::Sub(left_[axis], hn::IfThenElseZero(inside_i, hn::Set(i_, 1)));
    next_[axis] = hn::IfThenElse(inside, hn::Add(t, load(lines_.between[axis])), next_[axis]);
    place_ = hn::Add(place_, hn::IfThenElseZero(inside_i, load(lines_.move[axis])));
    return inside;
  }

  static constexpr D d_{};
  static constexpr I i_{};
  static constexpr hn::RebindToUnsigned<D> u_{};
  const SightLines& lines_;  ///< what walking does not change
  const std::int64_t* words_;
  VI place_;
  V share_;
  std::array<V, 3> next_;
  std::array<VI, 3> left_;
  VI met_place_;
  V met_share_;
  M inside_;  ///< lines before their ends
  M done_;    ///< lines that have ended by a look
  M met_;
  M returns_;
};

std::size_t lanes_simd() { return hn::Lanes(SightLanes::D{}); }

void walk_simd(SightLines& lines, const SightClasses& classes, std::size_t at_most) {
  SightLanes lanes{lines, classes};
  do {
    lanes.look();
    lanes.advance();
  } while (lanes.count() > at_most);
  lanes.save(lines);
}

}  // namespace
}  // namespace saccade::view_kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace view_kernels {
namespace {

HWY_EXPORT(lanes_simd);
HWY_EXPORT(walk_simd);

}  // namespace
}  // namespace view_kernels

void SightLines::put(std::size_t lane, const SightLine& line) {
  SACCADE_EXPECTS(lane < kMost && (walking >> lane & 1U) == 0 && !line.met_);
  place[lane] = static_cast<std::int64_t>(line.place_);
  share[lane] = line.share_;
  end[lane] = line.end_;
  past_region[lane] = line.past_region_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    next[axis][lane] = line.next_[axis];
    between[axis][lane] = line.between_[axis];
    move[axis][lane] = line.move_[axis];
    left[axis][lane] = line.left_[axis];
  }
  walking |= 1U << lane;
  met &= ~(1U << lane);
  returns &= ~(1U << lane);
}

std::optional<MetVoxel> SightLines::result(std::size_t lane) const {
  if ((met >> lane & 1U) == 0) return std::nullopt;
  return MetVoxel{static_cast<std::size_t>(met_place[lane]), met_share[lane], (returns >> lane & 1U) != 0};
}

void SightLines::walk(const SightClasses& classes, std::size_t at_most) {
  using namespace view_kernels;
  if (walking != 0) HWY_DYNAMIC_DISPATCH(walk_simd)(*this, classes, at_most);
}

std::size_t SightLines::lanes() {
  using namespace view_kernels;
  return HWY_DYNAMIC_DISPATCH(lanes_simd)();
}

}  // namespace saccade
#endif  // HWY_ONCE
