// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/obstacle_kernels.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/robot/obstacle_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::obstacle::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Shorts = hn::CappedTag<std::uint16_t, kRowStep>;
using ShortVec = hn::Vec<Shorts>;
using Floats = hn::CappedTag<float, 16>;
using FloatVec = hn::Vec<Floats>;
using Ints = hn::RebindToSigned<Floats>;
using IntVec = hn::Vec<Ints>;

/// Rows taken between two looks at whether farther ones can still matter.
constexpr int kRowsAtOnce{3};

HWY_INLINE ShortVec min_of_column(const RowWindow& window, ShortVec least, std::size_t i) {
  const Shorts d;
  least = hn::Min(least, hn::LoadU(d, window.middle + i));
  const int farthest = std::max(window.before, window.after);
  for (int k = 1; k <= farthest;) {
    if (hn::AllTrue(d, hn::Eq(hn::Min(least, hn::Set(d, window.costs[k])), least))) break;
    for (const int end = std::min(k + kRowsAtOnce, farthest + 1); k < end; ++k) {
      const ShortVec cost = hn::Set(d, window.costs[k]);
      if (k <= window.before) {
        least = hn::Min(least, hn::SaturatedAdd(hn::LoadU(d, window.middle - k * window.stride + i), cost));
      }
      if (k <= window.after) {
        least = hn::Min(least, hn::SaturatedAdd(hn::LoadU(d, window.middle + k * window.stride + i), cost));
      }
    }
  }
  return least;
}

bool min_across_rows_kernel(const RowWindow& window, const std::uint16_t* limit, std::size_t steps,
                            std::uint16_t* out) {
  const Shorts d;
  ShortVec changed = hn::Zero(d);
  for (std::size_t i = 0; i < steps * kRowStep; i += hn::Lanes(d)) {
    const ShortVec least = min_of_column(window, hn::LoadU(d, limit + i), i);
    changed = hn::Or(changed, hn::Xor(least, hn::LoadU(d, out + i)));
    hn::StoreU(least, d, out + i);
  }
  return !hn::AllTrue(d, hn::Eq(changed, hn::Zero(d)));
}

void root_of_min_across_rows_kernel(const RowWindow& window, const std::uint16_t* limit, std::size_t steps,
                                    float* out) {
  const Shorts d;
  const hn::CappedTag<float, kRowStep> df;
  const hn::Rebind<std::int32_t, decltype(df)> di;
  const hn::Rebind<std::uint16_t, decltype(df)> d_few;
  alignas(64) std::array<std::uint16_t, kRowStep> squared;
  for (std::size_t i = 0; i < steps * kRowStep; i += hn::Lanes(d)) {
    hn::Store(min_of_column(window, hn::LoadU(d, limit + i), i), d, squared.data());
    for (std::size_t k = 0; k < hn::Lanes(d); k += hn::Lanes(df)) {
      const auto wide = hn::PromoteTo(di, hn::LoadU(d_few, squared.data() + k));
      hn::StoreU(hn::Sqrt(hn::ConvertTo(df, wide)), df, out + i + k);
    }
  }
}

/// Beyond this, in half cells or squared ones, the field does not decide.
constexpr float kFarthest{1e15F};

/// One coordinate of spheres against the field.
struct Coordinate {
  IntVec cell;           ///< within the field
  FloatVec outside;      ///< how far beyond the field, squared
  FloatVec from_centre;  ///< from the cell's centre to the nearest point of the field, squared
};

HWY_INLINE Coordinate place(FloatVec at_m, float origin_m, float half_cells_per_m, std::int32_t size) {
  const Floats d;
  const Ints di;
  const FloatVec at = hn::Mul(hn::Sub(at_m, hn::Set(d, origin_m)), hn::Set(d, half_cells_per_m));
  const FloatVec inside = hn::Min(hn::Max(at, hn::Zero(d)), hn::Set(d, static_cast<float>(2 * size)));
  // Whatever becomes of a coordinate that is not finite, the index is one of the field.
  const IntVec cell =
      hn::Min(hn::Max(hn::ConvertTo(di, hn::Mul(inside, hn::Set(d, 0.5F))), hn::Zero(di)), hn::Set(di, size - 1));
  const FloatVec beyond = hn::Sub(at, inside);
  const FloatVec centre = hn::Add(hn::Add(hn::ConvertTo(d, cell), hn::ConvertTo(d, cell)), hn::Set(d, 1.0F));
  const FloatVec offset = hn::Sub(inside, centre);
  return {cell, hn::Mul(beyond, beyond), hn::Mul(offset, offset)};
}

/// Squared distance along one axis from an interval.
HWY_INLINE FloatVec squared_gap(FloatVec at, float lo, float hi) {
  const Floats d;
  const FloatVec gap = hn::Max(hn::Max(hn::Sub(hn::Set(d, lo), at), hn::Sub(at, hn::Set(d, hi))), hn::Zero(d));
  return hn::Mul(gap, gap);
}

HWY_INLINE hn::Mask<Floats> clear_of_fixtures(const FieldView& field, FloatVec x, FloatVec y, FloatVec z,
                                              FloatVec radius) {
  const Floats d;
  auto clear = hn::Eq(radius, radius);
  const FloatVec magnitude = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  const FloatVec slack =
      hn::Add(hn::Mul(magnitude, hn::Set(d, 1e-6F)), hn::Set(d, field.slack / field.half_cells_per_m));
  const FloatVec reach = hn::Add(hn::Mul(radius, hn::Set(d, 1.000001F)), slack);
  const FloatVec reach_squared = hn::Mul(reach, reach);
  for (const std::array<float, 6>& box : field.fixtures) {
    const FloatVec squared = hn::Add(hn::Add(squared_gap(x, box[0], box[3]), squared_gap(y, box[1], box[4])),
                                     squared_gap(z, box[2], box[5]));
    clear = hn::And(clear, hn::Gt(squared, reach_squared));
  }
  return clear;
}

/// For points beyond the field: obstacles lie in the field, which is convex, so the squared distance is at least that
/// from the field plus that from the field's nearest point to the obstacle.
HWY_INLINE hn::Mask<Floats> clear_of_field(const FieldView& field, FloatVec x, FloatVec y, FloatVec z,
                                           FloatVec radius) {
  const Floats d;
  const Ints di;
  const float scale = field.half_cells_per_m;
  const Coordinate at_x = place(x, field.origin_m[0], scale, field.size[0]);
  const Coordinate at_y = place(y, field.origin_m[1], scale, field.size[1]);
  const Coordinate at_z = place(z, field.origin_m[2], scale, field.size[2]);
  const IntVec index = hn::Add(
      hn::Mul(hn::Add(hn::Mul(at_z.cell, hn::Set(di, field.size[1])), at_y.cell), hn::Set(di, field.row_stride)),
      at_x.cell);
  const FloatVec distance = hn::GatherIndex(d, field.distances, index);
  const FloatVec outside = hn::Mul(hn::Add(hn::Add(at_x.outside, at_y.outside), at_z.outside), hn::Set(d, 0.999998F));
  const FloatVec from_centre = hn::Sqrt(hn::Add(hn::Add(at_x.from_centre, at_y.from_centre), at_z.from_centre));
  const FloatVec reach = hn::Add(hn::Mul(radius, hn::Set(d, scale)), hn::Set(d, field.slack));
  const FloatVec left = hn::Sub(hn::Mul(reach, reach), outside);
  const FloatVec reach_inside = hn::Sqrt(hn::Max(left, hn::Zero(d)));
  const auto finite = hn::And(hn::Lt(outside, hn::Set(d, kFarthest)), hn::Lt(reach, hn::Set(d, kFarthest)));
  auto clear = hn::And(finite, hn::Or(hn::Lt(left, hn::Zero(d)), hn::Gt(distance, hn::Add(from_centre, reach_inside))));
  if (!field.fixtures.empty() && !hn::AllFalse(d, hn::Gt(outside, hn::Zero(d)))) {
    clear = hn::And(clear, clear_of_fixtures(field, x, y, z, radius));
  }
  return clear;
}

std::uint64_t perhaps_touching_kernel(const FieldView& field, const SphereArrays& spheres, std::size_t count) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  std::uint64_t undecided{0};
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto load = [&](const float* from) HWY_ATTR {
      if (i + lanes <= count) return hn::LoadU(d, from + i);
      alignas(64) std::array<float, 16> few{};
      std::copy(from + i, from + count, few.begin());
      return hn::Load(d, few.data());
    };
    const auto clear =
        clear_of_field(field, load(spheres.x_m), load(spheres.y_m), load(spheres.z_m), load(spheres.radius_m));
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, hn::Not(clear), bits.data());
    const std::uint64_t touching = std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8;
    undecided |= (touching & ((std::uint64_t{1} << lanes) - 1)) << i;
  }
  return count < 64 ? undecided & ((std::uint64_t{1} << count) - 1) : undecided;
}

}  // namespace
}  // namespace saccade::obstacle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade::obstacle {
namespace {

HWY_EXPORT(min_across_rows_kernel);
HWY_EXPORT(root_of_min_across_rows_kernel);
HWY_EXPORT(perhaps_touching_kernel);

}  // namespace

bool min_across_rows(const RowWindow& window, const std::uint16_t* limit, std::size_t steps, std::uint16_t* out) {
  return HWY_DYNAMIC_DISPATCH(min_across_rows_kernel)(window, limit, steps, out);
}

void root_of_min_across_rows(const RowWindow& window, const std::uint16_t* limit, std::size_t steps, float* out) {
  HWY_DYNAMIC_DISPATCH(root_of_min_across_rows_kernel)(window, limit, steps, out);
}

std::uint64_t perhaps_touching(const FieldView& field, const SphereArrays& spheres, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(perhaps_touching_kernel)(field, spheres, count);
}

}  // namespace saccade::obstacle
#endif  // HWY_ONCE
