// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/guided_filter_kernels.hpp"

#include <algorithm>
#include <cstdlib>
#include <type_traits>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/guided_filter_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::guided::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// A sum is that of its columns, and a column's from the middle outwards, in the same order for every width of a vector:
// every instruction set gives the same bits. Products of channels are exact in double precision, for these are floats:
// there a fused multiply-add rounds no other way than product and sum. Elsewhere the two stay apart.
using Doubles = hn::CappedTag<double, kBlock>;
using Floats = hn::Rebind<float, Doubles>;
using V = hn::Vec<Doubles>;

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(Doubles{})); }
HWY_INLINE V set(double value) { return hn::Set(Doubles{}, value); }
HWY_INLINE V load_floats(const float* from) { return hn::PromoteTo(Doubles{}, hn::LoadU(Floats{}, from)); }

/// The two channels of each moment: those with the mask, which is 1 or 0, are the count and the sums.
struct MomentChannels {
  std::array<int, kMoments> first{};
  std::array<int, kMoments> second{};
};
constexpr MomentChannels kMomentChannels = [] {
  MomentChannels channels{};
  std::size_t moment{0};
  for (int i = 0; i < kChannels; ++i) {
    for (int j = i; j < kChannels && moment < kMoments; ++j, ++moment) {
      channels.first[moment] = i;
      channels.second[moment] = j;
    }
  }
  return channels;
}();

/// Sums of so many moments at a time stay in registers: AVX-512 has 32 of them.
constexpr int kGroup{HWY_MAX_BYTES == 64 ? kMoments : kMoments / 2};

template <std::size_t kCount, std::size_t... kSum>
HWY_INLINE void set_zero(V (&sum)[kCount], std::index_sequence<kSum...> /*all*/) {
  ((sum[kSum] = hn::Zero(Doubles{})), ...);
}

template <std::size_t kCount, std::size_t... kSum>
HWY_INLINE void add_loaded(const double* from, std::size_t stride, V (&sum)[kCount],
                           std::index_sequence<kSum...> /*all*/) {
  ((sum[kSum] = hn::Add(sum[kSum], hn::LoadU(Doubles{}, from + kSum * stride))), ...);
}

template <std::size_t kCount, std::size_t... kSum>
HWY_INLINE void store(const V (&sum)[kCount], double* to, std::size_t stride, std::index_sequence<kSum...> /*all*/) {
  (hn::StoreU(sum[kSum], Doubles{}, to + kSum * stride), ...);
}

/// Adds moments kFirst and on of one vector of pixels, whose mask is at `pixels`.
template <std::size_t kFirst, std::size_t kCount, std::size_t... kSum>
HWY_INLINE void add_products(const float* pixels, std::size_t stride, V (&sum)[kCount],
                             std::index_sequence<kSum...> /*all*/) {
  V channel[kChannels];
  for (std::size_t c = 0; c < kChannels; ++c) channel[c] = load_floats(pixels + c * stride);
  ((sum[kSum] = hn::MulAdd(channel[kMomentChannels.first[kFirst + kSum]],
                           channel[kMomentChannels.second[kFirst + kSum]], sum[kSum])),
   ...);
}

/// The sums of all levels of the columns of one vector. `sums` is where the first sum of level 0 goes; the sums of a
/// level are kSumColumns apart and `per_level` in number. add_row(row, sum) adds those of a row of the window.
template <std::size_t kCount, class AddRow>
HWY_INLINE void sum_columns(const Disc& disc, int per_level, double* sums, const AddRow& add_row) {
  constexpr std::make_index_sequence<kCount> kAll;
  V sum[kCount];
  set_zero(sum, kAll);
  add_row(disc.radius_px, sum);
  for (int height = 1; height <= disc.radius_px; ++height) {
    add_row(disc.radius_px - height, sum);
    add_row(disc.radius_px + height, sum);
    const int level = disc.level_of_height[static_cast<std::size_t>(height)];
    if (level >= 0) store(sum, sums + static_cast<std::ptrdiff_t>(level) * per_level * kSumColumns, kSumColumns, kAll);
  }
}

/// The sums over the window of one vector of pixels, from those of columns around them. Its first and its last column
/// are single pixels: add_pixels(column, sum) adds those.
template <std::size_t kCount, class AddPixels>
HWY_INLINE void sum_window(const Disc& disc, int per_level, const double* sums, V (&sum)[kCount],
                           const AddPixels& add_pixels) {
  constexpr std::make_index_sequence<kCount> kAll;
  set_zero(sum, kAll);
  add_pixels(-disc.radius_px, sum);
  if (disc.radius_px > 0) add_pixels(disc.radius_px, sum);
  for (int column = 1 - disc.radius_px; column < disc.radius_px; ++column) {
    const int level = disc.level_of_column[static_cast<std::size_t>(std::abs(column))];
    add_loaded(sums + static_cast<std::ptrdiff_t>(level) * per_level * kSumColumns + column, kSumColumns, sum, kAll);
  }
}

/// a · b, subtracted.
HWY_INLINE V less(V from, V a, V b) { return hn::Sub(from, hn::Mul(a, b)); }

/// Lines 1 to 8 of Algorithm 7, from the moments of one vector of pixels. Σ + Σ_E = L D Lᵀ; c_ij is L_ij D_j.
HWY_INLINE void fit(const V (&moments)[kMoments / kGroup][kGroup], const Variances& variances, V (&fits)[kFits]) {
  const auto moment = [&](int i) HWY_ATTR { return moments[i / kGroup][i % kGroup]; };
  const V one = set(1.0);
  const V share = hn::Div(one, moment(0));
  const auto mean = [&](int i) HWY_ATTR { return hn::Mul(moment(i), share); };
  const V mr = mean(1);
  const V mg = mean(2);
  const V mb = mean(3);
  const V md = mean(4);
  const V delta = mean(5);
  const V color = set(variances.color);
  const V d0 = hn::Add(less(mean(6), mr, mr), color);
  const V c10 = less(mean(7), mr, mg);
  const V c20 = less(mean(8), mr, mb);
  const V c30 = less(mean(9), mr, md);
  const V k0 = less(mean(10), mr, delta);
  const V s11 = hn::Add(less(mean(11), mg, mg), color);
  const V s21 = less(mean(12), mg, mb);
  const V s31 = less(mean(13), mg, md);
  const V k1 = less(mean(14), mg, delta);
  const V s22 = hn::Add(less(mean(15), mb, mb), color);
  const V s32 = less(mean(16), mb, md);
  const V k2 = less(mean(17), mb, delta);
  const V s33 = hn::Add(less(mean(18), md, md), set(variances.depth_m2));
  const V k3 = less(mean(19), md, delta);

  const V r0 = hn::Div(one, d0);
  const V l10 = hn::Mul(c10, r0);
  const V l20 = hn::Mul(c20, r0);
  const V l30 = hn::Mul(c30, r0);
  const V r1 = hn::Div(one, less(s11, l10, c10));
  const V c21 = less(s21, l20, c10);
  const V c31 = less(s31, l30, c10);
  const V l21 = hn::Mul(c21, r1);
  const V l31 = hn::Mul(c31, r1);
  const V r2 = hn::Div(one, less(less(s22, l20, c20), l21, c21));
  const V c32 = less(less(s32, l30, c20), l31, c21);
  const V l32 = hn::Mul(c32, r2);
  const V r3 = hn::Div(one, less(less(less(s33, l30, c30), l31, c31), l32, c32));

  const V y1 = less(k1, l10, k0);
  const V y2 = less(less(k2, l20, k0), l21, y1);
  const V y3 = less(less(less(k3, l30, k0), l31, y1), l32, y2);
  const V a3 = hn::Mul(y3, r3);
  const V a2 = less(hn::Mul(y2, r2), l32, a3);
  const V a1 = less(less(hn::Mul(y1, r1), l21, a2), l31, a3);
  const V a0 = less(less(less(hn::Mul(k0, r0), l10, a1), l20, a2), l30, a3);
  fits[0] = a0;
  fits[1] = a1;
  fits[2] = a2;
  fits[3] = a3;
  fits[4] = less(less(less(less(delta, a0, mr), a1, mg), a2, mb), a3, md);
  fits[5] = share;
}

/// Whether columns [first, end) of a loaded row have a pixel that is used.
HWY_INLINE bool any_used(const float* row, int first, int end) {
  const float* used = row + kMargin;
  V any = hn::Zero(Doubles{});
  for (int u = first; u < end; u += lanes()) any = hn::Or(any, load_floats(used + u));
  return !hn::AllTrue(Doubles{}, hn::Eq(any, hn::Zero(Doubles{})));
}

/// Columns on either side of a strip that its windows reach, in whole vectors.
HWY_INLINE int reach_of(const Disc& disc) { return (disc.radius_px + lanes() - 2) / lanes() * lanes(); }

/// Calls group(first) with the first moment of each group, as a constant.
template <class Group>
HWY_INLINE void for_groups(const Group& group) {
  group(std::integral_constant<std::size_t, 0>{});
  if constexpr (kGroup < kMoments) group(std::integral_constant<std::size_t, kGroup>{});
}

void fit_row_kernel(const RowShape& shape, const Disc& disc, const Variances& variances, const float* const* rows,
                    double* sums, double* fits) {
  const Doubles d;
  constexpr std::make_index_sequence<kGroup> kAll;
  const float* middle = rows[disc.radius_px];
  const int reach = reach_of(disc);
  for (int strip = 0; strip < shape.padded_width; strip += kStrip) {
    const int end = std::min(strip + kStrip, shape.padded_width);
    const bool used = any_used(middle, strip, end);
    for (int u = strip - reach; used && u < end + reach; u += lanes()) {
      for_groups([&](auto first) HWY_ATTR {
        double* to = sums + first * kSumColumns + (kMargin + u - strip);
        sum_columns<kGroup>(disc, kMoments, to, [&](int row, V(&sum)[kGroup]) HWY_ATTR {
          add_products<first>(rows[row] + kMargin + u, shape.stride, sum, kAll);
        });
      });
    }
    for (int u = strip; u < end; u += lanes()) {
      const auto is_used = hn::Ne(load_floats(middle + kMargin + u), hn::Zero(d));
      V fitted[kFits];
      set_zero(fitted, std::make_index_sequence<kFits>{});
      if (!hn::AllFalse(d, is_used)) {
        V moments[kMoments / kGroup][kGroup];
        for_groups([&](auto first) HWY_ATTR {
          const double* from = sums + first * kSumColumns + (kMargin + u - strip);
          sum_window(disc, kMoments, from, moments[first / kGroup], [&](int column, V(&all)[kGroup]) HWY_ATTR {
            add_products<first>(middle + kMargin + u + column, shape.stride, all, kAll);
          });
        });
        fit(moments, variances, fitted);
      }
      for (std::size_t f = 0; f < kFits; ++f) {
        hn::StoreU(hn::IfThenElseZero(is_used, fitted[f]), d, fits + f * shape.stride + kMargin + u);
      }
    }
  }
}

void enhance_row_kernel(const RowShape& shape, const Disc& disc, const float* row, const double* const* fits,
                        double* sums, float* enhanced_m) {
  constexpr int kSummed{kFits - 1};
  constexpr std::make_index_sequence<kSummed> kAll;
  const double* middle = fits[disc.radius_px] + kMargin;
  const int reach = reach_of(disc);
  for (int strip = 0; strip < shape.padded_width; strip += kStrip) {
    const int end = std::min(strip + kStrip, shape.padded_width);
    if (!any_used(row, strip, end)) continue;
    for (int u = strip - reach; u < end + reach; u += lanes()) {
      sum_columns<kSummed>(disc, kSummed, sums + (kMargin + u - strip), [&](int r, V(&sum)[kSummed]) HWY_ATTR {
        add_loaded(fits[r] + kMargin + u, shape.stride, sum, kAll);
      });
    }
    for (int u = strip; u < end; u += lanes()) {
      V sum[kSummed];
      sum_window(disc, kSummed, sums + (kMargin + u - strip), sum, [&](int column, V(&all)[kSummed]) HWY_ATTR {
        add_loaded(middle + u + column, shape.stride, all, kAll);
      });
      const float* guidance = row + shape.stride + kMargin + u;
      V total = sum[kSummed - 1];
      for (std::size_t c = 0; c + 1 < kSummed; ++c) {
        total = hn::Add(total, hn::Mul(sum[c], load_floats(guidance + c * shape.stride)));
      }
      const V depth = hn::Mul(total, hn::LoadU(Doubles{}, middle + kSummed * shape.stride + u));
      hn::StoreU(hn::DemoteTo(Floats{}, depth), Floats{}, enhanced_m + u);
    }
  }
}

/// Columns [first, width) of load_row, in whole vectors; returns where it stopped.
template <class D>
HWY_INLINE int load_columns(D d, int first, const RowShape& shape, const float* depth_m, const float* guidance,
                            const std::uint8_t* used, float* row) {
  const hn::RebindToSigned<D> di;
  const hn::Rebind<std::uint8_t, D> d8;
  const int count = static_cast<int>(hn::Lanes(d));
  for (; first + count <= shape.width; first += count) {
    const auto flags = hn::PromoteTo(di, hn::LoadU(d8, used + first));
    const auto is_used = hn::RebindMask(d, hn::Ne(flags, hn::Zero(di)));
    hn::Vec<D> r;
    hn::Vec<D> g;
    hn::Vec<D> b;
    hn::Vec<D> depth;
    hn::LoadInterleaved4(d, guidance + std::size_t{4} * static_cast<std::size_t>(first), r, g, b, depth);
    const auto store = [&](std::size_t channel, hn::Vec<D> value) HWY_ATTR {
      hn::StoreU(hn::IfThenElseZero(is_used, value), d, row + channel * shape.stride + kMargin + first);
    };
    store(0, hn::Set(d, 1.0F));
    store(1, r);
    store(2, g);
    store(3, b);
    store(4, depth);
    store(5, hn::LoadU(d, depth_m + first));
  }
  return first;
}

void load_row_kernel(const RowShape& shape, const float* depth_m, const float* guidance, const std::uint8_t* used,
                     float* row) {
  const int rest = load_columns(hn::CappedTag<float, 16>{}, 0, shape, depth_m, guidance, used, row);
  load_columns(hn::CappedTag<float, 1>{}, rest, shape, depth_m, guidance, used, row);
}

}  // namespace
}  // namespace saccade::guided::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade::guided {
namespace {

HWY_EXPORT(load_row_kernel);
HWY_EXPORT(fit_row_kernel);
HWY_EXPORT(enhance_row_kernel);

}  // namespace

Disc make_disc(int radius_px) {
  Disc disc{.radius_px = radius_px};
  disc.level_of_height.fill(-1);
  for (int column = 0; column < radius_px; ++column) {
    int height{0};
    while (column * column + (height + 1) * (height + 1) <= radius_px * radius_px) ++height;
    int& level = disc.level_of_height[static_cast<std::size_t>(height)];
    if (level < 0) level = disc.levels++;
    disc.level_of_column[static_cast<std::size_t>(column)] = level;
  }
  return disc;
}

void load_row(const RowShape& shape, const float* depth_m, const float* guidance, const std::uint8_t* used,
              float* row) {
  HWY_DYNAMIC_DISPATCH(load_row_kernel)(shape, depth_m, guidance, used, row);
}

void fit_row(const RowShape& shape, const Disc& disc, const Variances& variances, const float* const* rows,
             double* sums, double* fits) {
  HWY_DYNAMIC_DISPATCH(fit_row_kernel)(shape, disc, variances, rows, sums, fits);
}

void enhance_row(const RowShape& shape, const Disc& disc, const float* row, const double* const* fits, double* sums,
                 float* enhanced_m) {
  HWY_DYNAMIC_DISPATCH(enhance_row_kernel)(shape, disc, row, fits, sums, enhanced_m);
}

}  // namespace saccade::guided
#endif  // HWY_ONCE
