// SPDX-License-Identifier: Apache-2.0
#pragma once
// StopGrid: what view rays meet in each brick of a box of space: which voxels stop them, and which of those score.

#include <cstdint>
#include <memory>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/view/ray_packets.hpp"
#include "saccade/view/view_gain.hpp"

namespace saccade {

/// Voxels of a brick that stop a ray, and those among them that count for the gain (unknown, inside the region).
struct StopMasks {
  Mask512 stop;
  Mask512 score;
};

/// What a brick, or a box of bricks or voxels, holds.
namespace stop_flags {
constexpr unsigned kScores{1};  ///< a voxel that stops a ray and scores
constexpr unsigned kBlocks{2};  ///< a voxel that stops a ray without scoring
constexpr unsigned kSolid{4};   ///< every voxel stops a ray
constexpr unsigned kMask{7};
constexpr int kShift{3};       ///< a brick's code has the place of its masks above the flags
constexpr unsigned kClear{0};  ///< empty
constexpr unsigned kAllScore{kScores | kSolid};
constexpr unsigned kAllBlock{kBlocks | kSolid};
}  // namespace stop_flags

/// The ternary map (eq. 2.11) as the rays of view evaluation see it: region (eq. 2.6), workspace and the treatment of
/// unknown voxels outside the region are already worked in. Immutable; const use from many threads is safe.
class StopGrid {
 public:
  /// Covers the bricks of `domain` (voxels). Outside it everything is clear.
  /// @return invalid_argument when the domain holds too many sectors.
  /// O(sectors in the domain + bricks of those that exist or touch the region). Same result for every thread count.
  [[nodiscard]] static Result<StopGrid> build(const TsdfSnapshot& map, const Region& region, UnknownOutside outside,
                                              const IndexBox& domain, const Executor& executor);

  /// Smallest box around the voxels that score; empty when there are none.
  [[nodiscard]] const IndexBox& scoring_voxels() const { return scoring_voxels_; }

  struct Brick {
    unsigned flags{0};
    const StopMasks* masks{nullptr};  ///< only for flags other than kClear, kAllScore and kAllBlock
  };
  [[nodiscard]] unsigned brick_flags(const Index3& brick) const {
    return sector_of(brick).codes[static_cast<std::size_t>(child_index(brick))] & stop_flags::kMask;
  }
  [[nodiscard]] Brick brick(const Index3& brick) const {
    const SectorView& sector = sector_of(brick);
    const std::uint16_t code = sector.codes[static_cast<std::size_t>(child_index(brick))];
    return {code & stop_flags::kMask, sector.masks.data() + (code >> stop_flags::kShift)};
  }
  /// Flags of all bricks, or all voxels, from lo to hi, both included.
  [[nodiscard]] unsigned flags_of_bricks(const Index3& lo, const Index3& hi) const;
  [[nodiscard]] unsigned flags_of_voxels(const Index3& lo, const Index3& hi) const;
  [[nodiscard]] bool stops(const Index3& voxel) const;
  /// For rays in packets; empty where the domain holds too many bricks.
  [[nodiscard]] const FlatStops& flat() const { return flat_; }

 private:
  struct SectorView {
    std::array<std::uint16_t, kSectorBricks> codes{};
    std::vector<StopMasks> masks;
    IndexBox scoring;
  };
  class Builder;
  void flatten(const Executor& executor);

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
  std::vector<std::unique_ptr<const SectorView>> views_;
  std::vector<const SectorView*> table_;
  IndexBox scoring_voxels_;
  FlatStops flat_;
};

/// The voxels of a region, at most: all whose centre can lie inside.
[[nodiscard]] IndexBox voxels_around(const Region& region, double voxel_size_m);

}  // namespace saccade
