// SPDX-License-Identifier: Apache-2.0
#pragma once
// StopGrid: for each brick of a box of space, the voxels that stop view rays, and those among them that score.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/internal/ray_packets.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// Voxels of a brick that stop a ray; those among them that count for the gain (unknown, inside the region); and those
/// that a ray can reach. A voxel all of whose six neighbours stop rays is unreachable.
struct StopMasks {
  Mask512 stop;
  Mask512 score;
  Mask512 exposed;
};

/// Content of a brick, or of a box of bricks or voxels.
namespace stop_flags {
constexpr unsigned kScores{1};  ///< an exposed voxel that stops a ray and scores
constexpr unsigned kBlocks{2};  ///< an exposed voxel that stops a ray without scoring
constexpr unsigned kSolid{4};   ///< every voxel stops a ray
constexpr unsigned kMask{7};
constexpr int kShift{3};       ///< a brick's code holds the index of its masks above the flags
constexpr unsigned kClear{0};  ///< empty
constexpr unsigned kAllScore{kScores | kSolid};
constexpr unsigned kAllBlock{kBlocks | kSolid};
constexpr unsigned kBuried{kSolid};  ///< and no ray reaches it
/// Tells whether the flags of a brick describe it completely.
[[nodiscard]] constexpr bool uniform(unsigned flags) {
  return flags == kClear || flags == kAllScore || flags == kAllBlock || flags == kBuried;
}
}  // namespace stop_flags

/// Ternary map (eq. 2.11) for the rays of view evaluation, with region (eq. 2.6), workspace and the treatment of
/// unknown voxels outside the region already applied. Immutable; const use from many threads is safe.
class StopGrid {
 public:
  /// Covers the bricks of `domain` (voxels); everything outside is clear. Unless `only_exposed`, every voxel counts as
  /// exposed.
  /// @return invalid_argument when the domain holds too many sectors. O(sectors in the domain + bricks of those that
  /// exist or touch the region). The thread count never changes the result.
  [[nodiscard]] static Result<StopGrid> build(const TsdfSnapshot& map, const Region& region, UnknownOutside outside,
                                              const IndexBox& domain, bool only_exposed, const Executor& executor);

  /// Returns the smallest box around the exposed voxels that score; empty when there are none.
  [[nodiscard]] const IndexBox& scoring_voxels() const { return scoring_voxels_; }

  struct Brick {
    unsigned flags{0};
    const StopMasks* masks{nullptr};  ///< only for flags other than kClear, kAllScore, kAllBlock and kBuried
  };
  [[nodiscard]] unsigned brick_flags(const Index3& brick) const {
    return sector_of(brick).codes[static_cast<std::size_t>(child_index(brick))] & stop_flags::kMask;
  }
  [[nodiscard]] Brick brick(const Index3& brick) const {
    const SectorView& sector = sector_of(brick);
    const std::uint16_t code = sector.codes[static_cast<std::size_t>(child_index(brick))];
    return {code & stop_flags::kMask, sector.masks.data() + (code >> stop_flags::kShift)};
  }
  /// Return the joined flags of all bricks, or all voxels, from lo to hi, both included.
  [[nodiscard]] unsigned flags_of_bricks(const Index3& lo, const Index3& hi) const;
  [[nodiscard]] unsigned flags_of_voxels(const Index3& lo, const Index3& hi) const;
  [[nodiscard]] bool stops(const Index3& voxel) const;
  /// Returns the table for rays in packets; empty where the domain holds too many bricks.
  [[nodiscard]] const FlatStops& flat() const { return flat_; }

 private:
  struct SectorView {
    std::array<std::uint16_t, kSectorBricks> codes{};
    std::vector<StopMasks> masks;
    IndexBox scoring;
  };
  class Builder;
  void find_exposed(const Executor& executor);
  [[nodiscard]] bool buried(const Index3& brick) const;
  [[nodiscard]] Mask512 exposed_voxels(const Index3& brick, const Mask512& stop) const;
  void flatten(const IndexBox& domain, const Executor& executor);

  [[nodiscard]] static unsigned flags_within(const Brick& brick, const Index3& lo, const Index3& hi);

  [[nodiscard]] const SectorView& sector_of(const Index3& brick) const {
    const Index3 i = parent(brick) - sectors_.lo;
    if (static_cast<std::uint32_t>(i.x) >= size_x_ || static_cast<std::uint32_t>(i.y) >= size_y_ ||
        static_cast<std::uint32_t>(i.z) >= size_z_) {
      return *clear_;
    }
    return *table_[(static_cast<std::size_t>(i.z) * size_y_ + static_cast<std::size_t>(i.y)) * size_x_ +
                   static_cast<std::size_t>(i.x)];
  }

  IndexBox sectors_;
  std::uint32_t size_x_{0};
  std::uint32_t size_y_{0};
  std::uint32_t size_z_{0};
  std::unique_ptr<const SectorView> clear_;
  std::unique_ptr<const SectorView> blocked_;
  std::vector<std::unique_ptr<SectorView>> views_;  ///< one per sector in `detailed_`
  std::vector<Index3> detailed_;                    ///< sectors
  std::vector<const SectorView*> table_;
  IndexBox scoring_voxels_;
  FlatStops flat_;
};

/// Returns the flags of the voxels of one brick from lo to hi, relative to its corner, clipped to the brick.
inline unsigned StopGrid::flags_within(const Brick& brick, const Index3& lo, const Index3& hi) {
  if (stop_flags::uniform(brick.flags)) return brick.flags;
  const int x0 = std::max(lo.x, 0);
  const int x1 = std::min(hi.x, kBrickEdge - 1);
  const int y0 = std::max(lo.y, 0);
  const int y1 = std::min(hi.y, kBrickEdge - 1);
  const std::uint64_t row = (0xFFU >> (kBrickEdge - 1 - x1)) & (0xFFU << x0) & 0xFFU;
  const std::uint64_t rows = (~std::uint64_t{0} >> (8 * (kBrickEdge - 1 - y1))) & (~std::uint64_t{0} << (8 * y0));
  const std::uint64_t rectangle = (row * 0x0101010101010101ULL) & rows;
  std::uint64_t score{0};
  std::uint64_t block{0};
  std::uint64_t missing{0};
  for (int z = std::max(lo.z, 0); z <= std::min(hi.z, kBrickEdge - 1); ++z) {
    const std::uint64_t stops = brick.masks->stop.words[static_cast<std::size_t>(z)] & rectangle;
    const std::uint64_t exposed = brick.masks->exposed.words[static_cast<std::size_t>(z)] & rectangle;
    const std::uint64_t scores = brick.masks->score.words[static_cast<std::size_t>(z)];
    score |= exposed & scores;
    block |= exposed & ~scores;
    missing |= rectangle & ~stops;
  }
  return (score != 0 ? stop_flags::kScores : 0U) | (block != 0 ? stop_flags::kBlocks : 0U) |
         (missing == 0 ? stop_flags::kSolid : 0U);
}

inline unsigned StopGrid::flags_of_bricks(const Index3& lo, const Index3& hi) const {
  unsigned any{0};
  unsigned all{stop_flags::kSolid};
  for (std::int32_t z = lo.z; z <= hi.z; ++z) {
    for (std::int32_t y = lo.y; y <= hi.y; ++y) {
      for (std::int32_t x = lo.x; x <= hi.x; ++x) {
        const unsigned flags = brick_flags({x, y, z});
        any |= flags;
        all &= flags;
      }
    }
  }
  return (any & ~stop_flags::kSolid) | all;
}

inline unsigned StopGrid::flags_of_voxels(const Index3& lo, const Index3& hi) const {
  unsigned any{0};
  unsigned all{stop_flags::kSolid};
  const Index3 brick_lo = parent(lo);
  const Index3 brick_hi = parent(hi);
  if (brick_lo == brick_hi)
    return flags_within(brick(brick_lo), lo - brick_lo * kBrickEdge, hi - brick_lo * kBrickEdge);
  for (std::int32_t z = brick_lo.z; z <= brick_hi.z; ++z) {
    for (std::int32_t y = brick_lo.y; y <= brick_hi.y; ++y) {
      for (std::int32_t x = brick_lo.x; x <= brick_hi.x; ++x) {
        const Index3 corner{x * kBrickEdge, y * kBrickEdge, z * kBrickEdge};
        const unsigned flags = flags_within(brick({x, y, z}), lo - corner, hi - corner);
        any |= flags;
        all &= flags;
      }
    }
  }
  return (any & ~stop_flags::kSolid) | all;
}

/// Returns a box that holds all voxels whose centre can lie inside the region.
[[nodiscard]] IndexBox voxels_around(const Region& region, double voxel_size_m);

}  // namespace saccade
