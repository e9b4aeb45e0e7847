// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_association.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/surfel_association.cpp"
#include "saccade/core/simd_kernels.hpp"

#ifndef SACCADE_SURFEL_ASSOCIATION_BITS
#define SACCADE_SURFEL_ASSOCIATION_BITS
namespace saccade {
namespace {

/// Bit i: the i-th pixel around a cell, row by row, saw the cell's surfel. kMadeOwn: the pixel created its own.
constexpr unsigned kAround{9};
constexpr unsigned kMadeOwn{1U << kAround};
constexpr std::size_t kMargin{16};  ///< pixels on either side of a row: the lanes of the widest vector

/// Pixels of three rows that saw the surfels of the middle row's cells.
struct SeenRow {
  std::array<const SurfelId*, 3> pixels{};  ///< with kMargin readable on either side
  const SurfelId* cells{nullptr};           ///< likewise with kMargin
  SurfelId first_new{0};
  std::size_t width{0};
  std::uint32_t* bits{nullptr};  ///< likewise with kMargin
};

}  // namespace
}  // namespace saccade
#endif

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void seen_by_kernel(const SeenRow& row) {
  const hn::CappedTag<std::uint32_t, kMargin> d;
  const auto none = hn::Set(d, kNoSurfel);
  for (std::size_t u = 0; u < row.width; u += hn::Lanes(d)) {
    const auto cell = hn::LoadU(d, row.cells + u);
    auto bits = hn::Zero(d);
    for (unsigned i = 0; i < kAround; ++i) {
      const auto pixel = hn::LoadU(d, row.pixels[i / 3] + u + i % 3 - 1);
      bits = hn::Or(bits, hn::IfThenElseZero(hn::Eq(pixel, cell), hn::Set(d, 1U << i)));
    }
    bits = hn::IfThenZeroElse(hn::Eq(cell, none), bits);
    const auto own = hn::LoadU(d, row.pixels[1] + u);
    const auto is_new = hn::And(hn::Ne(own, none), hn::Not(hn::Lt(own, hn::Set(d, row.first_new))));
    hn::StoreU(hn::Or(bits, hn::IfThenElseZero(is_new, hn::Set(d, kMadeOwn))), d, row.bits + u);
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(seen_by_kernel);

/// Row with empty margins.
class WideRow {
 public:
  explicit WideRow(std::size_t width) : ids_(width + 2 * kMargin, kNoSurfel) {}
  void set(const SurfelId* row, std::size_t width) { std::copy_n(row, width, ids_.data() + kMargin); }
  void clear() { std::fill(ids_.begin(), ids_.end(), kNoSurfel); }
  [[nodiscard]] const SurfelId* data() const { return ids_.data() + kMargin; }

 private:
  std::vector<SurfelId> ids_;
};

/// Returns the pixel around (u, v) that the lowest bit stands for. uv holds v in its upper half, so that steps are
/// sums.
SurfelPixel pixel_around(SurfelId id, unsigned bits, std::uint32_t uv) {
  constexpr std::array<std::uint32_t, kAround> kSteps = [] {
    std::array<std::uint32_t, kAround> steps{};
    for (std::uint32_t i = 0; i < kAround; ++i) steps[i] = ((i / 3 - 1) << 16U) + (i % 3 - 1);
    return steps;
  }();
  const std::uint32_t at = uv + kSteps[static_cast<std::size_t>(std::countr_zero(bits))];
  return {id, static_cast<std::uint16_t>(at), static_cast<std::uint16_t>(at >> 16U)};
}

}  // namespace

void SurfelAssociation::collect(std::size_t g) {
  const int begin = static_cast<int>(g) * kRowsAtOnce;
  const int end = std::min(begin + kRowsAtOnce, of_pixel.height());
  const auto width = static_cast<std::size_t>(of_pixel.width());
  std::array<WideRow, 3> rows{WideRow{width}, WideRow{width}, WideRow{width}};
  const auto bring = [&](int v) {
    WideRow& row = rows[static_cast<std::size_t>(v + 3) % 3];
    if (v < 0 || v >= of_pixel.height()) return row.clear();
    row.set(of_pixel.row(v), width);
  };
  WideRow cells{width};
  std::vector<std::uint32_t> bits_of(width + kMargin);
  SeenRounds& rounds = groups[g];
  for (auto& round : rounds) round.clear();
  rounds[0].resize(2 * width * kRowsAtOnce);
  SurfelPixel* first_round = rounds[0].data();
  bring(begin - 1);
  bring(begin);
  for (int v = begin; v < end; ++v) {
    bring(v + 1);
    cells.set(of_cell.row(v), width);
    SeenRow row{{}, cells.data(), static_cast<SurfelId>(first_new), width, bits_of.data()};
    for (int i = 0; i < 3; ++i)
      row.pixels[static_cast<std::size_t>(i)] = rows[static_cast<std::size_t>(v + i + 2) % 3].data();
    HWY_DYNAMIC_DISPATCH(seen_by_kernel)(row);
    for (std::size_t u = 0; u < width; ++u) {
      unsigned bits = bits_of[u];
      if (bits == 0) continue;
      const std::uint32_t uv = (static_cast<std::uint32_t>(v) << 16U) + static_cast<std::uint32_t>(u);
      if ((bits & kMadeOwn) != 0) {
        *first_round++ = {row.pixels[1][u], static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v)};
        bits &= ~kMadeOwn;
        if (bits == 0) continue;
      }
      const SurfelId id = row.cells[u];
      *first_round++ = pixel_around(id, bits, uv);
      bits &= bits - 1;
      for (std::size_t k = 1; bits != 0; bits &= bits - 1, ++k) rounds[k].push_back(pixel_around(id, bits, uv));
    }
  }
  rounds[0].resize(static_cast<std::size_t>(first_round - rounds[0].data()));
}

}  // namespace saccade
#endif  // HWY_ONCE
