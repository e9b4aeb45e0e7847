// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/brick_store.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "saccade/cuda/internal/gain_kernel.hpp"
#include "saccade/cuda/internal/move_kernel.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr double kMostBricks{1 << 27};

TableBox table_of(const IndexBox& box) {
  const Index3 size = box.size();
  return {box.lo, static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y),
          static_cast<std::uint32_t>(size.z)};
}
IndexBox box_of(const TableBox& table) {
  return {table.lo, table.lo + Index3{static_cast<std::int32_t>(table.size_x), static_cast<std::int32_t>(table.size_y),
                                      static_cast<std::int32_t>(table.size_z)}};
}

/// Grows a box of bricks to whole blocks.
IndexBox whole_blocks(const IndexBox& bricks) {
  const auto down = [](std::int32_t i) { return i & ~(kBlockBrickEdge - 1); };
  const auto up = [&](std::int32_t i) { return down(i + kBlockBrickEdge - 1); };
  return {{down(bricks.lo.x), down(bricks.lo.y), down(bricks.lo.z)},
          {up(bricks.hi.x), up(bricks.hi.y), up(bricks.hi.z)}};
}

/// Stored bricks on their way to the device.
struct HostPools {
  std::vector<std::int16_t> v;
  std::vector<std::uint16_t> w;
  std::vector<std::uint64_t> unknown;
  std::vector<std::uint64_t> occupied;

  BrickEntry add(const BrickRef& brick) {
    const auto slot = static_cast<std::uint32_t>(unknown.size() / kBrickWords);
    for (int i = 0; i < kBrickVoxels; ++i) {
      const Voxel voxel = brick.voxel(i);
      v.push_back(voxel.v);
      w.push_back(voxel.w);
    }
    const Mask512 unknown_voxels = brick.unknown_mask();
    const Mask512 occupied_voxels = brick.occupied_mask();
    unknown.insert(unknown.end(), unknown_voxels.words.begin(), unknown_voxels.words.end());
    occupied.insert(occupied.end(), occupied_voxels.words.begin(), occupied_voxels.words.end());
    return BrickEntry::at(slot, (unknown_voxels | occupied_voxels).any(), occupied_voxels.any());
  }
};

BrickRef brick_of(const std::int16_t* v, const std::uint16_t* w, std::uint16_t free_weight) {
  BrickRef brick = BrickRef::make_dense();
  DenseBrick& dense = brick.writable_dense();
  std::copy_n(v, kBrickVoxels, dense.v.begin());
  std::copy_n(w, kBrickVoxels, dense.w.begin());
  dense.update_masks();
  brick.canonicalize(free_weight);
  return brick;
}

}  // namespace

BrickStore::BrickStore(Compute& compute)
    : compute_{compute},
      entries_{compute},
      v_{compute},
      w_{compute},
      unknown_{compute},
      occupied_{compute},
      block_stops_{compute} {}

Status BrickStore::cover(const IndexBox& bricks) {
  if (bricks.empty() || box_of(bricks_).contains(bricks)) return {};
  const IndexBox box = whole_blocks(box_of(bricks_).hull(bricks));
  if (box.count() > kMostBricks) {
    return Error{Errc::unsupported, "the map spans too much space for a table on the GPU; use larger voxels or the CPU",
                 "cuda"};
  }
  const TableBox table = table_of(box);
  const TableBox blocks =
      table_of({{box.lo.x / kBlockBrickEdge, box.lo.y / kBlockBrickEdge, box.lo.z / kBlockBrickEdge},
                {box.hi.x / kBlockBrickEdge, box.hi.y / kBlockBrickEdge, box.hi.z / kBlockBrickEdge}});
  SACCADE_CHECK(block_stops_.reserve(blocks.count()));  // all memory before anything changes
  changed();
  Buffer<BrickEntry> entries{compute_};
  SACCADE_CHECK(entries.reserve(table.count()));
  SACCADE_CHECK(entries.fill(0, table.count()));
  if (bricks_.count() > 0) {
    SACCADE_CHECK(launch<MoveEntries>(compute_, blocks_for<MoveEntries>(bricks_.count()),
                                      {bricks_, table, entries_.data(), entries.data()}));
  }
  entries_ = std::move(entries);
  bricks_ = table;
  blocks_ = blocks;
  return {};
}

Status BrickStore::reserve_slots(std::size_t more) {
  const std::size_t needed = used_slots_ + more;
  if (needed <= slots()) return {};
  if (needed > BrickEntry::kMostSlots)
    return Error{Errc::unsupported, "the map has too many bricks for the GPU", "cuda"};
  constexpr std::size_t kLeast{1024};
  const std::size_t grown = std::max({needed, slots() + slots() / 2, kLeast});
  SACCADE_CHECK(w_.reserve(grown * kBrickVoxels, used_slots_ * kBrickVoxels));
  SACCADE_CHECK(unknown_.reserve(grown * kBrickWords, used_slots_ * kBrickWords));
  SACCADE_CHECK(occupied_.reserve(grown * kBrickWords, used_slots_ * kBrickWords));
  return v_.reserve(grown * kBrickVoxels, used_slots_ * kBrickVoxels);
}

MapView BrickStore::view() const {
  return {bricks_,         entries_.data(),  v_.data(), w_.data(),
          unknown_.data(), occupied_.data(), blocks_,   block_stops_.data()};
}

Status BrickStore::mark_blocks() {
  if (blocks_marked_) return {};
  SACCADE_CHECK(launch<MarkBlocks>(compute_, blocks_for<MarkBlocks>(blocks_.count()), {view()}));
  blocks_marked_ = true;
  return {};
}

Status BrickStore::assign(const TsdfSnapshot& map) {
  bricks_ = blocks_ = {};
  used_slots_ = 0;
  changed();
  if (map.grid.empty()) return {};
  const IndexBox sectors = map.grid.sector_bounds();
  SACCADE_CHECK(cover({sectors.lo * kSectorEdge, sectors.hi * kSectorEdge}));
  std::vector<BrickEntry> entries(bricks_.count(), BrickEntry{});
  HostPools pools;
  for (const Index3& key : map.grid.sorted_sectors()) {
    const Sector& sector = *map.grid.find(key);
    for (int i = 0; i < kSectorBricks; ++i) {
      const BrickRef& brick = sector.bricks[static_cast<std::size_t>(i)];
      if (brick.is_unknown()) continue;
      entries[bricks_.at(key * kSectorEdge + child_offset(i))] =
          brick.kind() == BrickKind::constant_free ? BrickEntry::free(brick.constant_weight()) : pools.add(brick);
    }
  }
  const std::size_t stored = pools.unknown.size() / kBrickWords;
  SACCADE_CHECK(reserve_slots(stored));
  used_slots_ = stored;
  SACCADE_CHECK(entries_.assign(entries));
  SACCADE_CHECK(v_.assign(pools.v));
  SACCADE_CHECK(w_.assign(pools.w));
  SACCADE_CHECK(unknown_.assign(pools.unknown));
  return occupied_.assign(pools.occupied);
}

Result<TsdfSnapshot> BrickStore::snapshot(const TsdfConfig& config) const {
  TsdfSnapshot map{config, {}};
  std::vector<BrickEntry> entries(bricks_.count());
  std::vector<std::int16_t> v(used_slots_ * kBrickVoxels);
  std::vector<std::uint16_t> w(used_slots_ * kBrickVoxels);
  SACCADE_CHECK(entries_.read(entries));
  SACCADE_CHECK(v_.read(v));
  SACCADE_CHECK(w_.read(w));
  for (std::uint64_t at = 0; at < entries.size(); ++at) {
    const BrickEntry entry = entries[at];
    if (entry.unknown()) continue;
    const Index3 brick = bricks_.index(at);
    const std::size_t first = std::size_t{entry.slot()} * kBrickVoxels;
    BrickRef ref = entry.stored() ? brick_of(v.data() + first, w.data() + first, config.free_weight)
                                  : BrickRef::constant_free(static_cast<std::uint16_t>(entry.weight()));
    if (ref.is_unknown()) continue;
    Sector& sector = map.grid.writable(parent(brick));
    sector.bricks[static_cast<std::size_t>(child_index(brick))] = std::move(ref);
    sector.update_summary(child_index(brick), config.free_weight);
  }
  return map;
}

}  // namespace saccade::internal::cuda
