// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/paged_bricks.hpp"

namespace saccade::internal::cuda {
namespace {

/// Returns the bricks of a box that hold anything known.
std::vector<SectorBricks> known_bricks(const TsdfGrid& grid, const IndexBox& bricks) {
  std::vector<SectorBricks> known;
  if (bricks.empty()) return known;
  parents(bricks).intersection(grid.sector_bounds()).for_each([&](const Index3& key) {
    const Sector* const sector = grid.find(key);
    if (sector == nullptr) return;
    SectorBricks some{key, {}};
    for (int i = 0; i < kSectorBricks; ++i) {
      if (!sector->bricks[static_cast<std::size_t>(i)].is_unknown() &&
          bricks.contains(key * kSectorEdge + child_offset(i)))
        some.bricks.set(i);
    }
    if (some.bricks.any()) known.push_back(some);
  });
  return known;
}

/// Drops the bricks that lie outside a box.
void keep_within(const IndexBox& box, std::vector<SectorBricks>& changes) {
  for (SectorBricks& some : changes) {
    Mask512 inside;
    some.bricks.for_each([&](std::size_t i) {
      const int child = static_cast<int>(i);
      if (box.contains(some.sector * kSectorEdge + child_offset(child))) inside.set(child);
    });
    some.bricks = inside;
  }
  std::erase_if(changes, [](const SectorBricks& some) { return some.bricks.none(); });
}

}  // namespace

Status PagedBricks::check() const {
  if (!is_lost()) return {};
  return Error{Errc::unavailable, "the GPU was lost, with what it had fused since the last snapshot", "cuda"};
}

PagedBricks::Load PagedBricks::load_of(std::span<const SectorBricks> known) {
  Load load{0, 0.0};
  IndexBox sectors;
  for (const SectorBricks& some : known) {
    load.bricks += static_cast<std::size_t>(some.bricks.count());
    sectors = sectors.hull(IndexBox::cube(some.sector, 1));
  }
  if (!sectors.empty()) load.table = sectors.count() * kSectorBricks;
  return load;
}

void PagedBricks::clear() {
  store_.reset();  // its memory first
  store_.emplace(compute_);
}

Status PagedBricks::send(const TsdfGrid& map, std::span<const SectorBricks> known) {
  Status sent = store_->update(map, known);
  if (!sent.ok() && is_no_room(sent.error()) && free_scratch_) {
    clear();
    free_scratch_();
    sent = store_->update(map, known);
  }
  if (!sent.ok()) clear();
  return sent;
}

Status PagedBricks::assign(const TsdfSnapshot& map, const Executor& executor) {
  SACCADE_CHECK(check());
  if (!map.grid.all_in_memory()) {
    return Error{Errc::unsupported, "a map with sectors out of memory cannot go to the GPU", "cuda"};
  }
  const bool other_voxels = map.config.voxel_size_m != host_.config.voxel_size_m;
  const bool fits_now = paged_ && load_of(changed_sectors({}, map.grid, executor)).is_below(too_much_);
  if (other_voxels || fits_now) {
    clear();
    paged_ = false;
    page_ = evicted_ = {};
    host_.grid = {};
  }
  if (other_voxels) too_much_ = {};
  SACCADE_TRY(const TsdfSnapshot before, pull());
  std::vector<SectorBricks> changes = changed_sectors(before.grid, map.grid, executor);
  if (paged_) keep_within(page_, changes);
  host_ = map;
  Status sent = store_->update(map.grid, changes);
  const auto lacks_room = [&] { return !sent.ok() && is_no_room(sent.error()); };
  if (lacks_room() && !paged_) {
    const std::vector<SectorBricks> all = changed_sectors({}, map.grid, executor);
    clear();
    if (free_scratch_) free_scratch_();
    sent = store_->update(map.grid, all);
    if (lacks_room()) too_much_ = load_of(all);
  }
  if (lacks_room()) {
    clear();
    paged_ = true;
    page_ = evicted_ = {};
    return {};
  }
  if (!sent.ok()) lose();
  return sent;
}

Result<TsdfSnapshot> PagedBricks::pull() {
  SACCADE_CHECK(check());
  if (const Status pulled = store_->pull(host_); !pulled.ok()) {
    if (!is_no_room(pulled.error())) lose();  // what was fused is still there, and may come home when there is room
    return pulled.error();
  }
  return host_;
}

Status PagedBricks::bring_in(const IndexBox& bricks) {
  SACCADE_CHECK(check());
  if (!paged_ || page_.contains(bricks)) return {};
  if (evicted_.overlaps(bricks)) {
    SACCADE_CHECK(pull());
    const IndexBox both = page_.hull(bricks);
    constexpr double kMostSectors{1 << 18};  // no table holds more
    const IndexBox sectors = parents(both).intersection(host_.grid.sector_bounds());
    const bool is_small = sectors.empty() || sectors.count() <= kMostSectors;
    const Load load = is_small ? load_of(known_bricks(host_.grid, both)) : Load{};
    if (load.is_below(too_much_)) {
      const Status sent = page_to(both);
      if (sent.ok() || !is_no_room(sent.error())) return sent;
      too_much_ = load;
    }
  }
  return page_to(bricks);
}

Status PagedBricks::note_too_much() {
  SACCADE_CHECK(pull());
  const Load load = load_of(paged_ ? known_bricks(host_.grid, page_) : changed_sectors({}, host_.grid, {}));
  if (load.bricks > 0 && load.is_below(too_much_)) too_much_ = load;
  return {};
}

Status PagedBricks::page_to(const IndexBox& bricks) {
  SACCADE_CHECK(pull());
  clear();
  paged_ = true;
  if (!page_.empty()) evicted_ = page_;
  page_ = {};
  SACCADE_CHECK(send(host_.grid, known_bricks(host_.grid, bricks)));
  page_ = bricks;
  return {};
}

}  // namespace saccade::internal::cuda
