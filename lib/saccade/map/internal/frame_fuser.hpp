// SPDX-License-Identifier: Apache-2.0
#pragma once
// FrameFuser: fuses one range image into the bricks of one sector after another. Used by TsdfMap::integrate.

#include <array>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/internal/fusion_kernels.hpp"
#include "saccade/map/internal/range_image.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// One frame being fused into the grid. Space is visited top-down, eight octants at a time: of a sector, of its cubes,
/// of a brick. A cube of voxels entirely in front of everything seen in its beams is observed as free without touching
/// its voxels; a cube behind everything is skipped. The bounds are conservative, so the result equals that of updating
/// voxel by voxel.
class FrameFuser {
 public:
  FrameFuser(const TsdfConfig& config, const RangeImage& ranges, const Pose& T_world_camera, const ColorImage* color);

  /// Returns the sectors that this frame may change, in z-y-x order.
  /// @return invalid_argument when the frame's view holds too many sectors.
  [[nodiscard]] Result<std::vector<Index3>> candidate_sectors(const Executor& executor) const;

  struct Counts {
    std::size_t bricks_updated{0};
    std::size_t bricks_free{0};
    std::size_t bricks_saturated{0};
  };
  /// Tells whether this frame would leave the sector unchanged, so that it need not be unshared.
  [[nodiscard]] bool leaves_unchanged(const Index3& sector_key, const Sector& sector) const;
  /// Fuses the frame into one sector. Different sectors may be fused from different threads.
  [[nodiscard]] Counts fuse(const Index3& sector_key, Sector& sector) const;

 private:
  /// Cube of voxels with `edge` voxels (a power of two) along each axis, from voxel `lo` on.
  struct Cube {
    Index3 lo;
    int edge;
  };
  [[nodiscard]] fusion::KnownOctants known_octants(const Cube& cube) const;
  /// Returns the frame of the cube or brick with this first voxel.
  [[nodiscard]] tsdf::BrickFrame frame_at(const Index3& voxel) const;
  void fuse_cube(const Cube& cube, Sector& sector, Counts& counts) const;
  /// Returns false when no voxel was seen.
  bool observe(const fusion::BrickSamples& observed, BrickRef& ref) const;
  void observe_free(const Cube& cube, Sector& sector, Counts& counts) const;
  void fuse_brick(const Index3& brick, bool inside, Sector& sector, Counts& counts) const;
  void update_colors(const fusion::BrickSamples& observed, DenseBrick& dense) const;

  const TsdfConfig& config_;
  const RangeImage& ranges_;
  const ColorImage* color_;
  Pose T_camera_world_;
  Eigen::Vector3d camera_world_;
  std::array<tsdf::Float3, 3> steps_;  ///< steps from voxel to voxel, in camera coordinates
};

}  // namespace saccade
