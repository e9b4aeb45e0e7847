// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_association.hpp"

#include <algorithm>
#include <bit>

namespace saccade {
namespace {

constexpr unsigned kAround{9};  ///< cells
constexpr unsigned kAll{(1U << kAround) - 1U};
constexpr unsigned kNewSurfel{1U << kAround};

/// Bit i: the i-th pixel around the cell, row by row, saw the cell's surfel. kNewSurfel: the pixel made its own.
void seen_by(const SurfelAssociation& seen, int v, std::vector<std::uint32_t>& bits) {
  const SurfelId* cells = seen.of_cell.row(v);
  const SurfelId* own = seen.of_pixel.row(v);
  const std::size_t width = bits.size();
  for (std::size_t u = 0; u < width; ++u) {
    const bool is_new = own[u] != kNoSurfel && own[u] >= seen.first_new;
    bits[u] = is_new ? kNewSurfel : 0U;
  }
  for (unsigned i = 0; i < kAround; ++i) {
    const int row = v + static_cast<int>(i / 3) - 1;
    if (row < 0 || row >= seen.of_pixel.height()) continue;
    const SurfelId* pixels = seen.of_pixel.row(row);
    const std::size_t shift = i % 3;  // pixel u + shift − 1
    const std::size_t last = shift == 2 ? width - 1 : width;
    for (std::size_t u = shift == 0 ? 1 : 0; u < last; ++u) {
      const bool here = pixels[u + shift - 1] == cells[u] && cells[u] != kNoSurfel;
      bits[u] |= here ? 1U << i : 0U;
    }
  }
}

SurfelPixel pixel_around(SurfelId id, unsigned bits, int u, int v) {
  constexpr std::array<int, kAround + 1> kColumns{-1, 0, 1, -1, 0, 1, -1, 0, 1, 0};
  constexpr std::array<int, kAround + 1> kRows{-1, -1, -1, 0, 0, 0, 1, 1, 1, 0};
  const auto first = static_cast<std::size_t>(std::countr_zero(bits | kNewSurfel));
  return {id, static_cast<std::uint16_t>(u + kColumns[first]), static_cast<std::uint16_t>(v + kRows[first])};
}

}  // namespace

void SurfelAssociation::collect(std::size_t g) {
  const int begin = static_cast<int>(g) * kRowsAtOnce;
  const int end = std::min(begin + kRowsAtOnce, of_pixel.height());
  const auto width = static_cast<std::size_t>(of_pixel.width());
  SeenRounds& rounds = groups[g];
  for (auto& round : rounds) round.clear();
  rounds[0].resize(2 * width * kRowsAtOnce + 1);
  std::size_t count{0};
  std::vector<std::uint32_t> bits_of(width);
  for (int v = begin; v < end; ++v) {
    seen_by(*this, v, bits_of);
    const SurfelId* cells = of_cell.row(v);
    const SurfelId* own = of_pixel.row(v);
    for (std::size_t u = 0; u < width; ++u) {
      // Nobody can guess which pixels there are: all are written, and some at once replaced.
      unsigned bits = bits_of[u];
      rounds[0][count] = {own[u], static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v)};
      count += bits >> kAround;
      bits &= kAll;
      rounds[0][count] = pixel_around(cells[u], bits, static_cast<int>(u), v);
      count += bits != 0 ? 1U : 0U;
      bits &= bits - 1;
      for (std::size_t k = 1; bits != 0; bits &= bits - 1, ++k) {
        rounds[k].push_back(pixel_around(cells[u], bits, static_cast<int>(u), v));
      }
    }
  }
  rounds[0].resize(count);
}

}  // namespace saccade
