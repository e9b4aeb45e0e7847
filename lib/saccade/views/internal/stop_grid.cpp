// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/stop_grid.hpp"

#include <cstring>

#include "saccade/map/surface_cells.hpp"
#include "saccade/map/voxels_inside.hpp"

namespace saccade {
namespace {

constexpr double kMostSectors{1 << 23};

IndexBox voxels_of_brick(const Index3& brick) { return IndexBox::cube(brick * kBrickEdge, kBrickEdge); }

/// Returns the smallest box around the bits set in the mask of a brick. Expects at least one.
IndexBox bounds_of_mask(const Mask512& mask, const Index3& brick) {
  const auto [lo, hi] = bounds_of(mask);
  return {brick * kBrickEdge + lo, brick * kBrickEdge + hi};
}

/// Table that moves bits 0 … 7 to the even bits.
constexpr std::array<std::uint16_t, 256> kSpread = [] {
  std::array<std::uint16_t, 256> spread{};
  for (unsigned i = 0; i < 256; ++i) {
    for (unsigned bit = 0; bit < 8; ++bit)
      spread[i] = static_cast<std::uint16_t>(spread[i] | (i >> bit & 1U) << 2 * bit);
  }
  return spread;
}();

/// Writes a brick into the table of FlatStops; strides in bytes.
void write_brick(const StopGrid::Brick& brick, std::byte* at, std::size_t row, std::size_t slice) {
  const bool uniform = stop_flags::uniform(brick.flags);
  const std::uint16_t all = brick.flags == stop_flags::kAllScore ? 0xFFFF : 0x5555;
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    for (std::size_t y = 0; y < kBrickEdge; ++y) {
      std::uint16_t bits{all};
      if (!uniform) {
        const std::uint64_t stop = brick.masks->stop.words[z] >> (8 * y) & 0xFFU;
        const std::uint64_t score = brick.masks->score.words[z] >> (8 * y) & 0xFFU;
        bits = static_cast<std::uint16_t>(kSpread[stop] | kSpread[score] << 1U);
      }
      std::memcpy(at + z * slice + y * row, &bits, sizeof bits);
    }
  }
}

}  // namespace

IndexBox voxels_around(const Region& region, double voxel_size_m) {
  return voxels_with_center_in(bounds(region), voxel_size_m).grown(1);
}

/// Builder of the stop grid from the map's sectors, one at a time.
class StopGrid::Builder {
 public:
  Builder(const TsdfSnapshot& map, const Region& region, UnknownOutside outside)
      : map_{map},
        region_{region},
        unknown_blocks_{outside == UnknownOutside::blocks},
        region_voxels_{voxels_around(region, map.config.voxel_size_m)} {
    if (map.config.workspace) workspace_ = voxels_with_center_in(*map.config.workspace, map.config.voxel_size_m);
  }

  enum class Kind { clear, blocked, detailed };
  [[nodiscard]] Kind kind(const Index3& sector) const {
    const IndexBox voxels = IndexBox::cube(sector * kSectorVoxelEdge, kSectorVoxelEdge);
    if (workspace_ && !voxels.overlaps(*workspace_)) return Kind::clear;
    if (map_.grid.find(sector) != nullptr || voxels.overlaps(region_voxels_)) return Kind::detailed;
    if (!unknown_blocks_) return Kind::clear;
    return !workspace_ || workspace_->contains(voxels) ? Kind::blocked : Kind::detailed;
  }

  [[nodiscard]] std::unique_ptr<SectorView> detailed(const Index3& index) const {
    auto view = std::make_unique<SectorView>();
    const Sector* sector = map_.grid.find(index);
    for (int i = 0; i < kSectorBricks; ++i) add_brick(*view, index * kSectorEdge + child_offset(i), sector, i);
    return view;
  }

 private:
  void add_brick(SectorView& view, const Index3& brick, const Sector* sector, int i) const {
    const bool has_unknown = sector == nullptr || sector->has_unknown.test(i);
    const bool has_occupied = sector != nullptr && sector->has_occupied.test(i);
    if (!has_unknown && !has_occupied) return;
    const StopMasks masks =
        stop_masks(brick, sector == nullptr ? nullptr : &sector->bricks[static_cast<std::size_t>(i)]);
    const bool blocks = (masks.stop & ~masks.score).any();
    const bool scores = masks.score.any();
    std::uint16_t& code = view.codes[static_cast<std::size_t>(i)];
    if (scores) view.scoring = view.scoring.hull(bounds_of_mask(masks.score, brick));
    if (masks.stop.none()) return;
    const unsigned flags = (scores ? stop_flags::kScores : 0U) | (blocks ? stop_flags::kBlocks : 0U) |
                           (masks.stop.all() ? stop_flags::kSolid : 0U);
    code = static_cast<std::uint16_t>(flags);
    if (stop_flags::uniform(flags)) return;
    code = static_cast<std::uint16_t>(flags | (view.masks.size() << stop_flags::kShift));
    view.masks.push_back(masks);
  }

  [[nodiscard]] StopMasks stop_masks(const Index3& brick, const BrickRef* ref) const {
    Mask512 unknown = ref == nullptr ? Mask512::all_set() : ref->unknown_mask();
    Mask512 occupied = ref == nullptr ? Mask512{} : ref->occupied_mask();
    const IndexBox voxels = voxels_of_brick(brick);
    if (workspace_ && !workspace_->contains(voxels)) {
      const Mask512 within = voxels_inside(*workspace_, brick * kBrickEdge);
      unknown = unknown & within;
      occupied = occupied & within;
    }
    Mask512 score;
    if (unknown.any() && voxels.overlaps(region_voxels_)) {
      score = unknown & voxels_inside(region_, brick * kBrickEdge, map_.config.voxel_size_m);
    }
    const Mask512 stop = occupied | (unknown_blocks_ ? unknown : score);
    return {stop, score, stop};
  }

  const TsdfSnapshot& map_;
  const Region& region_;
  bool unknown_blocks_;
  IndexBox region_voxels_;
  std::optional<IndexBox> workspace_;
};

Result<StopGrid> StopGrid::build(const TsdfSnapshot& map, const Region& region, UnknownOutside outside,
                                 const IndexBox& domain, bool only_exposed, const Executor& executor) {
  StopGrid grid;
  grid.sectors_ = parents(parents(domain));
  const Index3 size = grid.sectors_.size();
  if (grid.sectors_.count() > kMostSectors) {
    return Error{Errc::invalid_argument,
                 "the space between the view poses and the region holds too many voxels; use a shorter range or larger "
                 "voxels",
                 "view evaluation"};
  }
  grid.size_x_ = static_cast<std::uint32_t>(size.x);
  grid.size_y_ = static_cast<std::uint32_t>(size.y);
  grid.size_z_ = static_cast<std::uint32_t>(size.z);
  const std::size_t count = std::size_t{grid.size_x_} * grid.size_y_ * grid.size_z_;

  grid.clear_ = std::make_unique<const SectorView>();
  auto blocked = std::make_unique<SectorView>();
  blocked->codes.fill(static_cast<std::uint16_t>(stop_flags::kAllBlock));
  grid.blocked_ = std::move(blocked);

  const Builder builder{map, region, outside};
  grid.table_.assign(count, grid.clear_.get());
  std::vector<std::size_t> places;  // indices of the detailed sectors in the table
  for (std::size_t i = 0; i < count; ++i) {
    const Index3 offset{static_cast<std::int32_t>(i % grid.size_x_),
                        static_cast<std::int32_t>(i / grid.size_x_ % grid.size_y_),
                        static_cast<std::int32_t>(i / grid.size_x_ / grid.size_y_)};
    const Index3 sector = grid.sectors_.lo + offset;
    switch (builder.kind(sector)) {
      case Builder::Kind::clear: break;
      case Builder::Kind::blocked: grid.table_[i] = grid.blocked_.get(); break;
      case Builder::Kind::detailed:
        places.push_back(i);
        grid.detailed_.push_back(sector);
        break;
    }
  }
  grid.views_.resize(places.size());
  executor.parallel_for(places.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) grid.views_[k] = builder.detailed(grid.detailed_[k]);
  });
  for (std::size_t k = 0; k < places.size(); ++k) grid.table_[places[k]] = grid.views_[k].get();
  if (only_exposed) grid.find_exposed(executor);
  for (const auto& view : grid.views_) grid.scoring_voxels_ = grid.scoring_voxels_.hull(view->scoring);
  grid.flatten(domain, executor);
  return grid;
}

/// Finds the voxels with a neighbour that does not stop rays, and derives flags and boxes.
void StopGrid::find_exposed(const Executor& executor) {
  std::vector<std::array<std::uint16_t, kSectorBricks>> codes(
      views_.size());  // separate, because neighbours still read the old ones
  executor.parallel_for(views_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      SectorView& view = *views_[k];
      codes[k] = view.codes;
      view.scoring = {};
      for (int i = 0; i < kSectorBricks; ++i) {
        std::uint16_t& code = codes[k][static_cast<std::size_t>(i)];
        const unsigned flags = code & stop_flags::kMask;
        if (flags == stop_flags::kClear) continue;
        const Index3 brick = detailed_[k] * kSectorEdge + child_offset(i);
        if (stop_flags::uniform(flags)) {
          if (buried(brick))
            code = static_cast<std::uint16_t>(stop_flags::kBuried);
          else if ((flags & stop_flags::kScores) != 0)
            view.scoring = view.scoring.hull(voxels_of_brick(brick));
          continue;
        }
        StopMasks& masks = view.masks[code >> stop_flags::kShift];
        masks.exposed = exposed_voxels(brick, masks.stop);
        const Mask512 scores = masks.exposed & masks.score;
        if (scores.any()) view.scoring = view.scoring.hull(bounds_of_mask(scores, brick));
        code = static_cast<std::uint16_t>((code & ~(stop_flags::kScores | stop_flags::kBlocks)) |
                                          (scores.any() ? stop_flags::kScores : 0U) |
                                          ((masks.exposed & ~masks.score).any() ? stop_flags::kBlocks : 0U));
      }
    }
  });
  for (std::size_t k = 0; k < views_.size(); ++k) views_[k]->codes = codes[k];
}

/// Tells whether a solid brick has only solid neighbours.
bool StopGrid::buried(const Index3& brick) const {
  return (brick_flags(brick + Index3{-1, 0, 0}) & brick_flags(brick + Index3{1, 0, 0}) &
          brick_flags(brick + Index3{0, -1, 0}) & brick_flags(brick + Index3{0, 1, 0}) &
          brick_flags(brick + Index3{0, 0, -1}) & brick_flags(brick + Index3{0, 0, 1}) & stop_flags::kSolid) != 0;
}

Mask512 StopGrid::exposed_voxels(const Index3& brick, const Mask512& stop) const {
  constexpr std::uint64_t kFirstColumn{0x0101010101010101ULL};
  constexpr std::uint64_t kLastColumn{kFirstColumn << 7};
  const Mask512 clear = ~stop;
  const auto clear_beside = [&](const Index3& step) {
    const Brick neighbour = this->brick(brick + step);
    if ((neighbour.flags & stop_flags::kSolid) != 0) return Mask512{};
    return neighbour.flags == stop_flags::kClear ? Mask512::all_set() : ~neighbour.masks->stop;
  };
  const Mask512 left = clear_beside({-1, 0, 0});
  const Mask512 right = clear_beside({1, 0, 0});
  const Mask512 above = clear_beside({0, -1, 0});
  const Mask512 below = clear_beside({0, 1, 0});
  const Mask512 before = clear_beside({0, 0, -1});
  const Mask512 behind = clear_beside({0, 0, 1});
  Mask512 exposed;
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    const std::uint64_t here = clear.words[z];
    const std::uint64_t beside_x = ((here & ~kLastColumn) << 1) | ((left.words[z] & kLastColumn) >> 7) |
                                   ((here & ~kFirstColumn) >> 1) | ((right.words[z] & kFirstColumn) << 7);
    const std::uint64_t beside_y = (here << 8) | (above.words[z] >> 56) | (here >> 8) | (below.words[z] << 56);
    const std::uint64_t beside_z = (z == 0 ? before.words[kBrickEdge - 1] : clear.words[z - 1]) |
                                   (z == kBrickEdge - 1 ? behind.words[0] : clear.words[z + 1]);
    exposed.words[z] = stop.words[z] & (beside_x | beside_y | beside_z);
  }
  return exposed;
}

void StopGrid::flatten(const IndexBox& domain, const Executor& executor) {
  constexpr double kMost{1 << 28};  // voxels: 64 MiB
  const IndexBox bricks = parents(domain);
  flat_.voxels = {bricks.lo * kBrickEdge, bricks.hi * kBrickEdge};
  const Index3 size = flat_.voxels.size();
  if (scoring_voxels_.empty() || flat_.voxels.count() > kMost) return;
  flat_.scoring_voxels = scoring_voxels_;
  const auto row = static_cast<std::size_t>(size.x);
  const std::size_t slice = row * static_cast<std::size_t>(size.y);
  flat_.bits.resize(slice * static_cast<std::size_t>(size.z) / FlatStops::kVoxelsPerWord + 1);
  auto* const bytes = reinterpret_cast<std::byte*>(flat_.bits.data());
  executor.parallel_for(static_cast<std::size_t>(bricks.size().z), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t layer = begin; layer < end; ++layer) {
      bricks.layer(layer).for_each([&](const Index3& index) {
        const Brick brick = this->brick(index);
        if (brick.flags == stop_flags::kClear) return;
        const std::size_t first = layer * kBrickEdge * slice +
                                  static_cast<std::size_t>(index.y - bricks.lo.y) * kBrickEdge * row +
                                  static_cast<std::size_t>(index.x - bricks.lo.x) * kBrickEdge;
        write_brick(brick, bytes + first / 4, row / 4, slice / 4);
      });
    }
  });
}

bool StopGrid::stops(const Index3& voxel) const { return (flags_of_voxels(voxel, voxel) & stop_flags::kSolid) != 0; }

}  // namespace saccade
