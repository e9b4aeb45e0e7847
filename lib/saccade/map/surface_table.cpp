// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/surface_table.hpp"

#include <algorithm>

namespace saccade {
namespace {

/// A bit is set where it was, or where the bit one step further along the axis is; `next` is the mask beyond the end.
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

/// masks[i] belongs to the neighbour at (i & 1, i >> 1 & 1, i >> 2 & 1); the result says for each position of the first
/// mask whether any of its eight cell corners is set.
Mask512 any_corner(const std::array<Mask512, 8>& masks) {
  const auto along_x = [&](std::size_t i) { return spread_x(masks[i], masks[i + 1]); };
  const auto along_xy = [&](std::size_t i) { return spread_y(along_x(i), along_x(i + 2)); };
  return spread_z(along_xy(0), along_xy(4));
}

Index3 corner(std::size_t i) {
  return {static_cast<std::int32_t>(i & 1), static_cast<std::int32_t>((i >> 1) & 1),
          static_cast<std::int32_t>((i >> 2) & 1)};
}

/// Bricks of the sector that have an occupied voxel among the corners of their cells.
Mask512 candidate_bricks(const SectorTable& sectors, const Index3& key) {
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

}  // namespace

SurfaceTable::SurfaceTable(const TsdfGrid& grid, const Executor& executor)
    : sectors_{grid}, keys_{grid.sorted_sectors()}, surfaces_(keys_.size()), cells_(keys_.size()) {
  executor.parallel_for(keys_.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Mask512 candidates = candidate_bricks(sectors_, keys_[s]);
      if (candidates.none()) continue;
      for (int i = 0; i < kSectorBricks; ++i) {
        if (i % 64 == 0)
          surfaces_[s].rank[static_cast<std::size_t>(i / 64)] = static_cast<std::uint16_t>(cells_[s].size());
        if (!candidates.test(i)) continue;
        const Mask512 cells = crossed_cells(sectors_, keys_[s] * kSectorEdge + child_offset(i));
        if (cells.none()) continue;
        surfaces_[s].bricks.set(i);
        cells_[s].push_back(cells);
      }
      surfaces_[s].cells = cells_[s].data();
    }
  });
  if (!sectors_.is_flat() || keys_.empty()) return;
  const IndexBox& box = sectors_.box();
  flat_.resize(sectors_.flat_index(box.hi - Index3{1, 1, 1}) + 1);
  for (std::size_t s = 0; s < keys_.size(); ++s) {
    if (surfaces_[s].bricks.any()) flat_[sectors_.flat_index(keys_[s])] = &surfaces_[s];
  }
}

const SurfaceTable::SectorSurface* SurfaceTable::find(const Index3& sector) const {
  if (!sectors_.box().contains(sector)) return nullptr;
  if (sectors_.is_flat()) return flat_[sectors_.flat_index(sector)];
  const auto it = std::lower_bound(keys_.begin(), keys_.end(), sector, zyx_less);
  if (it == keys_.end() || !(*it == sector)) return nullptr;
  const SectorSurface& found = surfaces_[static_cast<std::size_t>(it - keys_.begin())];
  return found.bricks.any() ? &found : nullptr;
}

}  // namespace saccade
