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

void PagedBricks::clear() {
  store_.reset();  // its memory first
  store_.emplace(compute_);
}

Status PagedBricks::assign(const TsdfSnapshot& map, const Executor& executor) {
  SACCADE_CHECK(check());
  if (!map.grid.all_in_memory()) {
    return Error{Errc::unsupported, "a map with sectors out of memory cannot go to the GPU", "cuda"};
  }
  if (map.config.voxel_size_m != host_.config.voxel_size_m) {
    clear();
    page_ = {};
    host_.grid = {};
  }
  SACCADE_TRY(const TsdfSnapshot before, pull());
  std::vector<SectorBricks> changes = changed_sectors(before.grid, map.grid, executor);
  if (paged_) keep_within(page_, changes);
  host_ = map;
  const Status sent = store_->update(map.grid, changes);
  if (sent.ok()) return sent;
  if (!is_no_room(sent.error())) {
    lose();
    return sent;
  }
  clear();
  paged_ = true;
  page_ = {};
  return {};
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
  return !paged_ || page_.contains(bricks) ? Status{} : page_to(bricks);
}

Status PagedBricks::page_to(const IndexBox& bricks) {
  if (const Result<TsdfSnapshot> whole = pull(); !whole.ok()) return whole.error();
  clear();
  paged_ = true;
  page_ = {};
  const Status sent = store_->update(host_.grid, known_bricks(host_.grid, bricks));
  if (!sent.ok()) {
    clear();
    return sent;
  }
  page_ = bricks;
  return {};
}

}  // namespace saccade::internal::cuda
