// SPDX-License-Identifier: Apache-2.0
#include "saccade/view/gain_caster.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/map/ray_walk.hpp"

namespace saccade {
namespace {

constexpr int kRootTile{32};  // pixels
constexpr int kLeafTile{4};

std::int32_t at(const Index3& i, int axis) { return axis == 0 ? i.x : axis == 1 ? i.y : i.z; }
Index3 from_axes(const std::int32_t (&i)[3]) { return {i[0], i[1], i[2]}; }

std::int32_t floor_to_int(float x) {
  const auto truncated = static_cast<std::int32_t>(x);
  return static_cast<float>(truncated) > x ? truncated - 1 : truncated;
}

struct Interval {
  float lo;
  float hi;
};

}  // namespace

VoxelSet::VoxelSet(const IndexBox& voxels)
    : bricks_{parent(voxels.lo), parent(voxels.hi - Index3{1, 1, 1}) + Index3{1, 1, 1}} {
  const Index3 size = bricks_.hi - bricks_.lo;
  masks_.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z));
}

void VoxelSet::insert(const Index3& voxel) {
  const Index3 i = parent(voxel) - bricks_.lo;
  const Index3 size = bricks_.hi - bricks_.lo;
  const std::size_t slice =
      static_cast<std::size_t>(i.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(i.y);
  masks_[slice * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(i.x)].set(child_index(voxel));
}

std::uint64_t VoxelSet::count() const {
  std::uint64_t n{0};
  for (const Mask512& mask : masks_) n += static_cast<std::uint64_t>(mask.count());
  return n;
}

/// Where the rays of a tile run: slabs of bricks along the major axis, and the range of slopes along the other two.
/// Every ray of the tile lies within these bounds, the rounding of the exact walk included.
struct GainCaster::Beam {
  int major;
  bool positive;
  Interval speed;  // |d| along the major axis
  int minor[2];
  Interval slope[2];      // of the minor axes, per unit of distance along the major one
  float start[3];         // position of the camera in its brick
  std::int32_t brick[3];  // the camera's brick

  /// Distance along the major axis at which slab n begins; slab 0 holds the camera.
  [[nodiscard]] float near(int n) const { return n == 0 ? 0.0F : far(n - 1); }
  [[nodiscard]] float far(int n) const {
    const float in_first = positive ? static_cast<float>(kBrickEdge) - start[major] : start[major];
    return in_first + static_cast<float>(kBrickEdge * n);
  }
  /// Last slab that holds bricks of the box [lo, hi); negative when they all lie behind.
  [[nodiscard]] int last_slab(const Index3& lo, const Index3& hi) const {
    return positive ? at(hi, major) - 1 - brick[major] : brick[major] - at(lo, major);
  }
  /// Flags of all bricks that rays of the beam may touch within slab n: their union and their intersection.
  struct Flags {
    unsigned any{0};
    unsigned all{stop_flags::kMask};
  };
  [[nodiscard]] Flags flags(const StopGrid& grid, int n) const {
    std::int32_t lo[3];
    std::int32_t hi[3];
    lo[major] = hi[major] = brick[major] + (positive ? n : -n);
    for (int k = 0; k < 2; ++k) {
      const float from = near(n);
      const float to = far(n);
      const float slack = 0.02F + 4e-6F * to * (1.0F + std::max(std::abs(slope[k].lo), std::abs(slope[k].hi)));
      const float least = std::min(from * slope[k].lo, to * slope[k].lo) - slack;
      const float most = std::max(from * slope[k].hi, to * slope[k].hi) + slack;
      const int axis = minor[k];
      lo[axis] = brick[axis] + floor_to_int((start[axis] + least) * (1.0F / kBrickEdge));
      hi[axis] = brick[axis] + floor_to_int((start[axis] + most) * (1.0F / kBrickEdge));
    }
    Flags result;
    std::int32_t i[3];
    i[major] = lo[major];
    for (i[minor[1]] = lo[minor[1]]; i[minor[1]] <= hi[minor[1]]; ++i[minor[1]]) {
      for (i[minor[0]] = lo[minor[0]]; i[minor[0]] <= hi[minor[0]]; ++i[minor[0]]) {
        const unsigned flags_i = grid.flags(from_axes(i));
        result.any |= flags_i;
        result.all &= flags_i;
      }
    }
    return result;
  }
};

GainCaster::GainCaster(const StopGrid& grid, const CastWindow& window, const CastLimits& limits, VoxelSet* seen)
    : grid_{grid}, window_{window}, limits_{limits}, seen_{seen} {}

void GainCaster::cast_rows(int begin, int end) {
  const auto width = static_cast<int>(window_.a.size());
  if (!limits_.savings.tiles || !limits_.savings.empty_bricks) {
    cast_rays({0, width, begin, end, 0, 0});
    return;
  }
  for (int j = begin; j < end; j += kRootTile) {
    for (int i = 0; i < width; i += kRootTile) {
      Tile tile{i, std::min(i + kRootTile, width), j, std::min(j + kRootTile, end), 0, 0};
      const float a = window_.a[static_cast<std::size_t>((tile.column_begin + tile.column_end) / 2)];
      const float b = window_.b[static_cast<std::size_t>((tile.row_begin + tile.row_end) / 2)];
      const LatticeRay middle = window_.rays.ray(a, b);
      for (int axis = 1; axis < 3; ++axis) {
        if (std::abs(middle.d[axis]) > std::abs(middle.d[tile.major])) tile.major = axis;
      }
      cast_tile(tile);
    }
  }
}

bool GainCaster::to_be_cast(const Tile& tile) const {
  for (int j = tile.row_begin; j < tile.row_end; ++j) {
    const ColumnRange& range = window_.columns[static_cast<std::size_t>(j)];
    if (range.begin < tile.column_end && range.end > tile.column_begin) return true;
  }
  return false;
}

GainCaster::Beam GainCaster::beam(const Tile& tile) const {
  Beam beam{};
  beam.major = tile.major;
  beam.minor[0] = tile.major == 0 ? 1 : 0;
  beam.minor[1] = tile.major == 2 ? 1 : 2;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t origin = at(window_.rays.origin.voxel, axis);
    beam.brick[axis] = origin >> 3;
    beam.start[axis] = static_cast<float>(origin & 7) + window_.rays.origin.fraction[axis];
  }
  // Directions are affine in (a, b), so their ratios have their extremes at the corners of the tile.
  bool first{true};
  for (const int i : {tile.column_begin, tile.column_end - 1}) {
    for (const int j : {tile.row_begin, tile.row_end - 1}) {
      const LatticeRay ray =
          window_.rays.ray(window_.a[static_cast<std::size_t>(i)], window_.b[static_cast<std::size_t>(j)]);
      const float speed = std::abs(ray.d[beam.major]);
      const float inv = 1.0F / speed;
      if (first) beam.positive = ray.positive(beam.major);
      if (first || speed < beam.speed.lo) beam.speed.lo = speed;
      if (first || speed > beam.speed.hi) beam.speed.hi = speed;
      for (int k = 0; k < 2; ++k) {
        const float slope = ray.d[beam.minor[k]] * inv;
        if (first || slope < beam.slope[k].lo) beam.slope[k].lo = slope;
        if (first || slope > beam.slope[k].hi) beam.slope[k].hi = slope;
      }
      first = false;
    }
  }
  return beam;
}

void GainCaster::cast_tile(const Tile& tile) {
  if (!to_be_cast(tile)) return;
  constexpr float kSlack{1e-4F};
  const Beam rays = beam(tile);
  int last = static_cast<int>(limits_.max_t * rays.speed.hi / kBrickEdge) + 2;
  if (limits_.savings.region_exit) {
    const IndexBox& scoring = grid_.scoring_voxels();
    last = std::min(last, rays.last_slab(parent(scoring.lo), parent(scoring.hi - Index3{1, 1, 1}) + Index3{1, 1, 1}));
  }
  Tile rest{tile};
  while (rest.slab <= last) {
    const Beam::Flags met = rays.flags(grid_, rest.slab);
    if (met.any == stop_flags::kClear) {
      ++rest.slab;
      continue;
    }
    if (met.all == stop_flags::kBlocked) return;
    if (seen_ != nullptr) break;
    // Up to a slab that scores everywhere, rays may only meet what scores, at depths within the limits.
    if (rest.slab == 0 || rays.near(rest.slab) < limits_.min_t * rays.speed.hi * (1.0F + kSlack)) break;
    Beam::Flags ahead = met;
    int slab = rest.slab;
    while ((ahead.any & stop_flags::kBlocks) == 0 && ahead.all != stop_flags::kScores && slab < last) {
      ahead = rays.flags(grid_, ++slab);
    }
    if (ahead.all != stop_flags::kScores || (ahead.any & stop_flags::kBlocks) != 0) break;
    if (rays.far(slab) * (1.0F + kSlack) > limits_.max_t * rays.speed.lo) break;
    scored_ += static_cast<std::uint64_t>(tile.column_end - tile.column_begin) *
               static_cast<std::uint64_t>(tile.row_end - tile.row_begin);
    return;
  }
  if (rest.slab > last) return;
  if (tile.column_end - tile.column_begin <= kLeafTile && tile.row_end - tile.row_begin <= kLeafTile) {
    cast_rays(rest);
  } else {
    split(rest);
  }
}

void GainCaster::split(const Tile& tile) {
  const int column = (tile.column_begin + tile.column_end + 1) / 2;
  const int row = (tile.row_begin + tile.row_end + 1) / 2;
  for (const auto& [row_begin, row_end] : {std::pair{tile.row_begin, row}, std::pair{row, tile.row_end}}) {
    for (const auto& [begin, end] : {std::pair{tile.column_begin, column}, std::pair{column, tile.column_end}}) {
      if (begin < end && row_begin < row_end) cast_tile({begin, end, row_begin, row_end, tile.major, tile.slab});
    }
  }
}

void GainCaster::cast_rays(const Tile& tile) {
  for (int j = tile.row_begin; j < tile.row_end; ++j) {
    const ColumnRange& range = window_.columns[static_cast<std::size_t>(j)];
    const float b = window_.b[static_cast<std::size_t>(j)];
    const int end = std::min(range.end, tile.column_end);
    for (int i = std::max(range.begin, tile.column_begin); i < end; ++i) {
      cast_ray(window_.a[static_cast<std::size_t>(i)], b, tile.major, tile.slab);
    }
  }
}

RayEvent GainCaster::slab_entry(const LatticeRay& ray, int major, int slab) const {
  if (slab == 0) return kRayStart;
  const std::int32_t origin = at(ray.origin, major);
  const std::int32_t brick = (origin >> 3) + (ray.positive(major) ? slab : 1 - slab);
  return {ray.crossing(major, brick * kBrickEdge - origin), major};
}

void GainCaster::end_of_ray(const Index3& voxel, const RayEvent& entered) {
  if (entered.axis < 0 || entered.t < limits_.min_t) return;  // the camera's own voxel, or nearer than it can measure
  ++scored_;
  if (seen_ != nullptr) seen_->insert(voxel);
}

void GainCaster::cast_ray(float a, float b, int major, int slab) {
  const LatticeRay ray = window_.rays.ray(a, b);
  RaySpan span{slab_entry(ray, major, slab), after_depth(limits_.max_t)};
  if (limits_.savings.region_rays || limits_.savings.region_exit) {
    const RaySpan region = clip(ray, grid_.scoring_voxels());
    if (limits_.savings.region_rays && region.empty()) return;
    if (limits_.savings.region_exit) span = span.until(region.exit);
  }
  ++rays_cast_;
  const auto visit_voxel = [&](const StopGrid::Brick& brick, const Index3& voxel, const RayEvent& entered) {
    const int i = child_index(voxel);
    if (!brick.masks->stop.test(i)) return false;
    if (brick.masks->score.test(i)) end_of_ray(voxel, entered);
    return true;
  };
  if (limits_.savings.empty_bricks) {
    walk_cells<kBrickLevel>(ray, span, [&](const Index3& index, const RaySpan& in_brick) {
      const StopGrid::Brick brick = grid_.brick(index);
      if (brick.flags == stop_flags::kClear) return false;
      if (brick.flags == stop_flags::kBlocked) return true;
      if (brick.flags == stop_flags::kScores) {
        end_of_ray(seen_ == nullptr ? Index3{} : voxel_at_event(ray, in_brick.enter), in_brick.enter);
        return true;
      }
      return walk_cells<kVoxelLevel>(ray, in_brick, [&](const Index3& voxel, const RaySpan& in_voxel) {
        return visit_voxel(brick, voxel, in_voxel.enter);
      });
    });
  } else {
    walk_cells<kVoxelLevel>(ray, span, [&](const Index3& voxel, const RaySpan& in_voxel) {
      const StopGrid::Brick brick = grid_.brick(parent(voxel));
      if (brick.flags == stop_flags::kClear) return false;
      if (brick.flags == stop_flags::kScores) end_of_ray(voxel, in_voxel.enter);
      return (brick.flags & stop_flags::kSolid) != 0 || visit_voxel(brick, voxel, in_voxel.enter);
    });
  }
}

}  // namespace saccade
