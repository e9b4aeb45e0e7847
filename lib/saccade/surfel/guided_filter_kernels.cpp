// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/guided_filter_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/guided_filter_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::guided::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// A sum is that of its columns from left to right, and a column's from the middle outwards, whatever the width of a
// vector: every instruction set gives the same bits. Products of moments are exact in double precision, for they are of
// floats: there a fused multiply-add rounds no other way than product and sum. Elsewhere the two stay apart.
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

/// Half of the moments at a time: their sums stay in the registers of AVX2.
constexpr int kHalf{kMoments / 2};

template <int kFirst, std::size_t... kMoment>
HWY_INLINE void add_products(const V (&channel)[kChannels], V (&sum)[kHalf], std::index_sequence<kMoment...> /*all*/) {
  ((sum[kMoment] = hn::MulAdd(channel[kMomentChannels.first[kFirst + kMoment]],
                              channel[kMomentChannels.second[kFirst + kMoment]], sum[kMoment])),
   ...);
}

template <int kCount, std::size_t... kSum>
HWY_INLINE void add_loaded(const double* from, std::size_t stride, V (&sum)[kCount],
                           std::index_sequence<kSum...> /*all*/) {
  ((sum[kSum] = hn::Add(sum[kSum], hn::LoadU(Doubles{}, from + kSum * stride))), ...);
}

/// The sums of all levels of the columns of one vector. `sums` is where the first sum of level 0 goes; the sums of a
/// level are kSumColumns apart and `per_level` in number. add_row(row, sum) adds those of a row of the window.
template <int kCount, class AddRow>
HWY_INLINE void sum_columns(const Disc& disc, int per_level, double* sums, const AddRow& add_row) {
  V sum[kCount];
  for (V& s : sum) s = hn::Zero(Doubles{});
  for (int height = 0; height <= disc.radius_px; ++height) {
    add_row(disc.radius_px - height, sum);
    if (height > 0) add_row(disc.radius_px + height, sum);
    const int level = disc.level_of_height[static_cast<std::size_t>(height)];
    if (level < 0) continue;
    double* to = sums + static_cast<std::ptrdiff_t>(level) * per_level * kSumColumns;
    for (int i = 0; i < kCount; ++i) hn::StoreU(sum[i], Doubles{}, to + i * kSumColumns);
  }
}

/// The sums over the window of one vector of pixels, from those of columns around them.
template <int kCount>
HWY_INLINE void sum_window(const Disc& disc, int per_level, const double* sums, V (&sum)[kCount]) {
  for (V& s : sum) s = hn::Zero(Doubles{});
  for (int column = -disc.radius_px; column <= disc.radius_px; ++column) {
    const int level = disc.level_of_column[static_cast<std::size_t>(std::abs(column))];
    add_loaded<kCount>(sums + static_cast<std::ptrdiff_t>(level) * per_level * kSumColumns + column, kSumColumns, sum,
                       std::make_index_sequence<kCount>{});
  }
}

/// a · b, subtracted.
HWY_INLINE V less(V from, V a, V b) { return hn::Sub(from, hn::Mul(a, b)); }

/// Lines 1 to 8 of Algorithm 7, from the moments of one vector of pixels. Σ + Σ_E = L D Lᵀ; c_ij is L_ij D_j.
HWY_INLINE void fit(const V (&first)[kHalf], const V (&second)[kHalf], const Variances& variances, V (&fits)[kFits]) {
  const V one = set(1.0);
  const V share = hn::Div(one, first[0]);
  const auto mean = [&](V sum) HWY_ATTR { return hn::Mul(sum, share); };
  const V mr = mean(first[1]);
  const V mg = mean(first[2]);
  const V mb = mean(first[3]);
  const V md = mean(first[4]);
  const V delta = mean(first[5]);
  const V color = set(variances.color);
  const V d0 = hn::Add(less(mean(first[6]), mr, mr), color);
  const V c10 = less(mean(first[7]), mr, mg);
  const V c20 = less(mean(first[8]), mr, mb);
  const V c30 = less(mean(first[9]), mr, md);
  const V k0 = less(mean(second[0]), mr, delta);
  const V s11 = hn::Add(less(mean(second[1]), mg, mg), color);
  const V s21 = less(mean(second[2]), mg, mb);
  const V s31 = less(mean(second[3]), mg, md);
  const V k1 = less(mean(second[4]), mg, delta);
  const V s22 = hn::Add(less(mean(second[5]), mb, mb), color);
  const V s32 = less(mean(second[6]), mb, md);
  const V k2 = less(mean(second[7]), mb, delta);
  const V s33 = hn::Add(less(mean(second[8]), md, md), set(variances.depth_m2));
  const V k3 = less(mean(second[9]), md, delta);

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

template <int kFirst>
HWY_INLINE void sum_products_of_columns(const RowShape& shape, const Disc& disc, const float* const* rows, int column,
                                        double* sums) {
  const std::size_t at = static_cast<std::size_t>(kMargin + column);
  sum_columns<kHalf>(disc, kMoments, sums + kFirst * kSumColumns, [&](int row, V(&sum)[kHalf]) HWY_ATTR {
    V channel[kChannels];
    for (std::size_t c = 0; c < kChannels; ++c) channel[c] = load_floats(rows[row] + c * shape.stride + at);
    add_products<kFirst>(channel, sum, std::make_index_sequence<kHalf>{});
  });
}

/// Whether columns [first, end) of a loaded row have a pixel that is used.
HWY_INLINE bool any_used(const float* row, int first, int end) {
  const float* used = row + kMargin;
  return std::any_of(used + first, used + end, [](float one) { return one != 0.0F; });
}

/// Columns on either side of a strip that its windows reach, in whole vectors.
HWY_INLINE int reach_of(const Disc& disc) { return (disc.radius_px + kBlock - 1) / kBlock * kBlock; }

void fit_row_kernel(const RowShape& shape, const Disc& disc, const Variances& variances, const float* const* rows,
                    double* sums, double* fits) {
  const Doubles d;
  const float* middle = rows[disc.radius_px];
  const int reach = reach_of(disc);
  for (int strip = 0; strip < shape.padded_width; strip += kStrip) {
    const int end = std::min(strip + kStrip, shape.padded_width);
    const bool used = any_used(middle, strip, end);
    for (int u = strip - reach; used && u < end + reach; u += lanes()) {
      double* at = sums + (kMargin + u - strip);
      sum_products_of_columns<0>(shape, disc, rows, u, at);
      sum_products_of_columns<kHalf>(shape, disc, rows, u, at);
    }
    for (int u = strip; u < end; u += lanes()) {
      const auto is_used = hn::Ne(load_floats(middle + kMargin + u), hn::Zero(d));
      V fitted[kFits];
      for (V& f : fitted) f = hn::Zero(d);
      if (!hn::AllFalse(d, is_used)) {
        const double* at = sums + (kMargin + u - strip);
        V first[kHalf];
        V second[kHalf];
        sum_window<kHalf>(disc, kMoments, at, first);
        sum_window<kHalf>(disc, kMoments, at + kHalf * kSumColumns, second);
        fit(first, second, variances, fitted);
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
  const double* share = fits[disc.radius_px] + kSummed * shape.stride + kMargin;
  const int reach = reach_of(disc);
  for (int strip = 0; strip < shape.padded_width; strip += kStrip) {
    const int end = std::min(strip + kStrip, shape.padded_width);
    if (!any_used(row, strip, end)) continue;
    for (int u = strip - reach; u < end + reach; u += lanes()) {
      sum_columns<kSummed>(disc, kSummed, sums + (kMargin + u - strip), [&](int r, V(&sum)[kSummed]) HWY_ATTR {
        add_loaded<kSummed>(fits[r] + kMargin + u, shape.stride, sum, std::make_index_sequence<kSummed>{});
      });
    }
    for (int u = strip; u < end; u += lanes()) {
      V sum[kSummed];
      sum_window<kSummed>(disc, kSummed, sums + (kMargin + u - strip), sum);
      const float* guidance = row + shape.stride + kMargin + u;
      V total = sum[kSummed - 1];
      for (std::size_t c = 0; c + 1 < kSummed; ++c) {
        total = hn::Add(total, hn::Mul(sum[c], load_floats(guidance + c * shape.stride)));
      }
      const V depth = hn::Mul(total, hn::LoadU(Doubles{}, share + u));
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
  for (int column = 0; column <= radius_px; ++column) {
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
