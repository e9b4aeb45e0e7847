// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_map.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/map/frame_fuser.hpp"

namespace saccade {
namespace {

Status check_frame(const PinholeCamera& camera, const DepthImage& depth, const Pose& T_world_camera,
                   const ColorImage* color) {
  SACCADE_CHECK(camera.validate());
  const auto size = [](int width, int height) { return std::to_string(width) + "x" + std::to_string(height); };
  if (depth.width() != camera.width || depth.height() != camera.height) {
    return Error{Errc::size_mismatch,
                 "the depth image is " + size(depth.width(), depth.height()) + ", the camera " +
                     size(camera.width, camera.height),
                 {}};
  }
  if (color != nullptr && (color->width() != camera.width || color->height() != camera.height)) {
    return Error{Errc::size_mismatch,
                 "the colour image is " + size(color->width(), color->height()) + ", the camera " +
                     size(camera.width, camera.height),
                 {}};
  }
  if (const auto checked = pose_from_matrix(T_world_camera.matrix()); !checked) return checked.error();
  if (T_world_camera.translation().cwiseAbs().maxCoeff() > 1000.0) {
    return Error{Errc::invalid_argument, "the camera lies farther than 1000 m from the origin", {}};
  }
  return {};
}

/// Marks the voxels of a cube in a brick whose centre the shape contains: all or none at once, or by its octants.
template <class Shape>
void mark_inside(const Shape& shape, const Index3& brick_lo, const Index3& cube, int edge, double voxel_size_m,
                 Mask512& inside) {
  constexpr int kSmallestCube{2};
  const Index3 first = brick_lo + cube;
  const Index3 last = first + Index3{edge - 1, edge - 1, edge - 1};
  const Overlap known = overlap(shape, {voxel_center(first, voxel_size_m), voxel_center(last, voxel_size_m)});
  if (known == Overlap::none) return;
  if (known == Overlap::whole && edge == kBrickEdge) {
    inside = Mask512::all_set();
    return;
  }
  if (known == Overlap::partial && edge > kSmallestCube) {
    const int half = edge / 2;
    for (int i = 0; i < 8; ++i) {
      const Index3 octant = cube + Index3{i & 1, (i >> 1) & 1, (i >> 2) & 1} * half;
      mark_inside(shape, brick_lo, octant, half, voxel_size_m, inside);
    }
    return;
  }
  for (int z = 0; z < edge; ++z) {
    for (int y = 0; y < edge; ++y) {
      for (int x = 0; x < edge; ++x) {
        const Index3 voxel = cube + Index3{x, y, z};
        if (known == Overlap::whole || contains(shape, voxel_center(brick_lo + voxel, voxel_size_m))) {
          inside.set(child_index(voxel));
        }
      }
    }
  }
}

/// Applies `edit` to every stored or storable brick of the region: wholly inside, or voxel by voxel through a mask of
/// the voxels whose centre it contains.
template <class Edit>
void edit_region(TsdfGrid& grid, const TsdfConfig& config, const Region& region, bool create, const Edit& edit) {
  const IndexBox voxels = voxels_with_center_in(bounds(region), config.voxel_size_m);
  if (voxels.empty()) return;
  const Index3 first = parent(parent(voxels.lo));
  const Index3 last = parent(parent(voxels.hi - Index3{1, 1, 1}));
  std::vector<Index3> keys;
  if (create) {
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) keys.push_back({x, y, z});
      }
    }
  } else {
    const IndexBox sectors{first, last + Index3{1, 1, 1}};
    keys = grid.sorted_sectors();
    std::erase_if(keys, [&](const Index3& key) { return !sectors.contains(key); });
  }
  for (const Index3& key : keys) {
    Sector* sector{nullptr};  // unshared only when a brick of it is written
    for (int i = 0; i < kSectorBricks; ++i) {
      const Index3 lo = (key * kSectorEdge + child_offset(i)) * kBrickEdge;
      const Index3 hi = lo + Index3{kBrickEdge, kBrickEdge, kBrickEdge};
      if (lo.x >= voxels.hi.x || lo.y >= voxels.hi.y || lo.z >= voxels.hi.z || hi.x <= voxels.lo.x ||
          hi.y <= voxels.lo.y || hi.z <= voxels.lo.z) {
        continue;
      }
      const Mask512 inside = voxels_inside(region, lo, config.voxel_size_m);
      if (inside.none()) continue;
      if (sector == nullptr) sector = &grid.writable(key);
      BrickRef& brick = sector->bricks[static_cast<std::size_t>(i)];
      edit(brick, inside);
      brick.canonicalize(config.free_weight);
      sector->update_summary(i, config.free_weight);
    }
    if (sector != nullptr && sector->all_unknown()) grid.erase(key);
  }
}

void forget_voxels(BrickRef& brick, const Mask512& inside) {
  if (brick.is_unknown()) return;
  if (inside.all()) {
    brick = {};
  } else if (brick.kind() == BrickKind::dense) {
    DenseBrick& dense = brick.writable_dense();
    for (int i = 0; i < kBrickVoxels; ++i) {
      if (!inside.test(i)) continue;
      dense.v[static_cast<std::size_t>(i)] = 0;
      dense.w[static_cast<std::size_t>(i)] = 0;
      if (dense.colors) (*dense.colors)[static_cast<std::size_t>(i)] = {};
    }
    dense.update_masks();
  } else {
    FreeBrick& weights = brick.expand_to_free();
    for (Mask512& bits : weights.weight_bits) bits = bits & ~inside;
  }
}

void free_voxels(BrickRef& brick, const Mask512& inside, std::uint16_t free_weight) {
  if (inside.all()) {
    brick = BrickRef::constant_free(free_weight);
  } else if (brick.kind() == BrickKind::dense) {
    DenseBrick& dense = brick.writable_dense();
    for (int i = 0; i < kBrickVoxels; ++i) {
      if (!inside.test(i)) continue;
      dense.v[static_cast<std::size_t>(i)] = kTsdfOne;
      dense.w[static_cast<std::size_t>(i)] = free_weight;
      if (dense.colors) (*dense.colors)[static_cast<std::size_t>(i)] = {};
    }
    dense.update_masks();
  } else {
    FreeBrick& weights = brick.expand_to_free();
    const FreeBrick full = FreeBrick::constant(free_weight);
    for (std::size_t bit = 0; bit < 3; ++bit) {
      weights.weight_bits[bit] = (weights.weight_bits[bit] & ~inside) | (full.weight_bits[bit] & inside);
    }
  }
}

}  // namespace

Mask512 voxels_inside(const Region& region, const Index3& lo, double voxel_size_m) {
  Mask512 inside;
  std::visit([&](const auto& shape) { mark_inside(shape, lo, {0, 0, 0}, kBrickEdge, voxel_size_m, inside); }, region);
  return inside;
}

TsdfMap::TsdfMap(const TsdfConfig& config) : content_{config, {}} {}
TsdfMap::TsdfMap(TsdfSnapshot content) : content_{std::move(content)} {}
TsdfMap::TsdfMap(TsdfMap&& other) noexcept : content_{std::move(other.content_)} {}
TsdfMap& TsdfMap::operator=(TsdfMap&& other) noexcept {
  const std::scoped_lock lock{mutex_};
  content_ = std::move(other.content_);
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
  std::vector<Index3> keys = fuser.candidate_sectors(executor);

  const std::scoped_lock lock{mutex_};
  TsdfGrid& grid = content_.grid;
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
      } else {
        counts[i] = fuser.fuse(keys[i], grid.writable_existing(keys[i]));
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
  stats.valid_pixels = ranges.valid_pixels();
  stats.ms = stopwatch.elapsed_ms();
  return stats;
}

Status TsdfMap::forget(const Region& region) {
  SACCADE_CHECK(check_region(region));
  const std::scoped_lock lock{mutex_};
  edit_region(content_.grid, config(), region, false,
              [](BrickRef& brick, const Mask512& inside) { forget_voxels(brick, inside); });
  return {};
}

Status TsdfMap::free(const Region& region) {
  SACCADE_CHECK(check_region(region));
  const std::scoped_lock lock{mutex_};
  edit_region(content_.grid, config(), region, true,
              [&](BrickRef& brick, const Mask512& inside) { free_voxels(brick, inside, config().free_weight); });
  return {};
}

Status TsdfMap::check_region(const Region& region) const {
  SACCADE_CHECK(validate(region));
  const Box box = bounds(region);
  if (box.min.cwiseAbs().maxCoeff() > 1000.0 || box.max.cwiseAbs().maxCoeff() > 1000.0) {
    return Error{Errc::invalid_argument, "the region must lie within 1000 m of the origin", {}};
  }
  const Eigen::Vector3d sectors = (box.max - box.min) / (kSectorVoxelEdge * config().voxel_size_m);
  constexpr double kMaxSectors{1e6};
  if (sectors.prod() > kMaxSectors) {
    return Error{Errc::invalid_argument, "the region is too large for this voxel size", {}};
  }
  return {};
}

TsdfSnapshot TsdfMap::snapshot() const {
  const std::scoped_lock lock{mutex_};
  return content_;
}

}  // namespace saccade
