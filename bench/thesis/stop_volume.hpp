// SPDX-License-Identifier: Apache-2.0
#pragma once
// StopVolume: a box of the map as one byte per voxel, what a ray of view evaluation meets there.

#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade::thesis {

/// Effect of a voxel on a ray: unknown voxels of the region score, all others that are not empty only block.
enum class Stop : std::uint8_t { no, blocks, scores };

/// The ternary representation (eq. 2.11) that NBV-CPU converts the TSDF volume to. The map's workspace is not heeded:
/// outside it all is unknown. Const use from many threads is safe.
class StopVolume {
 public:
  /// The voxels of a box of bricks. O(voxels).
  [[nodiscard]] static StopVolume fill(const TsdfSnapshot& map, const Region& region, const IndexBox& bricks,
                                       const Executor& executor);

  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] const Index3& size() const { return size_; }
  /// Where coordinates in single precision start, so that they stay small.
  [[nodiscard]] Index3 middle() const { return box_.lo + Index3{size_.x / 2, size_.y / 2, size_.z / 2}; }
  /// Only for voxels of the box.
  [[nodiscard]] Stop at(const Index3& voxel) const { return at_offset(voxel - box_.lo); }
  /// Relative to the lower corner of the box.
  [[nodiscard]] Stop at_offset(const Index3& offset) const { return stops_[flat_index(offset)]; }

  /// The voxels that stop a ray and have an empty neighbour across a face: those in which rays from empty space end.
  /// z-y-x order.
  [[nodiscard]] std::vector<Index3> boundary() const;

 private:
  explicit StopVolume(const IndexBox& bricks);
  void fill_brick(const TsdfSnapshot& map, const Region& region, const Index3& brick);
  [[nodiscard]] bool is_boundary(const Index3& offset) const;
  [[nodiscard]] std::size_t flat_index(const Index3& offset) const {
    return (static_cast<std::size_t>(offset.z) * static_cast<std::size_t>(size_.y) +
            static_cast<std::size_t>(offset.y)) *
               static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(offset.x);
  }

  IndexBox box_;
  Index3 size_;
  std::vector<Stop> stops_;
};

}  // namespace saccade::thesis
