// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/brick_store.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "saccade/cuda/internal/gain_kernel.hpp"
#include "saccade/cuda/internal/host_pools.hpp"
#include "saccade/cuda/internal/move_kernel.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr double kMostBricks{1 << 27};
constexpr std::size_t kBricksAtATime{1024};  // on their way from or to the host
constexpr std::size_t kTouchedAtFirst{1 << 14};

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

/// Tells whether a brick takes a slot of the pools.
bool has_voxels(const BrickRef& brick) { return !brick.is_unknown() && brick.kind() != BrickKind::constant_free; }

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
      touched_{compute},
      v_{compute},
      w_{compute},
      unknown_{compute},
      occupied_{compute},
      block_stops_{compute},
      brick_has_cells_{compute},
      block_has_cells_{compute},
      sent_places_{compute},
      sent_entries_{compute},
      sent_v_{compute},
      sent_w_{compute},
      sent_unknown_{compute},
      sent_occupied_{compute},
      touched_count_{compute},
      touched_list_{compute},
      gathered_slots_{compute} {}

Status BrickStore::cover(const IndexBox& bricks) {
  if (bricks.empty() || box_of(bricks_).contains(bricks)) return {};
  const IndexBox box = whole_blocks(box_of(bricks_).hull(bricks));
  if (box.count() > kMostBricks) {
    return Error{Errc::unsupported, "the map spans too much space for a table on the GPU; use larger voxels or the CPU",
                 kNoRoom};
  }
  const TableBox table = table_of(box);
  const TableBox blocks =
      table_of({{box.lo.x / kBlockBrickEdge, box.lo.y / kBlockBrickEdge, box.lo.z / kBlockBrickEdge},
                {box.hi.x / kBlockBrickEdge, box.hi.y / kBlockBrickEdge, box.hi.z / kBlockBrickEdge}});
  SACCADE_CHECK(block_stops_.reserve(blocks.count()));  // all memory before anything changes
  forget_copies();
  Buffer<BrickEntry> entries{compute_};
  SACCADE_CHECK(entries.reserve(table.count()));
  SACCADE_CHECK(entries.fill(0, table.count()));
  Buffer<std::uint8_t> touched{compute_};
  SACCADE_CHECK(touched.reserve(table.count()));
  SACCADE_CHECK(touched.fill(0, table.count()));
  if (bricks_.count() > 0) {
    SACCADE_CHECK(
        launch<MoveEntries>(compute_, blocks_for<MoveEntries>(bricks_.count()),
                            {bricks_, table, entries_.data(), entries.data(), touched_.data(), touched.data()}));
  }
  entries_ = std::move(entries);
  touched_ = std::move(touched);
  bricks_ = table;
  blocks_ = blocks;
  return {};
}

Status BrickStore::reserve_slots(std::size_t more) {
  const std::size_t needed = used_slots_ + more;
  if (needed <= slots()) return {};
  if (needed > BrickEntry::kMostSlots)
    return Error{Errc::unsupported, "the map has too many bricks for the GPU", kNoRoom};
  constexpr std::size_t kLeast{1024};
  const std::size_t ample = std::max({needed, slots() + slots() / 2, kLeast});
  const Status grown = grow_pools(ample);
  return !grown.ok() && is_no_room(grown.error()) && needed < ample ? grow_pools(needed) : grown;
}

Status BrickStore::grow_pools(std::size_t slots) {
  SACCADE_CHECK(w_.reserve(slots * kBrickVoxels, used_slots_ * kBrickVoxels));
  SACCADE_CHECK(unknown_.reserve(slots * kBrickWords, used_slots_ * kBrickWords));
  SACCADE_CHECK(occupied_.reserve(slots * kBrickWords, used_slots_ * kBrickWords));
  return v_.reserve(slots * kBrickVoxels, used_slots_ * kBrickVoxels);  // last: slots() goes by it
}

MapView BrickStore::view() const {
  return {bricks_,         entries_.data(),  touched_.data(), v_.data(),          w_.data(),
          unknown_.data(), occupied_.data(), blocks_,         block_stops_.data()};
}

Status BrickStore::mark_blocks() {
  if (blocks_marked_) return {};
  SACCADE_CHECK(launch<MarkBlocks>(compute_, blocks_for<MarkBlocks>(blocks_.count()), {view()}));
  blocks_marked_ = true;
  return {};
}

Result<SurfaceMarks> BrickStore::mark_surface() {
  SACCADE_CHECK(brick_has_cells_.reserve(bricks_.count()));
  SACCADE_CHECK(block_has_cells_.reserve(blocks_.count()));
  const MarkArguments a{view(), {brick_has_cells_.data(), block_has_cells_.data()}};
  if (surface_marked_) return a.marks;
  SACCADE_CHECK(launch<MarkSurfaceBricks>(compute_, blocks_for<MarkSurfaceBricks>(bricks_.count()), a));
  SACCADE_CHECK(launch<MarkSurfaceBlocks>(compute_, blocks_for<MarkSurfaceBlocks>(blocks_.count()), a));
  surface_marked_ = true;
  return a.marks;
}

Status BrickStore::assign(const TsdfSnapshot& map) {
  bricks_ = blocks_ = {};
  used_slots_ = 0;
  free_slots_.clear();
  forget_copies();
  may_be_touched_ = false;
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
          brick.kind() == BrickKind::constant_free ? BrickEntry::free(brick.constant_weight())
                                                   : pools.add(brick, static_cast<std::uint32_t>(pools.count()));
    }
  }
  const std::size_t stored = pools.count();
  SACCADE_CHECK(reserve_slots(stored));
  used_slots_ = stored;
  SACCADE_CHECK(entries_.assign(entries));
  SACCADE_CHECK(touched_.fill(0, entries.size()));
  SACCADE_CHECK(v_.assign(pools.v));
  SACCADE_CHECK(w_.assign(pools.w));
  SACCADE_CHECK(unknown_.assign(pools.unknown));
  return occupied_.assign(pools.occupied);
}

struct BrickStore::Sent {
  std::vector<std::uint64_t> places;  ///< indices into the table of bricks with voxels
  std::vector<BrickEntry> entries;
  HostPools pools;
  std::vector<std::uint64_t> other_places;  ///< likewise, of all other bricks
  std::vector<BrickEntry> other_entries;
};

BrickEntry BrickStore::entry_for(const BrickRef& brick, BrickEntry before) {
  if (!has_voxels(brick)) {
    if (before.stored()) free_slots_.push_back(before.slot());
    return brick.is_unknown() ? BrickEntry{} : BrickEntry::free(brick.constant_weight());
  }
  if (before.stored()) return before;
  if (free_slots_.empty()) return BrickEntry::at(static_cast<std::uint32_t>(used_slots_++), false, false);
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  return BrickEntry::at(slot, false, false);
}

Status BrickStore::send(const Sent& sent) {
  std::vector<std::uint64_t> places = sent.places;
  std::vector<BrickEntry> entries = sent.entries;
  places.insert(places.end(), sent.other_places.begin(), sent.other_places.end());
  entries.insert(entries.end(), sent.other_entries.begin(), sent.other_entries.end());
  SACCADE_CHECK(sent_places_.assign(places));
  SACCADE_CHECK(sent_entries_.assign(entries));
  SACCADE_CHECK(sent_v_.assign(sent.pools.v));
  SACCADE_CHECK(sent_w_.assign(sent.pools.w));
  SACCADE_CHECK(sent_unknown_.assign(sent.pools.unknown));
  SACCADE_CHECK(sent_occupied_.assign(sent.pools.occupied));
  return launch<PlaceBricks>(
      compute_, places.size(),
      {view(), sent_places_.data(), sent_entries_.data(), static_cast<std::uint32_t>(sent.places.size()),
       sent_v_.data(), sent_w_.data(), sent_unknown_.data(), sent_occupied_.data()});
}

Status BrickStore::update(const TsdfGrid& map, std::span<const SectorBricks> bricks) {
  if (bricks.empty()) return {};
  IndexBox all;
  for (const SectorBricks& some : bricks) all = all.hull(IndexBox::cube(some.sector * kSectorEdge, kSectorEdge));
  SACCADE_CHECK(cover(all));
  if (known_entries_.empty()) {
    known_entries_.resize(bricks_.count());
    SACCADE_CHECK(entries_.read(known_entries_));
  }
  const auto for_each_brick = [&](const auto& visit) {
    for (const SectorBricks& some : bricks) {
      const Sector* const sector = map.find(some.sector);
      some.bricks.for_each([&](std::size_t i) {
        visit(bricks_.at(some.sector * kSectorEdge + child_offset(static_cast<int>(i))),
              sector != nullptr ? sector->bricks[i] : BrickRef{});
      });
    }
  };
  std::size_t added{0};
  for_each_brick([&](std::uint64_t place, const BrickRef& brick) {
    if (has_voxels(brick) && !known_entries_[place].stored()) ++added;
  });
  SACCADE_CHECK(reserve_slots(added - std::min(added, free_slots_.size())));
  blocks_marked_ = surface_marked_ = false;
  Sent sent;
  Status failed;
  const auto flush = [&] {
    if (failed.ok() && !(sent.places.empty() && sent.other_places.empty())) failed = send(sent);
    sent = {};
  };
  for_each_brick([&](std::uint64_t place, const BrickRef& brick) {
    BrickEntry& entry = known_entries_[place];
    entry = entry_for(brick, entry);
    if (entry.stored()) {
      entry = sent.pools.add(brick, entry.slot());
      sent.places.push_back(place);
      sent.entries.push_back(entry);
    } else {
      sent.other_places.push_back(place);
      sent.other_entries.push_back(entry);
    }
    if (sent.places.size() + sent.other_places.size() >= kBricksAtATime) flush();
  });
  flush();
  return failed;
}

Status BrickStore::reserve_pull() {
  SACCADE_CHECK(touched_count_.reserve(1));
  SACCADE_CHECK(touched_list_.reserve(kTouchedAtFirst));
  SACCADE_CHECK(gathered_slots_.reserve(kBricksAtATime));
  SACCADE_CHECK(sent_v_.reserve(kBricksAtATime * kBrickVoxels));
  return sent_w_.reserve(kBricksAtATime * kBrickVoxels);
}

Result<std::vector<TouchedBrick>> BrickStore::touched_in_table() {
  std::vector<std::uint8_t> flags(bricks_.count());
  std::vector<BrickEntry> entries(bricks_.count());
  SACCADE_CHECK(touched_.read(flags));
  SACCADE_CHECK(entries_.read(entries));
  std::vector<TouchedBrick> touched;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] != 0) touched.push_back({static_cast<std::uint32_t>(i), entries[i]});
  }
  return touched;
}

Result<std::vector<TouchedBrick>> BrickStore::touched() {
  SACCADE_CHECK(reserve_pull());
  std::array<std::uint32_t, 1> count{};
  for (;;) {
    SACCADE_CHECK(touched_count_.assign(std::array<std::uint32_t, 1>{}));
    SACCADE_CHECK(launch<ListTouched>(
        compute_, blocks_for<ListTouched>(bricks_.count()),
        {view(), touched_count_.data(), touched_list_.data(), static_cast<std::uint32_t>(touched_list_.capacity())}));
    SACCADE_CHECK(touched_count_.read(count));
    if (count[0] <= touched_list_.capacity()) break;
    if (!touched_list_.reserve(count[0]).ok()) return touched_in_table();
  }
  std::vector<TouchedBrick> touched(count[0]);
  SACCADE_CHECK(touched_list_.read(touched));
  std::sort(touched.begin(), touched.end(),
            [](const TouchedBrick& a, const TouchedBrick& b) { return a.place < b.place; });
  return touched;
}

Result<std::vector<BrickRef>> BrickStore::gather(std::span<const std::uint32_t> slots, std::uint16_t free_weight) {
  std::vector<BrickRef> bricks;
  std::vector<std::int16_t> v;
  std::vector<std::uint16_t> w;
  for (std::size_t first = 0; first < slots.size(); first += kBricksAtATime) {
    const std::span<const std::uint32_t> some = slots.subspan(first, std::min(kBricksAtATime, slots.size() - first));
    v.resize(some.size() * kBrickVoxels);
    w.resize(some.size() * kBrickVoxels);
    SACCADE_CHECK(gathered_slots_.assign(some));
    SACCADE_CHECK(sent_v_.reserve(v.size()));
    SACCADE_CHECK(sent_w_.reserve(w.size()));
    SACCADE_CHECK(
        launch<GatherBricks>(compute_, some.size(), {view(), gathered_slots_.data(), sent_v_.data(), sent_w_.data()}));
    SACCADE_CHECK(sent_v_.read(v));
    SACCADE_CHECK(sent_w_.read(w));
    for (std::size_t i = 0; i < some.size(); ++i)
      bricks.push_back(brick_of(v.data() + i * kBrickVoxels, w.data() + i * kBrickVoxels, free_weight));
  }
  return bricks;
}

Status BrickStore::pull(TsdfSnapshot& map) {
  if (!may_be_touched_ || bricks_.count() == 0) return {};
  SACCADE_TRY(const std::vector<TouchedBrick> touched, this->touched());
  std::vector<std::uint32_t> slots;
  for (const TouchedBrick& brick : touched) {
    if (brick.entry.stored()) slots.push_back(brick.entry.slot());
  }
  SACCADE_TRY(std::vector<BrickRef> stored, gather(slots, map.config.free_weight));
  SACCADE_CHECK(touched_.fill(0, bricks_.count()));
  SACCADE_CHECK(compute_.finish());
  std::size_t next{0};
  for (const auto& [place, entry] : touched) {
    const Index3 brick = bricks_.index(place);
    Sector& sector = map.grid.writable(parent(brick));
    sector.bricks[static_cast<std::size_t>(child_index(brick))] =
        entry.stored() ? std::move(stored[next++])
                       : BrickRef::constant_free(static_cast<std::uint16_t>(entry.weight()));
    sector.update_summary(child_index(brick), map.config.free_weight);
  }
  may_be_touched_ = false;
  return {};
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
