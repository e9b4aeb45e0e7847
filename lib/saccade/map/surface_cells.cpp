// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/surface_cells.hpp"

#include <array>

namespace saccade {
namespace {

/// Sets each bit that was set, or whose next bit along the axis is; `next` is the mask beyond the end.
Mask512 spread_x(const Mask512& mask, const Mask512& next) {
  constexpr std::uint64_t kNotLastColumn{0x7F7F7F7F7F7F7F7FULL};
  constexpr std::uint64_t kFirstColumn{0x0101010101010101ULL};
  Mask512 out;
  for (std::size_t z = 0; z < 8; ++z) {
    out.words[z] = mask.words[z] | ((mask.words[z] >> 1) & kNotLastColumn) | ((next.words[z] & kFirstColumn) << 7);
  }
  return out;
}
Mask512 spread_y(const Mask512& mask, const Mask512& next) {
  Mask512 out;
  for (std::size_t z = 0; z < 8; ++z) {
    out.words[z] = mask.words[z] | (mask.words[z] >> 8) | ((next.words[z] & 0xFF) << 56);
  }
  return out;
}
Mask512 spread_z(const Mask512& mask, const Mask512& next) {
  Mask512 out;
  for (std::size_t z = 0; z < 8; ++z) out.words[z] = mask.words[z] | (z < 7 ? mask.words[z + 1] : next.words[0]);
  return out;
}

/// Tells for each position of the first mask whether any of its eight cell corners is set. masks[i] belongs to the
/// neighbour at (i & 1, i >> 1 & 1, i >> 2 & 1).
Mask512 any_corner(const std::array<Mask512, 8>& masks) {
  const auto along_x = [&](std::size_t i) { return spread_x(masks[i], masks[i + 1]); };
  const auto along_xy = [&](std::size_t i) { return spread_y(along_x(i), along_x(i + 2)); };
  return spread_z(along_xy(0), along_xy(4));
}

Index3 corner(std::size_t i) {
  return {static_cast<std::int32_t>(i & 1), static_cast<std::int32_t>((i >> 1) & 1),
          static_cast<std::int32_t>((i >> 2) & 1)};
}

}  // namespace

Mask512 bricks_with_occupied_corner(const SectorTable& sectors, const Index3& key) {
  std::array<Mask512, 8> occupied;
  for (std::size_t i = 0; i < 8; ++i) {
    const Sector* sector = sectors.find(key + corner(i));
    if (sector != nullptr) occupied[i] = sector->has_occupied;
  }
  return any_corner(occupied);
}

Mask512 crossed_cells(const SectorTable& sectors, const Index3& brick) {
  std::array<Mask512, 8> occupied;
  std::array<Mask512, 8> empty;
  std::array<Mask512, 8> unknown;
  for (std::size_t i = 0; i < 8; ++i) {
    const Index3 neighbour = brick + corner(i);
    const Sector* sector = sectors.find(parent(neighbour));
    if (sector == nullptr) {
      unknown[i] = Mask512::all_set();
      continue;
    }
    const BrickRef& ref = sector->bricks[static_cast<std::size_t>(child_index(neighbour))];
    unknown[i] = ref.unknown_mask();
    occupied[i] = ref.occupied_mask();
    empty[i] = ~(unknown[i] | occupied[i]);
  }
  return any_corner(occupied) & any_corner(empty) & ~any_corner(unknown);
}

IndexBox bounds_of(const Mask512& mask) {
  std::uint64_t slices{0};  // bit z: something in slice z
  std::uint64_t all{0};
  for (std::size_t z = 0; z < 8; ++z) {
    slices |= std::uint64_t{mask.words[z] != 0} << z;
    all |= mask.words[z];
  }
  std::uint64_t rows{0};
  std::uint64_t columns{0};
  for (int y = 0; y < 8; ++y) {
    const std::uint64_t row = (all >> (8 * y)) & 0xFF;
    rows |= std::uint64_t{row != 0} << y;
    columns |= row;
  }
  const auto first = [](std::uint64_t bits) { return std::countr_zero(bits); };
  const auto end = [](std::uint64_t bits) { return 64 - std::countl_zero(bits); };
  return {{first(columns), first(rows), first(slices)}, {end(columns), end(rows), end(slices)}};
}

}  // namespace saccade
