// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/guided_filter_kernels.hpp"

#include <algorithm>
#include <cstdlib>
#include <type_traits>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/internal/guided_filter_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::guided::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Two rows of an image share most of their windows' sums. A column's sum begins with the pixels of both rows, and
// continues with one above and one below; a window's sum is that of its columns. The order is independent of the vector
// width and of the thread, so no instruction set and no number of threads changes a bit. Products of channels are exact
// in double precision, because channels are floats: there a fused multiply-add rounds like product and sum. Elsewhere
// the two stay separate.
using Doubles = hn::CappedTag<double, kBlock>;
using Floats = hn::Rebind<float, Doubles>;
using V = hn::Vec<Doubles>;

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(Doubles{})); }
HWY_INLINE V set(double value) { return hn::Set(Doubles{}, value); }
HWY_INLINE V load(const double* from) { return hn::LoadU(Doubles{}, from); }
HWY_INLINE V load_floats(const float* from) { return hn::PromoteTo(Doubles{}, hn::LoadU(Floats{}, from)); }

/// The two channels of each moment. Those with the mask, which is 1 or 0, give the count and the sums. Depth does not
/// occur in the first half, so that each half needs few channels.
constexpr std::array<std::size_t, kMoments> kFirstChannel{0, 0, 0, 0, 1, 1, 1, 2, 2, 3, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4};
constexpr std::array<std::size_t, kMoments> kOtherChannel{0, 1, 2, 3, 1, 2, 3, 2, 3, 3, 4, 4, 4, 4, 4, 5, 5, 5, 5, 5};

/// Number of moments whose sums stay in registers at a time; AVX-512 has 32 of them.
constexpr std::size_t kGroup{HWY_MAX_BYTES == 64 ? kMoments : kMoments / 2};

/// Terms of the sums for one vector of pixels: moments from kFirst on. `pixels` points to their masks.
template <std::size_t kFirst>
struct MomentsOf {
  static constexpr std::size_t kCount{kGroup};
  V channel[kChannels];

  HWY_INLINE MomentsOf(const float* pixels, std::size_t stride) {
    for (std::size_t c = 0; c < kChannels; ++c) channel[c] = load_floats(pixels + c * stride);
  }
  template <std::size_t kSum>
  HWY_INLINE V added_to(V sum) const {
    constexpr std::size_t kOne{kFirstChannel[kFirst + kSum]};
    constexpr std::size_t kOther{kOtherChannel[kFirst + kSum]};
    if constexpr (kOne == 0) return hn::Add(sum, channel[kOther]);
    return hn::MulAdd(channel[kOne], channel[kOther], sum);
  }
};

/// Terms of the sums of fits, without the last value.
struct FitsOf {
  static constexpr std::size_t kCount{kFits - 1};
  const double* fits;
  std::size_t stride;

  template <std::size_t kSum>
  HWY_INLINE V added_to(V sum) const {
    return hn::Add(sum, load(fits + kSum * stride));
  }
};

template <std::size_t kCount, std::size_t... kSum>
HWY_INLINE void set_zero(V (&sum)[kCount], std::index_sequence<kSum...> /*all*/) {
  ((sum[kSum] = hn::Zero(Doubles{})), ...);
}

template <class Terms, std::size_t... kSum>
HWY_INLINE void add(const Terms& terms, V (&sum)[Terms::kCount], std::index_sequence<kSum...> /*all*/) {
  ((sum[kSum] = terms.template added_to<kSum>(sum[kSum])), ...);
}

template <std::size_t kCount, std::size_t... kSum>
HWY_INLINE void add_stored(const double* from, V (&sum)[kCount], std::index_sequence<kSum...> /*all*/) {
  ((sum[kSum] = hn::Add(sum[kSum], load(from + kSum * kSumColumns))), ...);
}

template <class Terms, std::size_t... kSum>
HWY_INLINE void store_sums(const Terms& terms, const V (&sum)[Terms::kCount], double* to,
                           std::index_sequence<kSum...> /*all*/) {
  (hn::StoreU(terms.template added_to<kSum>(sum[kSum]), Doubles{}, to + kSum * kSumColumns), ...);
}

template <class Terms, std::size_t... kSum>
HWY_INLINE void add_to_stored(const Terms& terms, const double* from, V (&sum)[Terms::kCount],
                              std::index_sequence<kSum...> /*all*/) {
  ((sum[kSum] = terms.template added_to<kSum>(load(from + kSum * kSumColumns))), ...);
}

/// Sums of some columns: levels of the upper of two rows, followed by those of the lower.
struct ColumnSums {
  double* upper;
  std::ptrdiff_t per_level;
  std::ptrdiff_t per_row;

  ColumnSums(const Disc& disc, std::size_t planes, double* sums)
      : upper{sums}, per_level{static_cast<std::ptrdiff_t>(planes * kSumColumns)}, per_row{disc.levels * per_level} {}
};

/// Sums all levels for the columns of one vector and two rows, into `at`. terms(row) gives the terms of a row of the
/// windows, whose middle rows are R and R + 1.
template <std::size_t kCount, class TermsOf>
HWY_INLINE void sum_columns(const Disc& disc, const ColumnSums& sums, std::ptrdiff_t at, const TermsOf& terms) {
  constexpr std::make_index_sequence<kCount> kAll;
  const int radius = disc.radius_px;
  V both[kCount];
  set_zero(both, kAll);
  add(terms(radius), both, kAll);
  add(terms(radius + 1), both, kAll);
  for (int height = 1; height <= radius; ++height) {
    const int level = disc.level_of_height[static_cast<std::size_t>(height)];
    if (level < 0) {
      add(terms(radius - height), both, kAll);
      add(terms(radius + 1 + height), both, kAll);
      continue;
    }
    double* const upper = sums.upper + level * sums.per_level + at;
    store_sums(terms(radius - height), both, upper, kAll);
    const auto below = terms(radius + 1 + height);
    store_sums(below, both, upper + sums.per_row, kAll);
    add_to_stored(below, upper, both, kAll);
  }
}

/// Sums over the window of one vector of pixels, from the column sums around it; `columns` points to the sums of its
/// own columns. Its first and last columns are single pixels: terms(column).
template <std::size_t kCount, class TermsOf>
HWY_INLINE void sum_window(const Disc& disc, const double* columns, std::ptrdiff_t per_level, V (&sum)[kCount],
                           const TermsOf& terms) {
  constexpr std::make_index_sequence<kCount> kAll;
  set_zero(sum, kAll);
  add(terms(-disc.radius_px), sum, kAll);
  if (disc.radius_px > 0) add(terms(disc.radius_px), sum, kAll);
  for (int column = 1 - disc.radius_px; column < disc.radius_px; ++column) {
    const int level = disc.level_of_column[static_cast<std::size_t>(std::abs(column))];
    add_stored(columns + level * per_level + column, sum, kAll);
  }
}

/// Returns from − a · b.
HWY_INLINE V less(V from, V a, V b) { return hn::Sub(from, hn::Mul(a, b)); }

/// Returns a · b − c · d.
HWY_INLINE V difference(V a, V b, V c, V d) { return hn::Sub(hn::Mul(a, b), hn::Mul(c, d)); }

/// Computes lines 1 to 8 of Algorithm 7 from the moments of one vector of pixels. With n pixels in the window, n²(Σ +
/// Σ_E) = L D Lᵀ and n²κ give the same a as Σ + Σ_E and κ. s_ij is the rest of the matrix's column j after eliminating
/// those before it, L_ij D_j.
HWY_INLINE void fit(const V (&moments)[kMoments / kGroup][kGroup], const Variances& variances, V (&fits)[kFits]) {
  const auto moment = [&](std::size_t i) HWY_ATTR { return moments[i / kGroup][i % kGroup]; };
  const V n = moment(0);
  const V r = moment(1);
  const V g = moment(2);
  const V b = moment(3);
  const V d = moment(10);
  const V depth = moment(15);
  const V nn = hn::Mul(n, n);
  const V color = hn::Mul(nn, set(variances.color));
  const V s00 = hn::Add(difference(n, moment(4), r, r), color);
  const V s10 = difference(n, moment(5), r, g);
  const V s20 = difference(n, moment(6), r, b);
  const V s30 = difference(n, moment(11), r, d);
  const V all11 = hn::Add(difference(n, moment(7), g, g), color);
  const V all21 = difference(n, moment(8), g, b);
  const V all31 = difference(n, moment(12), g, d);
  const V all22 = hn::Add(difference(n, moment(9), b, b), color);
  const V all32 = difference(n, moment(13), b, d);
  const V all33 = hn::Add(difference(n, moment(14), d, d), hn::Mul(nn, set(variances.depth_m2)));
  const V k0 = difference(n, moment(16), r, depth);
  const V k1 = difference(n, moment(17), g, depth);
  const V k2 = difference(n, moment(18), b, depth);
  const V k3 = difference(n, moment(19), d, depth);

  const V one = set(1.0);
  const V r0 = hn::Div(one, s00);
  const V l10 = hn::Mul(s10, r0);
  const V l20 = hn::Mul(s20, r0);
  const V l30 = hn::Mul(s30, r0);
  const V r1 = hn::Div(one, less(all11, l10, s10));
  const V s21 = less(all21, l20, s10);
  const V s31 = less(all31, l30, s10);
  const V l21 = hn::Mul(s21, r1);
  const V l31 = hn::Mul(s31, r1);
  const V r2 = hn::Div(one, less(less(all22, l20, s20), l21, s21));
  const V s32 = less(less(all32, l30, s20), l31, s21);
  const V l32 = hn::Mul(s32, r2);
  const V r3 = hn::Div(one, less(less(less(all33, l30, s30), l31, s31), l32, s32));

  const V y1 = less(k1, l10, k0);
  const V y2 = less(less(k2, l20, k0), l21, y1);
  const V y3 = less(less(less(k3, l30, k0), l31, y1), l32, y2);
  const V a3 = hn::Mul(y3, r3);
  const V a2 = less(hn::Mul(y2, r2), l32, a3);
  const V a1 = less(less(hn::Mul(y1, r1), l21, a2), l31, a3);
  const V a0 = less(less(less(hn::Mul(k0, r0), l10, a1), l20, a2), l30, a3);
  const V share = hn::Div(one, n);
  fits[0] = a0;
  fits[1] = a1;
  fits[2] = a2;
  fits[3] = a3;
  fits[4] = hn::Mul(less(less(less(less(depth, a0, r), a1, g), a2, b), a3, d), share);
  fits[5] = share;
}

/// Tells whether columns [first, end) of a loaded row, whose masks are at `used`, have a used pixel.
HWY_INLINE bool any_used(const float* used, int first, int end) {
  V any = hn::Zero(Doubles{});
  for (int u = first; u < end; u += lanes()) any = hn::Or(any, load_floats(used + u));
  return !hn::AllTrue(Doubles{}, hn::Eq(any, hn::Zero(Doubles{})));
}

/// Returns the number of columns on either side of a strip that its windows reach, in whole vectors.
HWY_INLINE int reach_of(const Disc& disc) { return (disc.radius_px + lanes() - 2) / lanes() * lanes(); }

/// Calls group(first) with the first moment of each group, as a constant.
template <class Group>
HWY_INLINE void for_groups(const Group& group) {
  group(std::integral_constant<std::size_t, 0>{});
  if constexpr (kGroup < kMoments) group(std::integral_constant<std::size_t, kGroup>{});
}

/// Fits one vector of pixels, whose masks are at `pixels`; `columns` points to the sums of their columns.
HWY_INLINE void fit_pixels(const Disc& disc, const Variances& variances, const float* pixels, std::size_t stride,
                           const double* columns, std::ptrdiff_t per_level, double* fits) {
  const Doubles d;
  const auto is_used = hn::Ne(load_floats(pixels), hn::Zero(d));
  V fitted[kFits];
  set_zero(fitted, std::make_index_sequence<kFits>{});
  if (!hn::AllFalse(d, is_used)) {
    V moments[kMoments / kGroup][kGroup];
    for_groups([&](auto first) HWY_ATTR {
      sum_window(disc, columns + first * kSumColumns, per_level, moments[first / kGroup], [&](int column) HWY_ATTR {
        return MomentsOf<first>{pixels + column, stride};
      });
    });
    fit(moments, variances, fitted);
  }
  for (std::size_t f = 0; f < kFits; ++f) {
    hn::StoreU(hn::IfThenElseZero(is_used, fitted[f]), d, fits + f * stride);
  }
}

void fit_rows_kernel(const RowShape& shape, const Disc& disc, const Variances& variances, const float* const* rows,
                     double* sums, double* const* fits) {
  const ColumnSums columns{disc, kMoments, sums};
  const std::array<const float*, 2> middle{rows[disc.radius_px] + kMargin, rows[disc.radius_px + 1] + kMargin};
  const int reach = reach_of(disc);
  for (int strip = 0; strip < shape.padded_width; strip += kStrip) {
    const int end = std::min(strip + kStrip, shape.padded_width);
    const bool used = any_used(middle[0], strip, end) || any_used(middle[1], strip, end);
    for (int u = strip - reach; u < end + reach; u += lanes()) {
      if (used) {
        for_groups([&](auto first) HWY_ATTR {
          sum_columns<kGroup>(disc, columns, static_cast<std::ptrdiff_t>(first) * kSumColumns + kMargin + u - strip,
                              [&](int row) HWY_ATTR {
                                return MomentsOf<first>{rows[row] + kMargin + u, shape.stride};
                              });
        });
      }
      const int ready = u - reach;  // sums of all columns of its windows are there
      for (std::size_t row = 0; row < 2 && ready >= strip; ++row) {
        const double* const of_row = sums + static_cast<std::ptrdiff_t>(row) * columns.per_row + kMargin - strip;
        fit_pixels(disc, variances, middle[row] + ready, shape.stride, of_row + ready, columns.per_level,
                   fits[row] + kMargin + ready);
      }
    }
  }
}

/// Enhances the depth of one vector of pixels; parameters as in fit_pixels.
HWY_INLINE void enhance_pixels(const Disc& disc, const float* pixels, std::size_t stride, const double* columns,
                               std::ptrdiff_t per_level, const double* fits, float* enhanced_m) {
  V sum[FitsOf::kCount];
  sum_window(disc, columns, per_level, sum, [&](int column) HWY_ATTR { return FitsOf{fits + column, stride}; });
  V total = sum[FitsOf::kCount - 1];
  for (std::size_t c = 0; c + 1 < FitsOf::kCount; ++c) {
    total = hn::Add(total, hn::Mul(sum[c], load_floats(pixels + (c + 1) * stride)));
  }
  const V depth = hn::Mul(total, load(fits + FitsOf::kCount * stride));
  hn::StoreU(hn::DemoteTo(Floats{}, depth), Floats{}, enhanced_m);
}

void enhance_rows_kernel(const RowShape& shape, const Disc& disc, const float* const* rows, const double* const* fits,
                         double* sums, float* const* enhanced_m) {
  const ColumnSums columns{disc, FitsOf::kCount, sums};
  const double* const* const middle = fits + disc.radius_px;
  const int reach = reach_of(disc);
  for (int strip = 0; strip < shape.padded_width; strip += kStrip) {
    const int end = std::min(strip + kStrip, shape.padded_width);
    if (!any_used(rows[0] + kMargin, strip, end) && !any_used(rows[1] + kMargin, strip, end)) continue;
    for (int u = strip - reach; u < end + reach; u += lanes()) {
      sum_columns<FitsOf::kCount>(disc, columns, kMargin + u - strip, [&](int row) HWY_ATTR {
        return FitsOf{fits[row] + kMargin + u, shape.stride};
      });
      const int ready = u - reach;
      for (std::size_t row = 0; row < 2 && ready >= strip; ++row) {
        const double* const of_row = sums + static_cast<std::ptrdiff_t>(row) * columns.per_row + kMargin - strip;
        enhance_pixels(disc, rows[row] + kMargin + ready, shape.stride, of_row + ready, columns.per_level,
                       middle[row] + kMargin + ready, enhanced_m[row] + ready);
      }
    }
  }
}

/// Loads columns [first, width) in whole vectors, as load_row; returns where it stopped.
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
HWY_EXPORT(fit_rows_kernel);
HWY_EXPORT(enhance_rows_kernel);

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

void fit_rows(const RowShape& shape, const Disc& disc, const Variances& variances, const float* const* rows,
              double* sums, double* const* fits) {
  HWY_DYNAMIC_DISPATCH(fit_rows_kernel)(shape, disc, variances, rows, sums, fits);
}

void enhance_rows(const RowShape& shape, const Disc& disc, const float* const* rows, const double* const* fits,
                  double* sums, float* const* enhanced_m) {
  HWY_DYNAMIC_DISPATCH(enhance_rows_kernel)(shape, disc, rows, fits, sums, enhanced_m);
}

}  // namespace saccade::guided
#endif  // HWY_ONCE
