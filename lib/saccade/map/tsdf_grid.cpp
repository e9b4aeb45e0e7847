// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "saccade/map/sector_store.hpp"

namespace saccade {
namespace {

[[noreturn]] void refuse(const Index3& sector) {
  throw ContractViolation{"sector (" + std::to_string(sector.x) + ", " + std::to_string(sector.y) + ", " +
                          std::to_string(sector.z) + ") of the map is paged out; bring it in before it is read"};
}

}  // namespace

Status TsdfConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "map configuration"}; };
  if (!(voxel_size_m >= 1e-4 && voxel_size_m <= 1.0)) return fail("the voxel size must be within 0.0001 and 1 m");
  if (!(truncation_vox >= 1.0 && truncation_vox <= 64.0)) return fail("the truncation must be within 1 and 64 voxels");
  if (max_weight < 1 || max_weight > 500) return fail("the maximum weight must be within 1 and 500");
  if (free_weight < 1 || free_weight > 7) return fail("the free-space weight must be within 1 and 7");
  if (free_weight > max_weight) return fail("the free-space weight must not exceed the maximum weight");
  if (clearing_percent < 1 || clearing_percent > 100) return fail("the clearing share must be within 1 and 100 %");
  if (workspace) {
    if (const Status valid = saccade::validate(Region{*workspace}); !valid) return fail("the workspace box is empty");
    const double largest = std::max(workspace->min.cwiseAbs().maxCoeff(), workspace->max.cwiseAbs().maxCoeff());
    if (largest > 1000.0) return fail("the workspace must lie within 1000 m of the origin");
  }
  return {};
}

IndexBox voxels_with_center_in(const Box& box, double voxel_size_m) {
  // The centre test itself decides at the borders, for agreement with contains(Box, voxel_center) to the bit.
  const auto first_at_or_above = [&](double bound) {
    constexpr double kFarthest{1e9};  // beyond any map
    const double near = std::clamp(std::floor(bound / voxel_size_m - 0.5), -kFarthest, kFarthest);
    auto i = static_cast<std::int32_t>(near) - 1;
    if (std::abs(near) == kFarthest) return i;
    while ((i + 0.5) * voxel_size_m < bound) ++i;
    return i;
  };
  return {{first_at_or_above(box.min.x()), first_at_or_above(box.min.y()), first_at_or_above(box.min.z())},
          {first_at_or_above(box.max.x()), first_at_or_above(box.max.y()), first_at_or_above(box.max.z())}};
}

const Sector* TsdfGrid::find(const Index3& sector) const {
  const auto it = sectors_.find(sector);
  if (it != sectors_.end()) return it->second.get();
  if (is_away(sector)) refuse(sector);
  return nullptr;
}

Sector& TsdfGrid::writable(const Index3& sector) {
  if (is_away(sector)) refuse(sector);
  SectorRef& slot = sectors_[sector];
  if (!slot) slot = SectorRef::make();
  return slot.writable();
}

Sector& TsdfGrid::writable_existing(const Index3& sector) {
  const auto it = sectors_.find(sector);
  SACCADE_EXPECTS(it != sectors_.end());
  return it->second.writable();
}

std::shared_ptr<const StoredSector> TsdfGrid::away(const Index3& sector) const {
  const auto it = away_.find(sector);
  return it == away_.end() ? nullptr : it->second;
}

std::vector<Index3> TsdfGrid::away_in(const IndexBox& box) const {
  std::vector<Index3> keys;
  for (const auto& entry : away_) {
    if (box.contains(entry.first)) keys.push_back(entry.first);
  }
  std::sort(keys.begin(), keys.end(), zyx_less);
  return keys;
}

SectorRef TsdfGrid::in_memory(const Index3& sector) const {
  const auto it = sectors_.find(sector);
  return it == sectors_.end() ? SectorRef{} : it->second;
}

Result<SectorRef> TsdfGrid::read(const Index3& sector) const {
  const auto it = away_.find(sector);
  return it == away_.end() ? Result<SectorRef>{in_memory(sector)} : it->second->read();
}

void TsdfGrid::page_out(const Index3& sector, std::shared_ptr<const StoredSector> stored) {
  SACCADE_EXPECTS(stored != nullptr);
  const std::size_t taken = sectors_.erase(sector);
  SACCADE_EXPECTS(taken == 1);
  away_.insert_or_assign(sector, std::move(stored));
}

void TsdfGrid::page_in(const Index3& sector, SectorRef loaded) {
  SACCADE_EXPECTS(loaded);
  const std::size_t taken = away_.erase(sector);
  SACCADE_EXPECTS(taken == 1);
  sectors_.insert_or_assign(sector, std::move(loaded));
}

void TsdfGrid::set_stored(const Index3& sector, std::shared_ptr<const StoredSector> stored) {
  const auto it = sectors_.find(sector);
  SACCADE_EXPECTS(it != sectors_.end());
  it->second.set_stored(std::move(stored));
}

Mask512 TsdfGrid::unknown_in(const Index3& brick) const {
  const Sector* found = find(parent(brick));
  if (found == nullptr) return Mask512::all_set();
  return found->bricks[static_cast<std::size_t>(child_index(brick))].unknown_mask();
}

Voxel TsdfGrid::voxel(const Index3& voxel) const {
  const Index3 brick = parent(voxel);
  const Sector* sector = find(parent(brick));
  if (sector == nullptr) return {};
  return sector->bricks[static_cast<std::size_t>(child_index(brick))].voxel(child_index(voxel));
}

std::optional<Rgb8> TsdfGrid::color(const Index3& voxel) const {
  const Index3 brick = parent(voxel);
  const Sector* sector = find(parent(brick));
  if (sector == nullptr) return std::nullopt;
  const DenseBrick* dense = sector->bricks[static_cast<std::size_t>(child_index(brick))].dense();
  if (dense == nullptr || dense->colors == nullptr) return std::nullopt;
  const Rgb8 color = (*dense->colors)[static_cast<std::size_t>(child_index(voxel))];
  return color == Rgb8{} ? std::nullopt : std::optional{color};
}

std::vector<Index3> TsdfGrid::sorted_sectors() const {
  std::vector<Index3> keys;
  keys.reserve(sector_count());
  for (const auto& entry : sectors_) keys.push_back(entry.first);
  for (const auto& entry : away_) keys.push_back(entry.first);
  std::sort(keys.begin(), keys.end(), zyx_less);
  return keys;
}

IndexBox TsdfGrid::sector_bounds() const {
  IndexBox box;
  for (const auto& entry : sectors_) box = box.hull(IndexBox::cube(entry.first, 1));
  for (const auto& entry : away_) box = box.hull(IndexBox::cube(entry.first, 1));
  return box;
}

IndexBox TsdfGrid::known_bounds() const {
  IndexBox box;
  for (const auto& [key, sector] : sectors_) {
    for (int child = 0; child < kSectorBricks; ++child) {
      if ((*sector).bricks[static_cast<std::size_t>(child)].is_unknown()) continue;
      box = box.hull(IndexBox::cube((key * kSectorEdge + child_offset(child)) * kBrickEdge, kBrickEdge));
    }
  }
  for (const auto& [key, stored] : away_) {
    stored->summary().known.for_each([&, at = key](std::size_t child) {
      box =
          box.hull(IndexBox::cube((at * kSectorEdge + child_offset(static_cast<int>(child))) * kBrickEdge, kBrickEdge));
    });
  }
  return box;
}

TsdfGrid::Usage TsdfGrid::usage() const {
  Usage usage;
  usage.sectors = sector_count();
  usage.away_sectors = away_.size();
  for (const auto& entry : away_) {
    const StoredSector::Summary& stored = entry.second->summary();
    usage.constant_free_bricks += stored.constant_free_bricks;
    usage.free_bricks += stored.free_bricks;
    usage.dense_bricks += stored.dense_bricks;
    usage.away_bytes += stored.memory_bytes;
  }
  for (const auto& entry : sectors_) {
    usage.bytes += sizeof(Sector) + sizeof(entry) + 2 * sizeof(void*);
    for (const BrickRef& brick : (*entry.second).bricks) {
      switch (brick.kind()) {
        case BrickKind::unknown: break;
        case BrickKind::constant_free: ++usage.constant_free_bricks; break;
        case BrickKind::free: ++usage.free_bricks; break;
        case BrickKind::dense: ++usage.dense_bricks; break;
      }
      usage.bytes += brick.heap_bytes();
    }
  }
  return usage;
}

bool TsdfGrid::operator==(const TsdfGrid& other) const {
  if (sector_count() != other.sector_count()) return false;
  const auto equal = [](const SectorRef& ours, const SectorRef& theirs) {
    return theirs && (ours.get() == theirs.get() || (*ours).bricks == (*theirs).bricks);
  };
  for (const auto& [key, ours] : sectors_) {
    if (!equal(ours, other.read(key).value())) return false;
  }
  for (const auto& [key, stored] : away_) {
    if (stored != other.away(key) && !equal(stored->read().value(), other.read(key).value())) return false;
  }
  return true;
}

const Sector SectorTable::kAway;

void SectorTable::refuse_away(const Index3& sector) { refuse(sector); }

SectorTable::SectorTable(const TsdfGrid& grid, const IndexBox& box) {
  box_ = box.intersection(grid.sector_bounds());
  if (box_.empty()) {
    box_ = {};
    return;
  }
  constexpr double kLargestTable{1 << 22};
  if (box_.count() > kLargestTable) {
    sparse_grid_ = &grid;
    return;
  }
  size_x_ = static_cast<std::size_t>(box_.size().x);
  size_y_ = static_cast<std::size_t>(box_.size().y);
  sectors_.reserve(static_cast<std::size_t>(box_.count()));
  box_.for_each([&](const Index3& sector) { sectors_.push_back(grid.is_away(sector) ? &kAway : grid.find(sector)); });
}

}  // namespace saccade
