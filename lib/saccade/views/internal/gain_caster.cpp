// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/gain_caster.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "saccade/map/ray_walk.hpp"

namespace saccade {
namespace {

constexpr int kRootTile{32};  // pixels; initial size of tiles
constexpr int kFineTile{8};   // tiles of this size and below proceed by voxels
constexpr int kRayTile{2};    // rays of tiles of this size are walked singly
constexpr int kSamplePx{8};   // spacing of the rays that classify an open tile
static_assert(kRootTile / kSamplePx * (kRootTile / kSamplePx) < RayPacket::kMost);

/// Returns the event at which a ray enters slab n of voxels along an axis.
RayEvent slab_entry(const LatticeRay& ray, int major, int n) {
  if (n == 0) return kRayStart;
  return {ray.crossing(major, ray.positive(major) ? n : 1 - n), major};
}

}  // namespace

/// State of a tile's rays, slab by slab, until it is decided for all of them or differs.
class GainCaster::TileVisibility {
 public:
  enum class TileState { open, none_scores, all_score, differs };

  /// Rays may be decided together only where the depths of their hits certainly lie within the limits.
  TileVisibility(const RayBeam& beam, const CastLimits& limits, bool may_score, int start)
      : nearest_{limits.min_t * beam.fastest() * (1.0F + kSlack)},
        farthest_{limits.max_t * beam.slowest() * (1.0F - kSlack)},
        may_score_{may_score},
        clear_until_{start} {}

  /// Returns the slab of voxels up to which no ray met anything.
  [[nodiscard]] int clear_until() const { return clear_until_; }
  [[nodiscard]] TileState state() const { return state_; }

  /// Adds the slabs of voxels [n, end), through which the rays run between two distances. Returns whether to go on.
  bool add(unsigned flags, int n, int end, float near, float far) {
    if (met_ == 0 && flags == stop_flags::kClear) {
      clear_until_ = end;
      return true;
    }
    met_ |= flags & (stop_flags::kScores | stop_flags::kBlocks);
    const bool too_near = (met_ & stop_flags::kScores) != 0 && (n == 0 || near < nearest_ || !may_score_);
    if (met_ == (stop_flags::kScores | stop_flags::kBlocks) || too_near) {
      state_ = TileState::differs;
    } else if ((flags & stop_flags::kSolid) != 0) {
      const bool scores = met_ == stop_flags::kScores;
      state_ = !scores ? TileState::none_scores : far <= farthest_ ? TileState::all_score : TileState::differs;
    }
    return state_ == TileState::open;
  }
  /// Marks the tile as undecidable.
  void differ() { state_ = TileState::differs; }
  /// Ends the tile: no slab is left.
  void finish() {
    if (state_ != TileState::open) return;
    state_ = (met_ & stop_flags::kScores) != 0 ? TileState::differs : TileState::none_scores;
  }

 private:
  static constexpr float kSlack{1e-4F};
  float nearest_;
  float farthest_;
  bool may_score_;
  int clear_until_;
  unsigned met_{0};
  TileState state_{TileState::open};
};

GainCaster::GainCaster(const StopGrid& grid, const CastWindow& window, const CastLimits& limits, VoxelSet* seen,
                       const ShownPixels& shown)
    : grid_{grid},
      window_{window},
      limits_{limits},
      seen_{seen},
      shown_{shown},
      use_packets_{limits.savings.packets && limits.savings.region_rays && limits.savings.region_exit &&
                   limits.savings.empty_bricks && limits.savings.tiles && seen == nullptr && !grid.flat().empty()},
      finest_slabs_{use_packets_ ? 2 : 1} {}

void GainCaster::cast_rows(int begin, int end) {
  const auto width = static_cast<int>(window_.a.size());
  const bool blocked = grid_.stops(window_.rays.origin.voxel);  // tiles ignore the voxel in which rays start
  if (!limits_.savings.tiles || !limits_.savings.empty_bricks || blocked) {
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
  finish();
}

void GainCaster::look_over(int tile_px) {
  leave_open_px_ = tile_px;
  cast_rows(0, static_cast<int>(window_.b.size()));
  leave_open_px_ = 0;
  for (OpenTile& open : open_tiles_) {
    open.rays = rays_in(open.tile);
    open_rays_ += open.rays;
  }
}

void GainCaster::classify_open_tiles() {
  const auto same_root = [](const OpenTile& a, const OpenTile& b) {
    return a.tile.row_begin / kRootTile == b.tile.row_begin / kRootTile &&
           a.tile.column_begin / kRootTile == b.tile.column_begin / kRootTile;
  };
  for (auto first = open_tiles_.begin(); first != open_tiles_.end();) {
    const auto last = std::find_if(first, open_tiles_.end(), [&](const OpenTile& o) { return !same_root(*first, o); });
    judge({first, last});
    first = last;
  }
  std::stable_sort(open_tiles_.begin(), open_tiles_.end(), [](const OpenTile& a, const OpenTile& b) {
    return static_cast<double>(a.rays) - a.scoring < static_cast<double>(b.rays) - b.scoring;
  });
}

/// Casts a few rays of tiles that were split from one, to estimate how many of their rays score.
void GainCaster::judge(std::span<OpenTile> tiles) {
  for (OpenTile& open : tiles) open.scoring = 0.5 * static_cast<double>(open.rays);
  if (!use_packets_) return;
  int slab = tiles.front().tile.slab;
  for (const OpenTile& open : tiles) slab = std::min(slab, open.tile.slab);
  RayPacket packet = empty_packet(tiles.front().tile.major, slab);
  std::vector<std::size_t> ends;  // ends of the tiles' rays in the packet
  for (const OpenTile& open : tiles) {
    const Tile& tile = open.tile;
    for (int j = tile.row_begin + kSamplePx / 2; j < tile.row_end; j += kSamplePx) {
      const ColumnRange range = window_.columns_of(j);
      for (int i = tile.column_begin + kSamplePx / 2; i < tile.column_end; i += kSamplePx) {
        if (i >= range.begin && i < range.end && shows(i, j)) add_rays(i, i + 1, j, packet);
      }
    }
    ends.push_back(packet.count);
  }
  const ScoringRays scoring = cast_alone(packet, grid_.flat(), limits_.min_t, limits_.max_t);
  rays_cast_ += scoring.cast;
  std::size_t begin{0};
  for (std::size_t k = 0; k < tiles.size(); begin = ends[k++]) {
    const std::size_t rays = ends[k] - begin;
    if (rays == 0) continue;
    const std::uint64_t scored = scoring.which >> begin & ((std::uint64_t{1} << rays) - 1);
    tiles[k].scoring = static_cast<double>(tiles[k].rays) * std::popcount(scored) / static_cast<double>(rays);
  }
}

void GainCaster::refine(std::uint64_t enough) {
  while (!open_tiles_.empty() && may_be(enough)) {
    const OpenTile open = open_tiles_.back();
    open_tiles_.pop_back();
    open_rays_ -= open.rays;
    decide(open.tile);
  }
  if (decided()) finish();
}

std::uint64_t GainCaster::rays_in(const Tile& tile) const {
  if (shown_.footprint != nullptr) {
    return shown_.footprint->count({tile.column_begin + shown_.column, tile.column_end + shown_.column,
                                    tile.row_begin + shown_.row, tile.row_end + shown_.row});
  }
  std::uint64_t rays{0};
  for (int j = tile.row_begin; j < tile.row_end; ++j) {
    const ColumnRange range = window_.columns_of(j);
    const int columns = std::min(range.end, tile.column_end) - std::max(range.begin, tile.column_begin);
    rays += static_cast<std::uint64_t>(std::max(columns, 0));
  }
  return rays;
}

int GainCaster::last_slab(const RayBeam& beam) const {
  const int in_range = static_cast<int>(limits_.max_t * beam.fastest()) + 2;
  return limits_.savings.region_exit ? std::min(in_range, beam.last_slab(grid_.scoring_voxels())) : in_range;
}

void GainCaster::cast_tile(const Tile& tile) {
  if (rays_in(tile) == 0) return;
  const RayBeam beam{window_, tile};
  TileVisibility sight{beam, limits_, seen_ == nullptr, tile.slab};
  const int size = std::max(tile.columns(), tile.rows());
  if (!beam.one_way()) {
    sight.differ();
  } else if (size > kFineTile) {
    look_by_bricks(beam, last_slab(beam), sight);
  } else {
    look_by_voxels(beam, last_slab(beam), sight);
  }
  if (sight.state() == TileVisibility::TileState::none_scores) return;
  if (sight.state() == TileVisibility::TileState::all_score) {
    scored_ += static_cast<std::uint64_t>(tile.columns()) * static_cast<std::uint64_t>(tile.rows());
    return;
  }
  Tile rest{tile};
  rest.slab = sight.clear_until();
  if (std::max(tile.columns(), tile.rows()) <= leave_open_px_) {
    open_tiles_.push_back({rest});
  } else {
    decide(rest);
  }
}

/// Decides a tile whose rays have different results.
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

void GainCaster::look_by_bricks(const RayBeam& beam, int last, TileVisibility& sight) const {
  for (int n = sight.clear_until(); n <= last;) {
    const int end = beam.first_voxel_slab(beam.brick_slab(n) + 1);
    const RayBeam::Voxels voxels = beam.voxels(n, end);
    const unsigned flags = grid_.flags_of_bricks(parent(voxels.lo), parent(voxels.hi));
    if (!sight.add(flags, n, end, beam.near(n), beam.far(end - 1))) return;
    n = end;
  }
  sight.finish();
}

void GainCaster::look_by_voxels(const RayBeam& beam, int last, TileVisibility& sight) const {
  for (int n = sight.clear_until(); n <= last;) {
    const int end = beam.first_voxel_slab(beam.brick_slab(n) + 1);
    const RayBeam::Voxels voxels = beam.voxels(n, end);
    const unsigned flags = grid_.flags_of_bricks(parent(voxels.lo), parent(voxels.hi));
    const bool decided = stop_flags::uniform(flags) && flags != stop_flags::kAllScore;
    if (!(decided ? sight.add(flags, n, end, beam.near(n), beam.far(end - 1)) : look_closer(beam, n, end, sight))) {
      return;
    }
    n = end;
  }
  sight.finish();
}

/// Halves the slabs until they are uniform, or so thin that a look costs more than walking rays.
bool GainCaster::look_closer(const RayBeam& beam, int n, int end, TileVisibility& sight) const {
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
      if (begin == end || row_begin == row_end) continue;
      Tile part{begin, end, row_begin, row_end, tile.major, tile.slab};
      if (part.slab == 0) part.major = major_axis(window_, part);
      cast_tile(part);
    }
  }
}

void GainCaster::cast_rays(const Tile& tile) {
  for (int j = tile.row_begin; j < tile.row_end; ++j) {
    const ColumnRange range = window_.columns_of(j);
    const float b = window_.b[static_cast<std::size_t>(j)];
    const int end = std::min(range.end, tile.column_end);
    for (int i = std::max(range.begin, tile.column_begin); i < end; ++i) {
      if (shows(i, j)) cast_ray(window_.a[static_cast<std::size_t>(i)], b, tile.major, tile.slab);
    }
  }
}

void GainCaster::cast_packet(const Tile& tile) {
  RayPacket packet = empty_packet(tile.major, tile.slab);
  for (int j = tile.row_begin; j < tile.row_end; ++j) {
    const ColumnRange range = window_.columns_of(j);
    const int begin = std::max(range.begin, tile.column_begin);
    const int end = std::min(range.end, tile.column_end);
    if (begin < end && shows_all(begin, end, j)) {
      add_rays(begin, end, j, packet);
      continue;
    }
    for (int i = begin; i < end; ++i) {
      if (shows(i, j)) add_rays(i, i + 1, j, packet);
    }
  }
  const PacketTally tally = cast_with_others(packet, grid_.flat(), limits_.min_t, limits_.max_t, waiting_);
  scored_ += tally.scored;
  rays_cast_ += tally.cast;
}

RayPacket GainCaster::empty_packet(int major, int slab) const {
  RayPacket packet;
  packet.origin = window_.rays.origin;
  packet.major = major;
  packet.slab = slab;
  return packet;
}

/// Adds the rays of columns [begin, end) of a row.
void GainCaster::add_rays(int begin, int end, int row, RayPacket& packet) const {
  const auto count = static_cast<std::size_t>(end - begin);
  const float* const a = window_.a.data() + begin;
  const float b = window_.b[static_cast<std::size_t>(row)];
  const SensorRays& rays = window_.rays;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float x = rays.x[axis];
    const float in_row = rays.y[axis] * b + rays.z[axis];
    float* const d = packet.d[axis].data() + packet.count;
    for (std::size_t i = 0; i < count; ++i) d[i] = x * a[i] + in_row;
  }
  packet.count += count;
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
    if (brick.flags == stop_flags::kAllBlock || brick.flags == stop_flags::kBuried) return true;
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
    if (brick.flags == stop_flags::kAllBlock || brick.flags == stop_flags::kBuried) return true;
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
  if (entered.axis < 0 || entered.t < limits_.min_t) return;  // the camera's own voxel, or nearer than its range
  ++scored_;
  if (seen_ != nullptr) seen_->insert(voxel);
}

}  // namespace saccade
