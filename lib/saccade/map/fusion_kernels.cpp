// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/fusion_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/map/fusion_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::fusion::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Whole vectors of floats fill a slice of a brick: 1 to 16 lanes, a power of two. Products and sums stay apart: a fused
// multiply-add rounds once where tsdf_math.hpp rounds twice.
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::int16_t, Floats>;
using Words = hn::Rebind<std::uint16_t, Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
using FloatMask = hn::Mask<Floats>;

constexpr std::size_t kSlice{kBrickEdge * kBrickEdge};

/// Lane i at bit i.
template <class D>
HWY_INLINE std::uint64_t bits_of(D d, hn::Mask<D> mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  const std::uint64_t bits = bytes[0] | (std::uint64_t{bytes[1]} << 8);
  return bits & ((std::uint64_t{1} << hn::Lanes(d)) - 1);
}

struct Float3Vec {
  FloatVec x;
  FloatVec y;
  FloatVec z;
};

/// x and y of the 64 voxels of a slice.
struct SliceOffsets {
  alignas(kVectorBytes) std::array<float, kSlice> x;
  alignas(kVectorBytes) std::array<float, kSlice> y;
};
constexpr SliceOffsets kSliceOffsets = [] {
  SliceOffsets offsets{};
  for (std::size_t i = 0; i < kSlice; ++i) {
    offsets.x[i] = static_cast<float>(i % kBrickEdge);
    offsets.y[i] = static_cast<float>(i / kBrickEdge);
  }
  return offsets;
}();

/// One coordinate of tsdf::voxel_in_camera, of the voxels from `first` on in a slice.
HWY_INLINE FloatVec coordinate(float slice_origin, float step_y, float step_x, std::size_t first) {
  const Floats d;
  const FloatVec y = hn::Load(d, kSliceOffsets.y.data() + first);
  const FloatVec x = hn::Load(d, kSliceOffsets.x.data() + first);
  return hn::Add(hn::Add(hn::Set(d, slice_origin), hn::Mul(hn::Set(d, step_y), y)), hn::Mul(hn::Set(d, step_x), x));
}

/// round_to_even of tsdf_math.hpp, as an integer: the sum's last bits are it.
HWY_INLINE IntVec round_to_even(FloatVec x) {
  const Floats d;
  const Ints di;
  const FloatVec magic = hn::Set(d, 12582912.0F);
  return hn::Sub(hn::BitCast(di, hn::Add(x, magic)), hn::BitCast(di, magic));
}

/// tsdf::pixel_of, as an index into the image; 0 where not `inside`.
HWY_INLINE IntVec pixel_of(const tsdf::FusionCamera& camera, const Float3Vec& p, FloatMask& inside) {
  const Floats d;
  const Ints di;
  const FloatVec zero = hn::Zero(d);
  const FloatVec half = hn::Set(d, 0.5F);
  const FloatVec inv_z = hn::Div(hn::Set(d, 1.0F), p.z);
  const FloatVec u =
      hn::Add(hn::Add(hn::Mul(hn::Set(d, camera.fx), hn::Mul(p.x, inv_z)), hn::Set(d, camera.cx)), half);
  const FloatVec v =
      hn::Add(hn::Add(hn::Mul(hn::Set(d, camera.fy), hn::Mul(p.y, inv_z)), hn::Set(d, camera.cy)), half);
  const FloatMask right_below = hn::And(hn::Ge(u, zero), hn::Ge(v, zero));
  const FloatMask left_above = hn::And(hn::Lt(u, hn::Set(d, static_cast<float>(camera.width))),
                                       hn::Lt(v, hn::Set(d, static_cast<float>(camera.height))));
  inside = hn::And(hn::Gt(p.z, hn::Set(d, tsdf::kNearestZ)), hn::And(right_below, left_above));
  const IntVec column = hn::ConvertTo(di, hn::IfThenElseZero(inside, u));
  const IntVec row = hn::ConvertTo(di, hn::IfThenElseZero(inside, v));
  return hn::Add(hn::Mul(row, hn::Set(di, camera.width)), column);
}

/// tsdf::sample_voxel where `inside`, else kNotSeen.
HWY_INLINE IntVec sample_voxels(const tsdf::FusionCamera& camera, const Float3Vec& p, FloatVec range,
                                FloatMask inside) {
  const Floats d;
  const Ints di;
  const FloatVec one = hn::Set(d, 1.0F);
  const FloatVec zero = hn::Zero(d);
  const FloatVec distance =
      hn::Sqrt(hn::Add(hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y)), hn::Mul(p.z, p.z)));
  const FloatVec sdf = hn::Sub(range, distance);  // eq. 2.1
  const FloatVec scaled = hn::Mul(sdf, hn::Set(d, camera.inv_truncation));
  const FloatVec clamped = hn::Max(hn::Min(scaled, one), hn::Neg(one));
  const IntVec sample = round_to_even(hn::Mul(clamped, hn::Set(d, 32767.0F)));
  const FloatMask hit = hn::And(hn::Gt(range, zero), hn::Ge(sdf, hn::Set(d, -camera.truncation_m)));
  const FloatMask seen_free = hn::And(hn::Lt(range, zero), hn::Le(distance, hn::Neg(range)));
  const IntVec not_hit = hn::IfThenElse(hn::RebindMask(di, hn::And(inside, seen_free)),
                                        hn::Set(di, tsdf::kSampleOne), hn::Set(di, tsdf::kNotSeen));
  return hn::IfThenElse(hn::RebindMask(di, hn::And(inside, hit)), sample, not_hit);
}

void sample_brick_kernel(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, const float* ranges,
                         BrickSamples& out) {
  const Floats d;
  const Ints di;
  const Shorts d16;
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    const auto fz = static_cast<float>(z);
    const tsdf::Float3 origin{frame.origin.x + frame.step_z.x * fz, frame.origin.y + frame.step_z.y * fz,
                              frame.origin.z + frame.step_z.z * fz};
    std::uint64_t seen{0};
    std::uint64_t surface{0};
    for (std::size_t first = 0; first < kSlice; first += hn::Lanes(d)) {
      const Float3Vec p{coordinate(origin.x, frame.step_y.x, frame.step_x.x, first),
                        coordinate(origin.y, frame.step_y.y, frame.step_x.y, first),
                        coordinate(origin.z, frame.step_y.z, frame.step_x.z, first)};
      FloatMask inside;
      const IntVec pixel = pixel_of(camera, p, inside);
      const IntVec sample = sample_voxels(camera, p, hn::GatherIndex(d, ranges, pixel), inside);
      hn::Store(pixel, di, out.pixels.data() + z * kSlice + first);
      hn::Store(hn::DemoteTo(d16, sample), d16, out.samples.data() + z * kSlice + first);
      const auto is_seen = hn::Ne(sample, hn::Set(di, tsdf::kNotSeen));
      seen |= bits_of(di, is_seen) << first;
      surface |= bits_of(di, hn::And(is_seen, hn::Ne(sample, hn::Set(di, tsdf::kSampleOne)))) << first;
    }
    out.seen.words[z] = seen;
    out.surface.words[z] = surface;
  }
}

void update_brick_kernel(const std::array<std::int16_t, kBrickVoxels>& samples, std::uint16_t max_weight,
                         std::uint16_t free_weight, DenseBrick& brick) {
  const Floats d;
  const Ints di;
  const Shorts d16;
  const Words dw;
  const IntVec one = hn::Set(di, 1);
  const IntVec zero = hn::Zero(di);
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    std::uint64_t unknown{0};
    std::uint64_t positive{0};
    for (std::size_t first = 0; first < kSlice; first += hn::Lanes(d)) {
      const std::size_t i = z * kSlice + first;
      const IntVec sample = hn::PromoteTo(di, hn::Load(d16, samples.data() + i));
      const IntVec old_v = hn::PromoteTo(di, hn::LoadU(d16, brick.v.data() + i));
      const IntVec old_w = hn::PromoteTo(di, hn::LoadU(dw, brick.w.data() + i));
      const IntVec counted = hn::Add(old_w, one);
      const IntVec numerator = hn::Add(hn::Mul(old_v, old_w), sample);  // eq. 2.2
      const IntVec average = round_to_even(hn::Div(hn::ConvertTo(d, numerator), hn::ConvertTo(d, counted)));
      const IntVec limit = hn::IfThenElse(hn::Eq(average, hn::Set(di, tsdf::kSampleOne)), hn::Set(di, free_weight),
                                          hn::Set(di, max_weight));
      const auto seen = hn::Ne(sample, hn::Set(di, tsdf::kNotSeen));
      const IntVec v = hn::IfThenElse(seen, average, old_v);
      const IntVec w = hn::IfThenElse(seen, hn::Min(counted, limit), old_w);  // eq. 2.3
      hn::StoreU(hn::DemoteTo(d16, v), d16, brick.v.data() + i);
      hn::StoreU(hn::DemoteTo(dw, w), dw, brick.w.data() + i);
      unknown |= bits_of(di, hn::Eq(w, zero)) << first;
      positive |= bits_of(di, hn::Gt(v, zero)) << first;
    }
    brick.unknown.words[z] = unknown;
    brick.occupied.words[z] = ~(unknown | positive);
  }
}

/// Columns [first, end) of ranges_of_row, in whole vectors; returns where it stopped.
template <class D>
HWY_INLINE int ranges_of_columns(D d, int first, const RayLengths& rays, float dy_squared, const float* depths_m,
                                 float* ranges_m, float* clear_m, float* reach_m, std::size_t& returns) {
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
    const auto clear = hn::IfThenElse(hit, hn::Max(zero, hn::Sub(range, truncation)), hn::Neg(range));
    const auto reach = hn::IfThenElse(hit, hn::Add(range, truncation), hn::Neg(range));
    hn::StoreU(hn::Min(hn::LoadU(d, clear_m + first), clear), d, clear_m + first);
    hn::StoreU(hn::Max(hn::LoadU(d, reach_m + first), reach), d, reach_m + first);
  }
  return first;
}

std::size_t ranges_of_row_kernel(const RayLengths& rays, float dy_squared, const float* depths_m, float* ranges_m,
                                 float* clear_m, float* reach_m) {
  std::size_t returns{0};
  const int rest =
      ranges_of_columns(Floats{}, 0, rays, dy_squared, depths_m, ranges_m, clear_m, reach_m, returns);
  ranges_of_columns(hn::CappedTag<float, 1>{}, rest, rays, dy_squared, depths_m, ranges_m, clear_m, reach_m, returns);
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

void sample_brick(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, const float* ranges,
                  BrickSamples& out) {
  HWY_DYNAMIC_DISPATCH(sample_brick_kernel)(camera, frame, ranges, out);
}

void update_brick(const std::array<std::int16_t, kBrickVoxels>& samples, std::uint16_t max_weight,
                  std::uint16_t free_weight, DenseBrick& brick) {
  HWY_DYNAMIC_DISPATCH(update_brick_kernel)(samples, max_weight, free_weight, brick);
}

std::size_t ranges_of_row(const RayLengths& rays, float dy_squared, const float* depths_m, float* ranges_m,
                          float* clear_m, float* reach_m) {
  return HWY_DYNAMIC_DISPATCH(ranges_of_row_kernel)(rays, dy_squared, depths_m, ranges_m, clear_m, reach_m);
}

}  // namespace saccade::fusion
#endif  // HWY_ONCE
