// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_map.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/map/internal/frame_check.hpp"
#include "saccade/map/internal/frame_fuser.hpp"
#include "saccade/map/internal/map_pager.hpp"
#include "saccade/map/internal/surface_tiles.hpp"
#include "saccade/map/voxels_inside.hpp"

namespace saccade {
namespace {

enum class Kept { known, or_not };

/// Returns the sectors of a box in z-y-x order: all, or only those that hold anything known.
std::vector<Index3> sectors_in(const IndexBox& box, const TsdfGrid& grid, Kept kept) {
  const bool only_known = kept == Kept::known;
  std::vector<Index3> keys;
  if (only_known && box.count() > static_cast<double>(grid.sector_count())) {
    keys = grid.sorted_sectors();
    std::erase_if(keys, [&](const Index3& key) { return !box.contains(key); });
    return keys;
  }
  box.for_each([&](const Index3& key) {
    if (!only_known || grid.holds(key)) keys.push_back(key);
  });
  return keys;
}

/// Bricks of a region that an edit applies to.
enum class Bricks {
  known,  ///< only those with a known voxel inside; nothing is created
  all,    ///< created where they are absent
};

/// Applies `edit` to the bricks of the region, with a mask of the voxels whose centre it contains.
template <class Edit>
void edit_region(TsdfGrid& grid, const TsdfConfig& config, const Region& region, Bricks which, const Edit& edit) {
  const IndexBox voxels = voxels_with_center_in(bounds(region), config.voxel_size_m);
  if (voxels.empty()) return;
  const IndexBox bricks = parents(voxels);
  const bool only_known = which == Bricks::known;
  for (const Index3& key : sectors_in(parents(bricks), grid, only_known ? Kept::known : Kept::or_not)) {
    const Sector* shared = grid.find(key);
    Sector* sector{nullptr};  // unshared only when a brick of it is written
    for (int i = 0; i < kSectorBricks; ++i) {
      const Index3 index = key * kSectorEdge + child_offset(i);
      if (!bricks.contains(index)) continue;
      if (only_known && shared->bricks[static_cast<std::size_t>(i)].is_unknown()) continue;
      const Mask512 inside = voxels_inside(region, index * kBrickEdge, config.voxel_size_m);
      if (inside.none()) continue;
      if (only_known && (inside & ~shared->bricks[static_cast<std::size_t>(i)].unknown_mask()).none()) continue;
      if (sector == nullptr) shared = sector = &grid.writable(key);
      BrickRef& brick = sector->bricks[static_cast<std::size_t>(i)];
      edit(brick, inside);
      brick.canonicalize(config.free_weight);
      sector->update_summary(i, config.free_weight);
    }
    if (sector != nullptr && sector->all_unknown()) grid.erase(key);
  }
}

/// Writes one voxel over all of a mask, without colour.
void overwrite(DenseBrick& dense, const Mask512& mask, const Voxel& voxel) {
  mask.for_each_run([&](std::size_t first, std::size_t count) {
    std::fill_n(dense.v.begin() + static_cast<std::ptrdiff_t>(first), count, voxel.v);
    std::fill_n(dense.w.begin() + static_cast<std::ptrdiff_t>(first), count, voxel.w);
    if (dense.colors) std::fill_n(dense.colors->begin() + static_cast<std::ptrdiff_t>(first), count, Rgb8{});
  });
  const bool known = voxel.w != 0;
  dense.unknown = known ? dense.unknown & ~mask : dense.unknown | mask;
  dense.occupied = dense.occupied & ~mask;
}

/// Fuses a frame into a sector in memory. One that it leaves as it was keeps its copy in the store.
FrameFuser::Counts fuse_paged(const FrameFuser& fuser, const Index3& key, TsdfGrid& grid) {
  const std::shared_ptr<const StoredSector> stored = grid.in_memory(key).stored();
  const FrameFuser::Counts counts = fuser.fuse(key, grid.writable_existing(key));
  const bool unchanged = counts.bricks_updated == 0 && counts.bricks_free == counts.bricks_saturated;
  if (stored != nullptr && unchanged) grid.set_stored(key, stored);
  return counts;
}

void forget_voxels(BrickRef& brick, const Mask512& inside) {
  if ((brick.unknown_mask() | inside).all()) {
    brick = {};
  } else if (brick.kind() == BrickKind::dense) {
    overwrite(brick.writable_dense(), inside, {});
  } else {
    FreeBrick& weights = brick.expand_to_free();
    for (Mask512& bits : weights.weight_bits) bits = bits & ~inside;
  }
}

void free_voxels(BrickRef& brick, const Mask512& inside, std::uint16_t free_weight) {
  if (inside.all()) {
    brick = BrickRef::constant_free(free_weight);
  } else if (brick.kind() == BrickKind::dense) {
    overwrite(brick.writable_dense(), inside, {kTsdfOne, free_weight});
  } else {
    FreeBrick& weights = brick.expand_to_free();
    const FreeBrick full = FreeBrick::constant(free_weight);
    for (std::size_t bit = 0; bit < 3; ++bit) {
      weights.weight_bits[bit] = (weights.weight_bits[bit] & ~inside) | (full.weight_bits[bit] & inside);
    }
  }
}

}  // namespace

TsdfMap::TsdfMap(const TsdfConfig& config) : content_{config, {}} {}
TsdfMap::TsdfMap(TsdfSnapshot content) : content_{std::move(content)} {}
TsdfMap::TsdfMap(TsdfMap&& other) noexcept : content_{std::move(other.content_)}, pager_{std::move(other.pager_)} {}
TsdfMap::~TsdfMap() = default;
TsdfMap& TsdfMap::operator=(TsdfMap&& other) noexcept {
  const std::scoped_lock lock{mutex_};
  content_ = std::move(other.content_);
  pager_ = std::move(other.pager_);
  return *this;
}

Result<TsdfMap> TsdfMap::create(const TsdfConfig& config) {
  SACCADE_CHECK(config.validate());
  return TsdfMap{config};
}

Result<FusionStats> TsdfMap::integrate(const PinholeCamera& camera, const DepthImage& depth, const Pose& T_world_camera,
                                       const Executor& executor, const ColorImage* color) {
  SACCADE_CHECK(check_frame(camera, depth, T_world_camera, color));
  const Stopwatch stopwatch;
  const RangeImage ranges{camera, depth, config().truncation_m(), executor};
  const FrameFuser fuser{config(), ranges, T_world_camera, color};
  SACCADE_TRY(const std::vector<Index3> keys, fuser.candidate_sectors(executor));

  const std::scoped_lock lock{mutex_};
  TsdfGrid& grid = content_.grid;
  const Eigen::Vector3d camera_world = T_world_camera.translation();
  SACCADE_CHECK(bring_in(keys, &camera_world, executor));
  std::vector<std::uint8_t> unchanged(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Sector* sector = grid.find(keys[i]);
    if (sector == nullptr) {
      static_cast<void>(grid.writable(keys[i]));
    } else {
      unchanged[i] = fuser.leaves_unchanged(keys[i], *sector) ? 1 : 0;
    }
  }
  std::vector<FrameFuser::Counts> counts(keys.size());
  executor.parallel_for(keys.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (unchanged[i] != 0) {
        counts[i] = {0, kSectorBricks, kSectorBricks};
      } else if (pager_ == nullptr) {
        counts[i] = fuser.fuse(keys[i], grid.writable_existing(keys[i]));
      } else {
        counts[i] = fuse_paged(fuser, keys[i], grid);
      }
    }
  });
  FusionStats stats;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    stats.bricks_updated += counts[i].bricks_updated;
    stats.bricks_free += counts[i].bricks_free;
    stats.bricks_saturated += counts[i].bricks_saturated;
    if (counts[i].bricks_updated + counts[i].bricks_free == 0 && grid.find(keys[i])->all_unknown()) grid.erase(keys[i]);
  }
  if (pager_ != nullptr) pager_->settle(grid, keys, executor);
  stats.valid_pixels = ranges.valid_pixels();
  stats.ms = stopwatch.elapsed_ms();
  return stats;
}

Status TsdfMap::forget(const Region& region) {
  return edit_sectors(region, [&] {
    edit_region(content_.grid, config(), region, Bricks::known,
                [](BrickRef& brick, const Mask512& inside) { forget_voxels(brick, inside); });
  });
}

Status TsdfMap::free(const Region& region) {
  return edit_sectors(region, [&] {
    edit_region(content_.grid, config(), region, Bricks::all,
                [&](BrickRef& brick, const Mask512& inside) { free_voxels(brick, inside, config().free_weight); });
  });
}

Status TsdfMap::edit_sectors(const Region& region, const std::function<void()>& edit) {
  SACCADE_CHECK(check_region(region));
  const std::scoped_lock lock{mutex_};
  const bool is_plain = pager_ == nullptr && content_.grid.all_in_memory();
  const IndexBox voxels = voxels_with_center_in(bounds(region), config().voxel_size_m);
  if (is_plain || voxels.empty()) {
    edit();
    return {};
  }
  const IndexBox sectors = parents(parents(voxels));
  const std::vector<Index3> stored = sectors_in(sectors, content_.grid, Kept::known);
  SACCADE_CHECK(bring_in(stored, nullptr, {}));
  edit();
  if (pager_ != nullptr) pager_->settle(content_.grid, sectors_in(sectors, content_.grid, Kept::or_not), {});
  return {};
}

Status TsdfMap::keep_within(const PagingConfig& config) {
  SACCADE_CHECK(config.validate());
  const std::scoped_lock lock{mutex_};
  if (pager_ != nullptr) return Error{Errc::invalid_argument, "the map is paged already", "paging of the map"};
  pager_ = std::make_unique<MapPager>(config, this->config().voxel_size_m, content_.grid);
  return {};
}

Status TsdfMap::look_from(const PinholeCamera& camera, const Pose& T_world_camera, const Executor& executor) {
  if (pager_ == nullptr) return {};
  SACCADE_CHECK(camera.validate());
  if (const auto checked = pose_from_matrix(T_world_camera.matrix()); !checked) return checked.error();
  const std::scoped_lock lock{mutex_};
  const Eigen::Vector3d camera_world = T_world_camera.translation();
  return bring_in(sectors_cast_through(content_.grid, camera, T_world_camera, config().voxel_size_m), &camera_world,
                  executor);
}

Status TsdfMap::page_out_all(const Executor& executor) {
  if (pager_ == nullptr) return {};
  const std::scoped_lock lock{mutex_};
  return pager_->page_out_all(content_.grid, executor);
}

std::optional<PagingStats> TsdfMap::paging() const {
  const std::scoped_lock lock{mutex_};
  return pager_ == nullptr ? std::nullopt : std::optional{pager_->stats()};
}

Status TsdfMap::bring_in(std::span<const Index3> keys, const Eigen::Vector3d* camera_world, const Executor& executor) {
  if (pager_ != nullptr) return pager_->bring_in(content_.grid, keys, camera_world, executor);
  if (content_.grid.all_in_memory()) return {};
  SACCADE_TRY(content_.grid, with_in_memory(content_.grid, keys, executor));  // a snapshot of a paged map goes on
  return {};
}

Status TsdfMap::check_region(const Region& region) const {
  SACCADE_CHECK(validate(region));
  const Box box = bounds(region);
  if (box.min.cwiseAbs().maxCoeff() > 1000.0 || box.max.cwiseAbs().maxCoeff() > 1000.0) {
    return Error{Errc::invalid_argument, "the region must lie within 1000 m of the origin", {}};
  }
  const IndexBox sectors = parents(parents(voxels_with_center_in(box, config().voxel_size_m)));
  constexpr double kMaxSectors{1e6};
  const Index3 size = sectors.size();
  if (!sectors.empty() && static_cast<double>(size.x) * size.y * size.z > kMaxSectors) {
    return Error{Errc::invalid_argument, "the region is too large for this voxel size", {}};
  }
  return {};
}

TsdfSnapshot TsdfMap::snapshot() const {
  const std::scoped_lock lock{mutex_};
  return content_;
}

}  // namespace saccade
