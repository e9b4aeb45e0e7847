// SPDX-License-Identifier: Apache-2.0
#pragma once
// EntryFaces: the faces of voxels through which rays enter scoring voxels.

#include <array>
#include <cstdint>
#include <vector>

#include "saccade/views/internal/stop_grid.hpp"

namespace saccade {

/// Square of faces in a plane across an axis.
struct FaceSquare {
  Index3 corner;  ///< lowest, in voxels; on the plane of entry
  int edge_vox;
};

/// Squares near each other, in planes across one axis and entered in one direction.
struct FaceGroup {
  std::size_t begin;  ///< squares of EntryFaces; whole vectors of kLanes
  std::size_t end;
  int axis;
  bool forward;  ///< rays enter towards growing coordinates
  Index3 lo;     ///< corners of the box around the squares, in voxels
  Index3 hi;
};

/// Faces through which rays score: a ray enters its last voxel, which scores, from a neighbour that does not stop it.
/// They are merged to squares of 1, 2, 4 or 8 voxels, aligned within their brick.
class EntryFaces {
 public:
  static constexpr std::size_t kLanes{16};  ///< groups are padded to multiples of this with copies of their last square

  EntryFaces() = default;
  /// Finds the faces. O(bricks around the scoring voxels + faces). The thread count never changes the result.
  EntryFaces(const StopGrid& grid, const Executor& executor);

  [[nodiscard]] const std::vector<FaceGroup>& groups() const { return groups_; }
  /// Returns the lowest corners of the squares by coordinate, in voxels; along the group's axis the plane of entry.
  [[nodiscard]] const std::vector<std::int32_t>& corners(std::size_t axis) const { return corners_[axis]; }
  [[nodiscard]] const std::vector<float>& edges_vox() const { return edges_vox_; }

 private:
  void add_group(const std::vector<FaceSquare>& squares, int axis, bool forward);

  std::vector<FaceGroup> groups_;
  std::array<std::vector<std::int32_t>, 3> corners_;
  std::vector<float> edges_vox_;
};

}  // namespace saccade
