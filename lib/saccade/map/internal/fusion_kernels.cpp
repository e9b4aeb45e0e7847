// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/fusion_kernels.hpp"

#include <bit>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/map/internal/fusion_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::fusion::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Whole vectors of floats fill a slice of a brick: 1 to 16 lanes, a power of two. Products and sums stay separate,
// because a fused multiply-add rounds once where tsdf_math.hpp rounds twice.
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::int16_t, Floats>;
using Words = hn::Rebind<std::uint16_t, Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
using FloatMask = hn::Mask<Floats>;

constexpr float kInfinity{std::numeric_limits<float>::infinity()};
constexpr std::size_t kSlice{kBrickEdge * kBrickEdge};

/// Returns lane i of the mask as bit i.
template <class D>
HWY_INLINE std::uint64_t bits_of(D d, hn::Mask<D> mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  return std::bit_cast<std::uint64_t>(bytes) & ((std::uint64_t{1} << hn::Lanes(d)) - 1);
}

struct Float3Vec {
  FloatVec x;
  FloatVec y;
  FloatVec z;
};

HWY_INLINE Float3Vec scaled(const tsdf::Float3& a, FloatVec factor) {
  const Floats d;
  return {hn::Mul(hn::Set(d, a.x), factor), hn::Mul(hn::Set(d, a.y), factor), hn::Mul(hn::Set(d, a.z), factor)};
}

/// x and y of the 64 voxels of a slice.
struct SliceOffsets {
  alignas(kVectorBytes) std::array<float, kSlice> x;
  alignas(kVectorBytes) std::array<float, kSlice> y;
};
constexpr SliceOffsets kSliceOffsets = [] {
  SliceOffsets offsets{};
  for (std::size_t i = 0; i < kSlice; ++i) {
    const std::size_t y = i / kBrickEdge;
    offsets.x[i] = static_cast<float>(i % kBrickEdge);
    offsets.y[i] = static_cast<float>(y);
  }
  return offsets;
}();

/// Returns the sum of tsdf::voxel_in_camera, in its order.
HWY_INLINE Float3Vec voxels_in_camera(const tsdf::Float3& slice_origin, const Float3Vec& y, const Float3Vec& x) {
  const Floats d;
  return {hn::Add(hn::Add(hn::Set(d, slice_origin.x), y.x), x.x),
          hn::Add(hn::Add(hn::Set(d, slice_origin.y), y.y), x.y),
          hn::Add(hn::Add(hn::Set(d, slice_origin.z), y.z), x.z)};
}

/// Rounds as round_to_even of tsdf_math.hpp does, to an integer: the last bits of the sum.
HWY_INLINE IntVec round_to_even(FloatVec x) {
  const Floats d;
  const Ints di;
  const FloatVec magic = hn::Set(d, 12582912.0F);
  return hn::Sub(hn::BitCast(di, hn::Add(x, magic)), hn::BitCast(di, magic));
}

/// Returns the integer part of 0 ≤ x < 2²². (ConvertTo would spend instructions on numbers that do not fit.)
HWY_INLINE IntVec whole_part(FloatVec x) { return round_to_even(hn::Floor(x)); }

/// Returns tsdf::pixel_of as an index into the image; 0 where not `inside`. With kInside, `inside` is not tested.
template <bool kInside>
HWY_INLINE IntVec pixel_of(const tsdf::FusionCamera& camera, const Float3Vec& p, FloatMask& inside) {
  const Floats d;
  const Ints di;
  const FloatVec zero = hn::Zero(d);
  const FloatVec half = hn::Set(d, 0.5F);
  const FloatVec inv_z = hn::Div(hn::Set(d, 1.0F), p.z);
  const FloatVec u = hn::Add(hn::Add(hn::Mul(hn::Set(d, camera.fx), hn::Mul(p.x, inv_z)), hn::Set(d, camera.cx)), half);
  const FloatVec v = hn::Add(hn::Add(hn::Mul(hn::Set(d, camera.fy), hn::Mul(p.y, inv_z)), hn::Set(d, camera.cy)), half);
  const auto index = [&](FloatVec column, FloatVec row) HWY_ATTR {
    return hn::Add(hn::Mul(whole_part(row), hn::Set(di, camera.width)), whole_part(column));
  };
  if constexpr (kInside) {
    inside = hn::Eq(zero, zero);
    return index(u, v);
  }
  const FloatMask u_inside = hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, static_cast<float>(camera.width))));
  const FloatMask v_inside = hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, static_cast<float>(camera.height))));
  inside = hn::And(hn::Gt(p.z, hn::Set(d, tsdf::kNearestZ)), hn::And(u_inside, v_inside));
  return index(hn::IfThenElseZero(inside, u), hn::IfThenElseZero(inside, v));
}

/// Returns tsdf::sample_voxel where `inside`, otherwise kNotSeen.
HWY_INLINE IntVec sample_voxels(const tsdf::FusionCamera& camera, const Float3Vec& p, FloatVec range,
                                FloatMask inside) {
  const Floats d;
  const Ints di;
  const FloatVec one = hn::Set(d, 1.0F);
  const FloatVec zero = hn::Zero(d);
  const FloatVec distance = hn::Sqrt(hn::Add(hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y)), hn::Mul(p.z, p.z)));
  const FloatVec sdf = hn::Sub(range, distance);  // eq. 2.1
  // Below −1 there is no hit, and rounding takes −1 and a few ulp to −32767.
  const FloatVec below_one = hn::Min(hn::Mul(sdf, hn::Set(d, camera.inv_truncation)), one);
  const IntVec sample = round_to_even(hn::Mul(below_one, hn::Set(d, 32767.0F)));
  const FloatMask hit = hn::And(inside, hn::And(hn::Gt(range, zero), hn::Ge(sdf, hn::Set(d, -camera.truncation_m))));
  const FloatMask seen_free = hn::And(inside, hn::And(hn::Lt(range, zero), hn::Le(distance, hn::Neg(range))));
  const IntVec not_hit =
      hn::IfThenElse(hn::RebindMask(di, seen_free), hn::Set(di, tsdf::kSampleOne), hn::Set(di, tsdf::kNotSeen));
  return hn::IfThenElse(hn::RebindMask(di, hit), sample, not_hit);
}

/// Returns tsdf::sample_voxel for voxels that can only be seen as free.
HWY_INLINE IntVec sample_free(FloatVec range, FloatMask inside) {
  const Floats d;
  const Ints di;
  const FloatMask seen = hn::And(inside, hn::Ne(range, hn::Zero(d)));
  return hn::IfThenElse(hn::RebindMask(di, seen), hn::Set(di, tsdf::kSampleOne), hn::Set(di, tsdf::kNotSeen));
}

/// Computes the masks of the samples.
HWY_INLINE void mark_samples(BrickSamples& out) {
  const hn::CappedTag<std::int16_t, 32> d;
  const auto not_seen = hn::Set(d, tsdf::kNotSeen);
  const auto one = hn::Set(d, tsdf::kSampleOne);
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    std::uint64_t seen{0};
    std::uint64_t surface{0};
    for (std::size_t first = 0; first < kSlice; first += hn::Lanes(d)) {
      const auto sample = hn::Load(d, out.samples.data() + z * kSlice + first);
      const auto is_seen = hn::Ne(sample, not_seen);
      seen |= bits_of(d, is_seen) << first;
      surface |= bits_of(d, hn::AndNot(hn::Eq(sample, one), is_seen)) << first;
    }
    out.seen.words[z] = seen;
    out.surface.words[z] = surface;
  }
}

/// Fills in the samples of known octants; leaves the others unchanged.
void fill_known(KnownOctants known, BrickSamples& out) {
  constexpr std::size_t kHalf{kBrickEdge / 2};
  for (std::size_t octant = 0; octant < kOctants; ++octant) {
    const bool free = ((known.free >> octant) & 1U) != 0;
    if (!free && ((known.hidden >> octant) & 1U) == 0) continue;
    std::array<std::int16_t, kHalf> row;
    row.fill(static_cast<std::int16_t>(free ? tsdf::kSampleOne : tsdf::kNotSeen));
    std::int16_t* first = out.samples.data() + (octant & 1) * kHalf + (octant >> 1 & 1) * kHalf * kBrickEdge +
                          (octant >> 2) * kHalf * kSlice;
    for (std::size_t z = 0; z < kHalf; ++z) {
      for (std::size_t y = 0; y < kHalf; ++y) std::memcpy(first + z * kSlice + y * kBrickEdge, row.data(), sizeof(row));
    }
  }
}

/// Samples the voxels. Octants come in pairs along x, as lanes do; a pair is skipped when both are known.
template <bool kInside>
HWY_INLINE void sample_voxels_of_brick(const tsdf::FusionCamera& camera_in, const tsdf::BrickFrame& frame,
                                       const float* ranges, KnownOctants known, BrickSamples& out) {
  const unsigned wanted = ~(unsigned{known.free} | unsigned{known.hidden});
  const unsigned hits = wanted & ~unsigned{known.free_or_unseen};
  const Floats d;
  const Ints di;
  const Shorts d16;
  const tsdf::FusionCamera camera = camera_in;  // a local copy stays in registers
  std::array<tsdf::Float3, kBrickEdge> slice_origins;
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    const auto fz = static_cast<float>(z);
    slice_origins[z] = {frame.origin.x + frame.step_z.x * fz, frame.origin.y + frame.step_z.y * fz,
                        frame.origin.z + frame.step_z.z * fz};
  }
  for (std::size_t first = 0; first < kSlice; first += hn::Lanes(d)) {
    const Float3Vec y = scaled(frame.step_y, hn::Load(d, kSliceOffsets.y.data() + first));
    const Float3Vec x = scaled(frame.step_x, hn::Load(d, kSliceOffsets.x.data() + first));
    const std::size_t first_octant = first < kSlice / 2 ? 0 : 2;
    for (std::size_t z = 0; z < kBrickEdge; ++z) {
      const std::size_t pair = first_octant + (z < kBrickEdge / 2 ? 0 : 4);
      if (((wanted >> pair) & 3U) == 0) continue;
      const Float3Vec p = voxels_in_camera(slice_origins[z], y, x);
      FloatMask inside;
      const IntVec pixel = pixel_of<kInside>(camera, p, inside);
      const FloatVec range = hn::GatherIndex(d, ranges, pixel);
      const IntVec sample =
          ((hits >> pair) & 3U) != 0 ? sample_voxels(camera, p, range, inside) : sample_free(range, inside);
      const std::size_t i = z * kSlice + first;
      hn::Store(pixel, di, out.pixels.data() + i);
      hn::Store(hn::DemoteTo(d16, sample), d16, out.samples.data() + i);
    }
  }
}

void sample_brick_kernel(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, const float* ranges,
                         bool inside, KnownOctants known, BrickSamples& out) {
  inside ? sample_voxels_of_brick<true>(camera, frame, ranges, known, out)
         : sample_voxels_of_brick<false>(camera, frame, ranges, known, out);
  fill_known(known, out);
  mark_samples(out);
}

void update_brick_kernel(const std::array<std::int16_t, kBrickVoxels>& samples, const Mask512& seen,
                         std::uint16_t max_weight, std::uint16_t free_weight, float clearing_share, DenseBrick& brick) {
  const Floats d;
  const Ints di;
  const Shorts d16;
  const Words dw;
  const IntVec one = hn::Set(di, 1);
  const IntVec free = hn::Set(di, tsdf::kSampleOne);
  const FloatVec share = hn::Set(d, clearing_share);
  const IntVec zero = hn::Zero(di);
  const std::uint64_t all_lanes = (std::uint64_t{1} << hn::Lanes(d)) - 1;
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    std::uint64_t unknown = brick.unknown.words[z];
    std::uint64_t occupied = brick.occupied.words[z];
    for (std::size_t first = 0; first < kSlice; first += hn::Lanes(d)) {
      const std::uint64_t lanes = all_lanes << first;
      if ((seen.words[z] & lanes) == 0) continue;
      const std::size_t i = z * kSlice + first;
      const IntVec sample = hn::PromoteTo(di, hn::Load(d16, samples.data() + i));
      const IntVec old_v = hn::PromoteTo(di, hn::LoadU(d16, brick.v.data() + i));
      const IntVec old_w = hn::PromoteTo(di, hn::LoadU(dw, brick.w.data() + i));
      // tsdf::clearing_sample
      const IntVec way = round_to_even(hn::Mul(hn::ConvertTo(d, hn::Sub(free, old_v)), share));
      const auto clears = hn::And(hn::Eq(sample, free), hn::Gt(old_w, zero));
      const IntVec counts_as = hn::IfThenElse(clears, hn::Add(old_v, way), sample);
      const IntVec counted = hn::Add(old_w, one);
      const IntVec numerator = hn::Add(hn::Mul(old_v, old_w), counts_as);  // eq. 2.2
      const IntVec average = round_to_even(hn::Div(hn::ConvertTo(d, numerator), hn::ConvertTo(d, counted)));
      const IntVec limit = hn::IfThenElse(hn::Eq(average, free), hn::Set(di, free_weight), hn::Set(di, max_weight));
      const auto is_seen = hn::Ne(sample, hn::Set(di, tsdf::kNotSeen));
      const IntVec v = hn::IfThenElse(is_seen, average, old_v);
      const IntVec w = hn::IfThenElse(is_seen, hn::Min(counted, limit), old_w);  // eq. 2.3
      hn::StoreU(hn::DemoteTo(d16, v), d16, brick.v.data() + i);
      hn::StoreU(hn::DemoteTo(dw, w), dw, brick.w.data() + i);
      const auto known = hn::Gt(w, zero);
      unknown = (unknown & ~lanes) | (lanes & ~(bits_of(di, known) << first));
      occupied = (occupied & ~lanes) | (bits_of(di, hn::AndNot(hn::Gt(v, zero), known)) << first);
    }
    brick.unknown.words[z] = unknown;
    brick.occupied.words[z] = occupied;
  }
}

/// Computes columns [first, end) of ranges_of_row in whole vectors; returns where it stopped.
template <class D>
HWY_INLINE int ranges_of_columns(D d, int first, const RayLengths& rays, float dy_squared, const float* depths_m,
                                 float* ranges_m, const ColumnBounds& bounds, std::size_t& returns) {
  const auto zero = hn::Zero(d);
  const auto min_range = hn::Set(d, rays.min_range_m);
  const auto max_range = hn::Set(d, rays.max_range_m);
  const auto truncation = hn::Set(d, rays.truncation_m);
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (; first + lanes <= rays.width; first += lanes) {
    const auto depth = hn::LoadU(d, depths_m + first);
    const auto returned = hn::And(hn::Ge(depth, min_range), hn::Le(depth, max_range));
    const auto free_up_to = hn::IfThenElseZero(hn::Lt(depth, zero), hn::Max(depth, hn::Neg(max_range)));  // −∞ included
    const auto trusted = hn::IfThenElse(returned, depth, free_up_to);
    const auto length_squared =
        hn::Add(hn::Add(hn::LoadU(d, rays.dx_squared + first), hn::Set(d, dy_squared)), hn::Set(d, 1.0F));
    const auto range = hn::Mul(trusted, hn::Sqrt(length_squared));
    hn::StoreU(range, d, ranges_m + first);
    returns += hn::CountTrue(d, returned);
    const auto hit = hn::Gt(range, zero);
    const auto clear_of_free = hn::IfThenElse(hn::Lt(range, zero), hn::Neg(range), hn::Set(d, kInfinity));
    const auto clear = hn::IfThenElse(hit, hn::Max(zero, hn::Sub(range, truncation)), clear_of_free);
    const auto reach = hn::IfThenElse(hit, hn::Add(range, truncation), hn::Neg(range));
    hn::StoreU(hn::Min(hn::LoadU(d, bounds.clear_m + first), clear), d, bounds.clear_m + first);
    hn::StoreU(hn::Max(hn::LoadU(d, bounds.reach_m + first), reach), d, bounds.reach_m + first);
    hn::StoreU(hn::Min(hn::LoadU(d, bounds.nearest_m + first), hn::Abs(range)), d, bounds.nearest_m + first);
  }
  return first;
}

std::size_t ranges_of_row_kernel(const RayLengths& rays, float dy_squared, const float* depths_m, float* ranges_m,
                                 const ColumnBounds& bounds) {
  std::size_t returns{0};
  const int rest = ranges_of_columns(Floats{}, 0, rays, dy_squared, depths_m, ranges_m, bounds, returns);
  ranges_of_columns(hn::CappedTag<float, 1>{}, rest, rays, dy_squared, depths_m, ranges_m, bounds, returns);
  return returns;
}

}  // namespace
}  // namespace saccade::fusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade::fusion {
namespace {

HWY_EXPORT(sample_brick_kernel);
HWY_EXPORT(update_brick_kernel);
HWY_EXPORT(ranges_of_row_kernel);

}  // namespace

void sample_brick(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, const float* ranges, bool inside,
                  KnownOctants known, BrickSamples& out) {
  HWY_DYNAMIC_DISPATCH(sample_brick_kernel)(camera, frame, ranges, inside, known, out);
}

void update_brick(const std::array<std::int16_t, kBrickVoxels>& samples, const Mask512& seen, std::uint16_t max_weight,
                  std::uint16_t free_weight, float clearing_share, DenseBrick& brick) {
  HWY_DYNAMIC_DISPATCH(update_brick_kernel)(samples, seen, max_weight, free_weight, clearing_share, brick);
}

std::size_t ranges_of_row(const RayLengths& rays, float dy_squared, const float* depths_m, float* ranges_m,
                          const ColumnBounds& bounds) {
  return HWY_DYNAMIC_DISPATCH(ranges_of_row_kernel)(rays, dy_squared, depths_m, ranges_m, bounds);
}

}  // namespace saccade::fusion
#endif  // HWY_ONCE
