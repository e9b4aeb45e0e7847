// SPDX-License-Identifier: Apache-2.0
// No include guard of the usual kind: files with vector kernels include this once per instruction set.
#if defined(SACCADE_MAP_CELL_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SACCADE_MAP_CELL_LANES_INL
#undef SACCADE_MAP_CELL_LANES_INL
#else
#define SACCADE_MAP_CELL_LANES_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "saccade/map/ray_lanes-inl.hpp"
#include "saccade/map/voxel_block.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::tile_cast::HWY_NAMESPACE {
namespace {

using namespace lanes::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): these kernels use all of it

/// Interval of depths along the rays in which v changes its sign.
struct SignChange {
  VF t0, t1;
  VF v0, v1;
};

/// Results of rays, one per lane, in cells of one brick. Each function is the vector form of the one in cell.hpp that
/// its comment names.
class CellLanes {
 public:
  RayLanes rays;
  std::array<float, 3> brick_lo;  ///< the brick's first voxel, relative to the rays' origin
  const std::int16_t* values;     ///< values of the VoxelBlock

  /// v of two neighbours along x.
  struct Pair {
    VF low;
    VF high;
  };

  /// Corners of the cells, and positions of the rays in them.
  struct CellOfLanes {
    Pair v00, v10, v01, v11;
    std::array<VF, 3> from;  ///< origin of the rays, relative to the cell's lowest corner
  };
  [[nodiscard]] HWY_INLINE CellOfLanes load_cell(VI index) const {
    const VI seven = hn::Set(i_, 7);
    const std::array<VI, 3> at{hn::And(index, seven), hn::And(hn::ShiftRight<3>(index), seven),
                               hn::ShiftRight<6>(index)};
    const auto [v00, v10, v01, v11] =
        pairs_at<4>(in_block(index), {offset(0, 0, 0), offset(0, 1, 0), offset(0, 0, 1), offset(0, 1, 1)});
    CellOfLanes cell{v00, v10, v01, v11, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF p = hn::Add(hn::Set(f_, brick_lo[axis]), hn::ConvertTo(f_, at[axis]));
      cell.from[axis] = hn::Sub(rays.o[axis], p);
    }
    return cell;
  }
  /// Vector form of fraction_at.
  HWY_INLINE void fraction_at(const CellOfLanes& cell, VF t, std::array<VF, 3>& fraction) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF at = hn::Add(cell.from[axis], hn::Mul(t, rays.d[axis]));
      fraction[axis] = hn::Min(hn::Max(at, hn::Zero(f_)), hn::Set(f_, 1.0F));
    }
  }
  [[nodiscard]] HWY_INLINE VF value_at(const CellOfLanes& cell, VF t) const {
    std::array<VF, 3> f;
    fraction_at(cell, t, f);
    return interpolate(cell.v00, cell.v10, cell.v01, cell.v11, f[0], f[1], f[2]);
  }

  /// Second half of cross_cell: finds the zero between entering and leaving, by regula falsi.
  [[nodiscard]] HWY_INLINE VF find_zero(const CellOfLanes& cell, SignChange between) const {
    auto& [t0, t1, v0, v1] = between;
    constexpr int kRootSteps{3};
    for (int i = 1;; ++i) {
      const VF t = hn::Add(t0, hn::Mul(hn::Sub(t1, t0), hn::Div(v0, hn::Sub(v0, v1))));
      if (i == kRootSteps) return t;
      const VF v = value_at(cell, t);
      const M outside = hn::Gt(v, hn::Zero(f_));
      t0 = hn::IfThenElse(outside, t, t0);
      v0 = hn::IfThenElse(outside, v, v0);
      t1 = hn::IfThenElse(outside, t1, t);
      v1 = hn::IfThenElse(outside, v1, v);
    }
  }

  /// Finds ∇v in the cells of some lanes: differences over two voxels, or over the cell's own where a neighbour is
  /// unknown.
  HWY_INLINE void find_gradient(M lanes, VI index, const CellOfLanes& cell, const std::array<VF, 3>& fraction,
                                std::array<VF, 3>& gradient) const {
    const auto& [x, y, z] = fraction;
    const auto& [v00, v10, v01, v11, from] = cell;
    const VI at = in_block(index);
    {
      const auto [l00, l10, l01, l11, h00, h10, h01, h11] =
          pairs_at<8>(at, {offset(-1, 0, 0), offset(-1, 1, 0), offset(-1, 0, 1), offset(-1, 1, 1), offset(1, 0, 0),
                           offset(1, 1, 0), offset(1, 0, 1), offset(1, 1, 1)});
      const M known = hn::And(
          hn::And(hn::And(is_known(l00.low), is_known(l10.low)), hn::And(is_known(l01.low), is_known(l11.low))),
          hn::And(hn::And(is_known(h00.high), is_known(h10.high)), hn::And(is_known(h01.high), is_known(h11.high))));
      gradient[0] = half_difference(interpolate(h00, h10, h01, h11, x, y, z), interpolate(l00, l10, l01, l11, x, y, z));
      settle_unknown(lanes, known, cell, fraction, 0, gradient);
    }
    {
      const auto [l0, l1, h0, h1] =
          pairs_at<4>(at, {offset(0, -1, 0), offset(0, -1, 1), offset(0, 2, 0), offset(0, 2, 1)});
      gradient[1] = half_difference(interpolate(v10, h0, v11, h1, x, y, z), interpolate(l0, v00, l1, v01, x, y, z));
      settle_unknown(lanes, all_known(l0, l1, h0, h1), cell, fraction, 1, gradient);
    }
    {
      const auto [l0, l1, h0, h1] =
          pairs_at<4>(at, {offset(0, 0, -1), offset(0, 1, -1), offset(0, 0, 2), offset(0, 1, 2)});
      gradient[2] = half_difference(interpolate(v01, v11, h0, h1, x, y, z), interpolate(l0, l1, v00, v10, x, y, z));
      settle_unknown(lanes, all_known(l0, l1, h0, h1), cell, fraction, 2, gradient);
    }
  }

 private:
  /// Returns the offset from one voxel to another, in int16 values.
  static constexpr std::ptrdiff_t offset(int x, int y, int z) {
    return (std::ptrdiff_t{z} * VoxelBlock::kEdge + y) * VoxelBlock::kEdge + x;
  }
  /// Reads pairs at some offsets from the lanes' voxels. Lane by lane: gathers take some processors twice as long.
  template <std::size_t kCount>
  HWY_INLINE std::array<Pair, kCount> pairs_at(VI index, const std::array<std::ptrdiff_t, kCount>& offsets) const {
    constexpr std::size_t kLanes{hn::MaxLanes(I{})};
    alignas(64) std::array<std::int32_t, kLanes> at;
    alignas(64) std::array<std::array<std::int32_t, kLanes>, kCount> found;
    hn::Store(index, i_, at.data());
    for (std::size_t lane = 0; lane < hn::Lanes(i_); ++lane) {
      const std::int16_t* const here = values + at[lane];
      for (std::size_t i = 0; i < kCount; ++i) std::memcpy(&found[i][lane], here + offsets[i], sizeof(std::int32_t));
    }
    std::array<Pair, kCount> pairs;
    for (std::size_t i = 0; i < kCount; ++i) {
      const VI both = hn::Load(i_, found[i].data());
      pairs[i] = {hn::ConvertTo(f_, hn::ShiftRight<16>(hn::ShiftLeft<16>(both))),
                  hn::ConvertTo(f_, hn::ShiftRight<16>(both))};
    }
    return pairs;
  }
  /// Returns the index in the block of a cell's lowest corner.
  [[nodiscard]] HWY_INLINE VI in_block(VI index) const {
    const VI seven = hn::Set(i_, 7);
    const VI x = hn::And(index, seven);
    const VI y = hn::And(hn::ShiftRight<3>(index), seven);
    const VI z = hn::ShiftRight<6>(index);
    const VI row =
        hn::Add(hn::Mul(hn::Add(z, hn::Set(i_, 1)), hn::Set(i_, VoxelBlock::kEdge)), hn::Add(y, hn::Set(i_, 1)));
    return hn::Add(hn::Mul(row, hn::Set(i_, VoxelBlock::kEdge)), hn::Add(x, hn::Set(i_, 1)));
  }

  static HWY_INLINE VF mix(VF a, VF b, VF share) { return hn::Add(a, hn::Mul(hn::Sub(b, a), share)); }
  /// Vector form of Cell::at.
  static HWY_INLINE VF interpolate(const Pair& v00, const Pair& v10, const Pair& v01, const Pair& v11, VF x, VF y,
                                   VF z) {
    const VF a = mix(mix(v00.low, v00.high, x), mix(v10.low, v10.high, x), y);
    const VF b = mix(mix(v01.low, v01.high, x), mix(v11.low, v11.high, x), y);
    return mix(a, b, z);
  }

  [[nodiscard]] HWY_INLINE M is_known(VF v) const { return hn::Ne(v, hn::Set(f_, VoxelBlock::kUnknown)); }
  [[nodiscard]] HWY_INLINE M all_known(const Pair& p0, const Pair& p1, const Pair& p2, const Pair& p3) const {
    const auto both = [&](const Pair& p) HWY_ATTR { return hn::And(is_known(p.low), is_known(p.high)); };
    return hn::And(hn::And(both(p0), both(p1)), hn::And(both(p2), both(p3)));
  }
  [[nodiscard]] HWY_INLINE VF half_difference(VF ahead, VF behind) const {
    return hn::Mul(hn::Set(f_, 0.5F), hn::Sub(ahead, behind));
  }
  /// Uses the difference across the cell where neighbours along an axis are unknown.
  HWY_INLINE void settle_unknown(M lanes, M known, const CellOfLanes& cell, std::array<VF, 3> fraction,
                                 std::size_t axis, std::array<VF, 3>& gradient) const {
    if (!any(hn::AndNot(known, lanes))) return;
    const auto side = [&](float at) HWY_ATTR {
      fraction[axis] = hn::Set(f_, at);
      return interpolate(cell.v00, cell.v10, cell.v01, cell.v11, fraction[0], fraction[1], fraction[2]);
    };
    const VF high = side(1.0F);
    gradient[axis] = hn::IfThenElse(known, gradient[axis], hn::Sub(high, side(0.0F)));
  }

  static constexpr F f_{};
  static constexpr I i_{};
};

}  // namespace
}  // namespace saccade::tile_cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per target
