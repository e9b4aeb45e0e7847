// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/obstacle_kernels.hpp"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/arm/internal/obstacle_kernels.cpp"
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

/// Rows processed between two tests whether farther ones can still matter.
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

/// Coordinates beyond this, in half cells or squared ones, are not decided by the field.
constexpr float kFarthest{1e15F};

/// One coordinate of spheres relative to the field.
struct Coordinate {
  IntVec cell;           ///< within the field
  FloatVec outside;      ///< squared distance from the field
  FloatVec from_centre;  ///< squared distance from the cell's centre to the nearest point of the field
};

HWY_INLINE Coordinate place(FloatVec at_m, float origin_m, float half_cells_per_m, std::int32_t size) {
  const Floats d;
  const Ints di;
  const FloatVec at = hn::Mul(hn::Sub(at_m, hn::Set(d, origin_m)), hn::Set(d, half_cells_per_m));
  const FloatVec inside = hn::Min(hn::Max(at, hn::Zero(d)), hn::Set(d, static_cast<float>(2 * size)));
  // Clamped, so that the index is valid even for a coordinate that is not finite.
  const IntVec cell =
      hn::Min(hn::Max(hn::ConvertTo(di, hn::Mul(inside, hn::Set(d, 0.5F))), hn::Zero(di)), hn::Set(di, size - 1));
  const FloatVec beyond = hn::Sub(at, inside);
  const FloatVec centre = hn::Add(hn::Add(hn::ConvertTo(d, cell), hn::ConvertTo(d, cell)), hn::Set(d, 1.0F));
  const FloatVec offset = hn::Sub(inside, centre);
  return {cell, hn::Mul(beyond, beyond), hn::Mul(offset, offset)};
}

/// Returns the squared distance along one axis from an interval.
HWY_INLINE FloatVec squared_gap(FloatVec at, float lo, float hi) {
  const Floats d;
  const FloatVec gap = hn::Max(hn::Max(hn::Sub(hn::Set(d, lo), at), hn::Sub(at, hn::Set(d, hi))), hn::Zero(d));
  return hn::Mul(gap, gap);
}

/// Returns the squared distance from the nearest fixture, in metres.
HWY_INLINE FloatVec squared_from_fixtures(const FieldView& field, FloatVec x, FloatVec y, FloatVec z) {
  const Floats d;
  FloatVec least = hn::Set(d, kFarthest);
  for (const std::array<float, 6>& box : field.fixtures) {
    const FloatVec squared = hn::Add(hn::Add(squared_gap(x, box[0], box[3]), squared_gap(y, box[1], box[4])),
                                     squared_gap(z, box[2], box[5]));
    least = hn::Min(least, squared);
  }
  return least;
}

/// Returns a slack above the rounding of coordinates and of distances between them, in metres.
HWY_INLINE FloatVec slack_of(const FieldView& field, FloatVec x, FloatVec y, FloatVec z, FloatVec radius) {
  const Floats d;
  const FloatVec magnitude = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Add(hn::Abs(z), hn::Abs(radius)));
  return hn::Add(hn::Mul(magnitude, hn::Set(d, 1e-6F)), hn::Set(d, field.slack / field.half_cells_per_m));
}

/// Result of one look at the field for spheres; in half cells.
struct Look {
  FloatVec outside;      ///< squared distance from the field
  FloatVec distance;     ///< distance of the nearest cell's centre
  FloatVec from_centre;  ///< from there to the nearest point of the field
  FloatVec reach;        ///< radius plus slack
  hn::Mask<Floats> finite;
};

HWY_INLINE Look look_up(const FieldView& field, FloatVec x, FloatVec y, FloatVec z, FloatVec radius) {
  const Floats d;
  const Ints di;
  const float scale = field.half_cells_per_m;
  const Coordinate at_x = place(x, field.origin_m[0], scale, field.size[0]);
  const Coordinate at_y = place(y, field.origin_m[1], scale, field.size[1]);
  const Coordinate at_z = place(z, field.origin_m[2], scale, field.size[2]);
  const IntVec row = hn::Add(hn::Mul(at_z.cell, hn::Set(di, field.size[1])), at_y.cell);
  const IntVec index = hn::Add(hn::Mul(row, hn::Set(di, field.row_stride)), at_x.cell);
  const FloatVec outside = hn::Mul(hn::Add(hn::Add(at_x.outside, at_y.outside), at_z.outside), hn::Set(d, 0.999998F));
  const FloatVec from_centre = hn::Sqrt(hn::Add(hn::Add(at_x.from_centre, at_y.from_centre), at_z.from_centre));
  const FloatVec reach = hn::Add(hn::Mul(radius, hn::Set(d, scale)), hn::Set(d, field.slack));
  const FloatVec farthest = hn::Set(d, kFarthest);
  return {outside, hn::GatherIndex(d, field.distances, index), from_centre, reach,
          hn::And(hn::Lt(outside, farthest), hn::Lt(hn::Abs(reach), farthest))};
}

HWY_INLINE bool asks_for_fixtures(const FieldView& field, FloatVec outside) {
  const Floats d;
  return !field.fixtures.empty() && !hn::AllFalse(d, hn::Gt(outside, hn::Zero(d)));
}

/// Tests points outside the field. Obstacles lie in the field, which is convex. The squared distance is therefore at
/// least that from the field plus that from the field's nearest point to the obstacle.
HWY_INLINE hn::Mask<Floats> clear_of_all(const FieldView& field, FloatVec x, FloatVec y, FloatVec z, FloatVec radius) {
  const Floats d;
  const Look look = look_up(field, x, y, z, radius);
  const FloatVec left = hn::Sub(hn::Mul(look.reach, look.reach), look.outside);
  const FloatVec reach_inside = hn::Sqrt(hn::Max(left, hn::Zero(d)));
  const auto beyond_reach = hn::Gt(look.distance, hn::Add(look.from_centre, reach_inside));
  auto clear = hn::And(look.finite, hn::Or(hn::Lt(left, hn::Zero(d)), beyond_reach));
  if (asks_for_fixtures(field, look.outside)) {
    const FloatVec reach = hn::Add(radius, slack_of(field, x, y, z, radius));
    clear = hn::And(clear, hn::Gt(squared_from_fixtures(field, x, y, z), hn::Mul(reach, reach)));
  }
  return clear;
}

HWY_INLINE FloatVec clearance_from_all(const FieldView& field, FloatVec x, FloatVec y, FloatVec z, FloatVec radius) {
  const Floats d;
  const Look look = look_up(field, x, y, z, radius);
  const FloatVec inside = hn::Max(hn::Sub(look.distance, look.from_centre), hn::Zero(d));
  const FloatVec half_cells = hn::Sqrt(hn::Add(look.outside, hn::Mul(inside, inside)));
  FloatVec distance = hn::Div(half_cells, hn::Set(d, field.half_cells_per_m));
  if (asks_for_fixtures(field, look.outside)) {
    distance = hn::IfThenElse(hn::Gt(look.outside, hn::Zero(d)),
                              hn::Min(distance, hn::Sqrt(squared_from_fixtures(field, x, y, z))), distance);
  }
  distance = hn::Min(distance, hn::Set(d, field.max_distance_m));
  distance = hn::Max(hn::Sub(distance, slack_of(field, x, y, z, radius)), hn::Zero(d));
  return hn::IfThenElse(look.finite, hn::Sub(distance, radius), hn::Set(d, -std::numeric_limits<float>::infinity()));
}

/// Spheres from i on; zeros where none are left.
struct SphereVecs {
  FloatVec x, y, z, radius;
};
HWY_INLINE FloatVec load_some(const float* from, std::size_t left) {
  const Floats d;
  if (left >= hn::Lanes(d)) return hn::LoadU(d, from);
  alignas(64) std::array<float, 16> few{};
  std::copy(from, from + left, few.begin());
  return hn::Load(d, few.data());
}
HWY_INLINE SphereVecs load_spheres(const SphereArrays& from, std::size_t i, std::size_t count) {
  return {load_some(from.x_m + i, count - i), load_some(from.y_m + i, count - i), load_some(from.z_m + i, count - i),
          load_some(from.radius_m + i, count - i)};
}

std::uint64_t perhaps_touching_kernel(const FieldView& field, const SphereArrays& spheres, std::size_t count) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  std::uint64_t undecided{0};
  for (std::size_t i = 0; i < count; i += lanes) {
    const SphereVecs at = load_spheres(spheres, i, count);
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, hn::Not(clear_of_all(field, at.x, at.y, at.z, at.radius)), bits.data());
    const std::uint64_t touching = std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8;
    undecided |= (touching & ((std::uint64_t{1} << lanes) - 1)) << i;
  }
  return count < 64 ? undecided & ((std::uint64_t{1} << count) - 1) : undecided;
}

void clearances_kernel(const FieldView& field, const SphereArrays& spheres, std::size_t count, float* out) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    const SphereVecs at = load_spheres(spheres, i, count);
    const FloatVec clearance = clearance_from_all(field, at.x, at.y, at.z, at.radius);
    if (i + lanes <= count) {
      hn::StoreU(clearance, d, out + i);
    } else {
      alignas(64) std::array<float, 16> few;
      hn::Store(clearance, d, few.data());
      std::copy(few.begin(), few.begin() + static_cast<std::ptrdiff_t>(count - i), out + i);
    }
  }
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
HWY_EXPORT(clearances_kernel);

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

void clearances(const FieldView& field, const SphereArrays& spheres, std::size_t count, float* out) {
  HWY_DYNAMIC_DISPATCH(clearances_kernel)(field, spheres, count, out);
}

}  // namespace saccade::obstacle
#endif  // HWY_ONCE
