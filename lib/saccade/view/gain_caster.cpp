// SPDX-License-Identifier: Apache-2.0
#include "saccade/view/gain_caster.hpp"

#include <algorithm>
#include <utility>

#include "saccade/map/ray_walk.hpp"

namespace saccade {
namespace {

constexpr int kRootTile{32};  // pixels; tiles start at this size,
constexpr int kFineTile{8};   // from this size on they go by voxels,
constexpr int kRayTile{2};    // and at this size the rays go by themselves

/// The event by which a ray enters slab n of voxels along an axis.
RayEvent slab_entry(const LatticeRay& ray, int major, int n) {
  if (n == 0) return kRayStart;
  return {ray.crossing(major, ray.positive(major) ? n : 1 - n), major};
}

}  // namespace

VoxelSet::VoxelSet(const IndexBox& voxels)
    : bricks_{parent(voxels.lo), parent(voxels.hi - Index3{1, 1, 1}) + Index3{1, 1, 1}} {
  const Index3 size = bricks_.hi - bricks_.lo;
  masks_.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z));
}

void VoxelSet::insert(const Index3& voxel) {
  const Index3 i = parent(voxel) - bricks_.lo;
  const auto size_x = static_cast<std::size_t>(bricks_.hi.x - bricks_.lo.x);
  const auto size_y = static_cast<std::size_t>(bricks_.hi.y - bricks_.lo.y);
  const std::size_t slice = static_cast<std::size_t>(i.z) * size_y + static_cast<std::size_t>(i.y);
  masks_[slice * size_x + static_cast<std::size_t>(i.x)].set(child_index(voxel));
}

std::uint64_t VoxelSet::count() const {
  std::uint64_t n{0};
  for (const Mask512& mask : masks_) n += static_cast<std::uint64_t>(mask.count());
  return n;
}

/// What the rays of a tile have met so far, slab by slab, until it is the same for all of them or differs.
class GainCaster::Sight {
 public:
  enum class Verdict { open, none_scores, all_score, differs };

  /// Rays may be decided together only where their hits' depths certainly lie within the limits.
  Sight(const RayBeam& beam, const CastLimits& limits, bool may_score, int start)
      : nearest_{limits.min_t * beam.fastest() * (1.0F + kSlack)},
        farthest_{limits.max_t * beam.slowest() * (1.0F - kSlack)},
        may_score_{may_score},
        clear_until_{start} {}

  /// The slab of voxels up to which no ray met anything.
  [[nodiscard]] int clear_until() const { return clear_until_; }
  [[nodiscard]] Verdict verdict() const { return verdict_; }

  /// Adds the slabs of voxels [n, end), through which the rays run between two distances. Returns whether to go on.
  bool add(unsigned flags, int n, int end, float near, float far) {
    if (met_ == 0 && flags == stop_flags::kClear) {
      clear_until_ = end;
      return true;
    }
    met_ |= flags & (stop_flags::kScores | stop_flags::kBlocks);
    const bool too_near = (met_ & stop_flags::kScores) != 0 && (n == 0 || near < nearest_ || !may_score_);
    if (met_ == (stop_flags::kScores | stop_flags::kBlocks) || too_near) {
      verdict_ = Verdict::differs;
    } else if ((flags & stop_flags::kSolid) != 0) {
      const bool scores = met_ == stop_flags::kScores;
      verdict_ = !scores ? Verdict::none_scores : far <= farthest_ ? Verdict::all_score : Verdict::differs;
    }
    return verdict_ == Verdict::open;
  }
  /// No slab is left.
  void finish() {
    if (verdict_ != Verdict::open) return;
    verdict_ = (met_ & stop_flags::kScores) != 0 ? Verdict::differs : Verdict::none_scores;
  }

 private:
  static constexpr float kSlack{1e-4F};
  float nearest_;
  float farthest_;
  bool may_score_;
  int clear_until_;
  unsigned met_{0};
  Verdict verdict_{Verdict::open};
};

GainCaster::GainCaster(const StopGrid& grid, const CastWindow& window, const CastLimits& limits, VoxelSet* seen)
    : grid_{grid},
      window_{window},
      limits_{limits},
      seen_{seen},
      use_packets_{limits.savings.packets && limits.savings.region_rays && limits.savings.region_exit &&
                   limits.savings.empty_bricks && limits.savings.tiles && seen == nullptr && !grid.flat().empty()},
      finest_slabs_{use_packets_ ? 2 : 1} {}

void GainCaster::cast_rows(int begin, int end) {
  const auto width = static_cast<int>(window_.a.size());
  if (!limits_.savings.tiles || !limits_.savings.empty_bricks) {
    cast_rays({0, width, begin, end, 0, 0});
    return;
  }
  for (int j = begin; j < end; j += kRootTile) {
    for (int i = 0; i < width; i += kRootTile) {
      Tile tile{i, std::min(i + kRootTile, width), j, std::min(j + kRootTile, end), 0, 0};
      tile.major = major_axis(window_, tile);
      cast_tile(tile);
    }
  }
}

void GainCaster::look_over_rows(int begin, int end, int tile_px) {
  leave_open_px_ = tile_px;
  cast_rows(begin, end);
  leave_open_px_ = 0;
}

std::uint64_t GainCaster::open_rays() const {
  std::uint64_t rays{0};
  for (const Tile& tile : open_tiles_) {
    for (int j = tile.row_begin; j < tile.row_end; ++j) {
      const ColumnRange& range = window_.columns[static_cast<std::size_t>(j)];
      const int columns = std::min(range.end, tile.column_end) - std::max(range.begin, tile.column_begin);
      rays += static_cast<std::uint64_t>(std::max(columns, 0));
    }
  }
  return rays;
}

void GainCaster::cast_open_tiles() {
  for (const Tile& tile : std::exchange(open_tiles_, {})) decide(tile);
}

bool GainCaster::to_be_cast(const Tile& tile) const {
  for (int j = tile.row_begin; j < tile.row_end; ++j) {
    const ColumnRange& range = window_.columns[static_cast<std::size_t>(j)];
    if (range.begin < tile.column_end && range.end > tile.column_begin) return true;
  }
  return false;
}

int GainCaster::last_slab(const RayBeam& beam) const {
  const int in_range = static_cast<int>(limits_.max_t * beam.fastest()) + 2;
  return limits_.savings.region_exit ? std::min(in_range, beam.last_slab(grid_.scoring_voxels())) : in_range;
}

void GainCaster::cast_tile(const Tile& tile) {
  if (!to_be_cast(tile)) return;
  const RayBeam beam{window_, tile};
  Sight sight{beam, limits_, seen_ == nullptr, tile.slab};
  const int size = std::max(tile.columns(), tile.rows());
  if (size > kFineTile) {
    look_by_bricks(beam, last_slab(beam), sight);
  } else {
    look_by_voxels(beam, last_slab(beam), sight);
  }
  if (sight.verdict() == Sight::Verdict::none_scores) return;
  if (sight.verdict() == Sight::Verdict::all_score) {
    scored_ += static_cast<std::uint64_t>(tile.columns()) * static_cast<std::uint64_t>(tile.rows());
    return;
  }
  Tile rest{tile};
  rest.slab = sight.clear_until();
  if (std::max(tile.columns(), tile.rows()) <= leave_open_px_) {
    open_tiles_.push_back(rest);
  } else {
    decide(rest);
  }
}

/// A tile whose rays do not share their fate.
void GainCaster::decide(const Tile& tile) {
  const int size = std::max(tile.columns(), tile.rows());
  if (use_packets_ && size <= kFineTile) {
    cast_packet(tile);
  } else if (size > kRayTile) {
    split(tile);
  } else {
    cast_rays(tile);
  }
}

void GainCaster::look_by_bricks(const RayBeam& beam, int last, Sight& sight) const {
  for (int n = sight.clear_until(); n <= last;) {
    const int end = beam.first_voxel_slab(beam.brick_slab(n) + 1);
    const RayBeam::Voxels voxels = beam.voxels(n, end);
    const unsigned flags = grid_.flags_of_bricks(parent(voxels.lo), parent(voxels.hi));
    if (!sight.add(flags, n, end, beam.near(n), beam.far(end - 1))) return;
    n = end;
  }
  sight.finish();
}

void GainCaster::look_by_voxels(const RayBeam& beam, int last, Sight& sight) const {
  for (int n = sight.clear_until(); n <= last;) {
    const int end = beam.first_voxel_slab(beam.brick_slab(n) + 1);
    const RayBeam::Voxels voxels = beam.voxels(n, end);
    const unsigned flags = grid_.flags_of_bricks(parent(voxels.lo), parent(voxels.hi));
    const bool decided = flags == stop_flags::kClear || flags == stop_flags::kAllBlock;
    if (!(decided ? sight.add(flags, n, end, beam.near(n), beam.far(end - 1)) : look_closer(beam, n, end, sight))) {
      return;
    }
    n = end;
  }
  sight.finish();
}

/// Halves the slabs until they are the same throughout, or so thin that looking costs more than walking rays.
bool GainCaster::look_closer(const RayBeam& beam, int n, int end, Sight& sight) const {
  const RayBeam::Voxels voxels = beam.voxels(n, end);
  const unsigned flags = grid_.flags_of_voxels(voxels.lo, voxels.hi);
  if (end - n <= finest_slabs_ || flags == stop_flags::kClear || (flags & stop_flags::kSolid) != 0) {
    return sight.add(flags, n, end, beam.near(n), beam.far(end - 1));
  }
  const int middle = (n + end) / 2;
  return look_closer(beam, n, middle, sight) && look_closer(beam, middle, end, sight);
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

void GainCaster::cast_packet(const Tile& tile) {
  const SensorRays& rays = window_.rays;
  RayPacket packet;
  packet.origin = rays.origin;
  packet.major = tile.major;
  packet.slab = tile.slab;
  for (int j = tile.row_begin; j < tile.row_end; ++j) {
    const ColumnRange& range = window_.columns[static_cast<std::size_t>(j)];
    const float b = window_.b[static_cast<std::size_t>(j)];
    const int end = std::min(range.end, tile.column_end);
    for (int i = std::max(range.begin, tile.column_begin); i < end; ++i, ++packet.count) {
      const float a = window_.a[static_cast<std::size_t>(i)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        packet.d[axis][packet.count] = rays.x[axis] * a + (rays.y[axis] * b + rays.z[axis]);
      }
    }
  }
  const PacketTally tally = cast_packets(packet, grid_.flat(), limits_.min_t, limits_.max_t);
  scored_ += tally.scored;
  rays_cast_ += tally.cast;
}

void GainCaster::cast_ray(float a, float b, int major, int slab) {
  const LatticeRay ray = window_.rays.ray(a, b);
  RaySpan span{slab_entry(ray, major, slab), after_depth(limits_.max_t)};
  if (limits_.savings.region_rays || limits_.savings.region_exit) {
    const RaySpan region = clip(ray, grid_.scoring_voxels());
    if (limits_.savings.region_rays && region.empty()) return;
    if (limits_.savings.region_exit) span = span.until(region.exit);
  }
  if (span.empty()) return;
  ++rays_cast_;
  if (limits_.savings.empty_bricks) {
    walk_bricks(ray, span);
  } else {
    walk_voxels(ray, span);
  }
}

void GainCaster::walk_bricks(const LatticeRay& ray, const RaySpan& span) {
  const Index3 first = voxel_at_event(ray, span.enter);
  bool in_first{true};
  walk_cells_from<kBrickLevel>(first, ray, span, [&](const Index3& index, const RaySpan& in_brick) {
    const bool starts_here = std::exchange(in_first, false);
    const StopGrid::Brick brick = grid_.brick(index);
    if (brick.flags == stop_flags::kClear) return false;
    if (brick.flags == stop_flags::kAllBlock) return true;
    const Index3 start = starts_here ? first : voxel_at_event(ray, in_brick.enter);
    if (brick.flags == stop_flags::kAllScore) {
      score(start, in_brick.enter);
      return true;
    }
    return walk_cells_from<kVoxelLevel>(start, ray, in_brick, [&](const Index3& voxel, const RaySpan& in_voxel) {
      return ends_in(brick, voxel, in_voxel.enter);
    });
  });
}

void GainCaster::walk_voxels(const LatticeRay& ray, const RaySpan& span) {
  walk_cells<kVoxelLevel>(ray, span, [&](const Index3& voxel, const RaySpan& in_voxel) {
    const StopGrid::Brick brick = grid_.brick(parent(voxel));
    if (brick.flags == stop_flags::kClear) return false;
    if (brick.flags == stop_flags::kAllBlock) return true;
    if (brick.flags != stop_flags::kAllScore) return ends_in(brick, voxel, in_voxel.enter);
    score(voxel, in_voxel.enter);
    return true;
  });
}

bool GainCaster::ends_in(const StopGrid::Brick& brick, const Index3& voxel, const RayEvent& entered) {
  const int i = child_index(voxel);
  if (!brick.masks->stop.test(i)) return false;
  if (brick.masks->score.test(i)) score(voxel, entered);
  return true;
}

void GainCaster::score(const Index3& voxel, const RayEvent& entered) {
  if (entered.axis < 0 || entered.t < limits_.min_t) return;  // the camera's own voxel, or nearer than it measures
  ++scored_;
  if (seen_ != nullptr) seen_->insert(voxel);
}

}  // namespace saccade
