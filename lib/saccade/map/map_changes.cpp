// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/map_changes.hpp"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace saccade {
namespace {

Mask512 differing_bricks(const Sector* before, const Sector* after) {
  Mask512 differing;
  if (before == after) return differing;
  const BrickRef unknown;
  for (int i = 0; i < kSectorBricks; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const BrickRef& was = before != nullptr ? before->bricks[k] : unknown;
    const BrickRef& is = after != nullptr ? after->bricks[k] : unknown;
    if (!(was == is)) differing.set(i);
  }
  return differing;
}

/// Returns the sectors of either grid, in z-y-x order.
std::vector<Index3> sectors_of_both(const TsdfGrid& before, const TsdfGrid& after) {
  const std::vector<Index3> first = before.sorted_sectors();
  const std::vector<Index3> second = after.sorted_sectors();
  std::vector<Index3> keys;
  keys.reserve(std::max(first.size(), second.size()));
  std::set_union(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(keys), zyx_less);
  return keys;
}

/// Bricks -1 … 8 of a sector along each axis: one row per (y, z), bit x + 1.
class PaddedSector {
 public:
  explicit PaddedSector(const Mask512& bricks) {
    for (int z = 0; z < kSectorEdge; ++z) {
      for (int y = 0; y < kSectorEdge; ++y) {
        const auto row = static_cast<unsigned>((bricks.words[static_cast<std::size_t>(z)] >> (8 * y)) & 0xFFU);
        if (row != 0) add_around(row | (row << 1) | (row << 2), y, z);
      }
    }
  }
  [[nodiscard]] unsigned row(int y, int z) const { return rows_[at(y, z)]; }

 private:
  static std::size_t at(int y, int z) { return static_cast<std::size_t>((z + 1) * (kSectorEdge + 2) + y + 1); }
  void add_around(unsigned row, int y, int z) {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) rows_[at(y + dy, z + dz)] |= row;
    }
  }
  std::array<unsigned, std::size_t{kSectorEdge + 2} * (kSectorEdge + 2)> rows_{};
};

}  // namespace

std::vector<SectorBricks> changed_sectors(const TsdfGrid& before, const TsdfGrid& after, const Executor& executor) {
  std::vector<SectorBricks> sectors;
  for (const Index3& key : sectors_of_both(before, after)) sectors.push_back({key, {}});
  executor.parallel_for(sectors.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      sectors[i].bricks = differing_bricks(before.find(sectors[i].sector), after.find(sectors[i].sector));
    }
  });
  std::erase_if(sectors, [](const SectorBricks& changed) { return changed.bricks.none(); });
  return sectors;
}

std::vector<Index3> changed_bricks(const TsdfGrid& before, const TsdfGrid& after, const Executor& executor) {
  std::vector<Index3> bricks;
  for (const SectorBricks& changed : changed_sectors(before, after, executor)) {
    changed.bricks.for_each(
        [&](std::size_t i) { bricks.push_back(changed.sector * kSectorEdge + child_offset(static_cast<int>(i))); });
  }
  return bricks;
}

std::vector<SectorBricks> with_neighbors(std::span<const SectorBricks> sectors) {
  std::unordered_map<Index3, Mask512, Index3Hash> grown;
  for (const SectorBricks& changed : sectors) {
    const PaddedSector padded{changed.bricks};
    for (int z = -1; z <= kSectorEdge; ++z) {
      for (int y = -1; y <= kSectorEdge; ++y) {
        const unsigned row = padded.row(y, z);
        const auto give = [&](int dx, unsigned bits) {
          if (bits == 0) return;
          const Index3 sector = changed.sector + Index3{dx, y >> 3, z >> 3};
          grown[sector].words[static_cast<std::size_t>(z & 7)] |= std::uint64_t{bits} << (8 * (y & 7));
        };
        give(-1, (row & 1U) << 7);
        give(0, (row >> 1) & 0xFFU);
        give(1, row >> 9);
      }
    }
  }
  std::vector<SectorBricks> result;
  result.reserve(grown.size());
  for (const auto& [sector, bricks] : grown) result.push_back({sector, bricks});
  std::sort(result.begin(), result.end(),
            [](const SectorBricks& a, const SectorBricks& b) { return zyx_less(a.sector, b.sector); });
  return result;
}

}  // namespace saccade
