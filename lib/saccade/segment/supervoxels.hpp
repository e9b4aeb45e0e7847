// SPDX-License-Identifier: Apache-2.0
#pragma once
// SupervoxelConfig, SupervoxelResult and find_supervoxels: VCCS, patches of a cloud that keep within surfaces.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/cloud/voxel_cloud.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Parameters of find_supervoxels.
struct SupervoxelConfig {
  VoxelCloudConfig voxels{};
  double seed_spacing_m{0.03};  ///< edge length of the cells with a seed each
  double spatial_weight{1.0};   ///< of the distance from the centre, in seed spacings
  double normal_weight{4.0};    ///< of 1 − cos of the angle between normals
  double color_weight{0.0};     ///< of the distance between colours
  double min_seed_share{
      0.3};       ///< of the voxels that a plane fills within half a seed spacing: a seed with fewer is dropped
  int rounds{1};  ///< of growth; before each but the first, supervoxels are taken to be at the means of their voxels

  /// @return invalid_argument for a number that is not finite or negative, all weights zero, seeds closer than voxels,
  /// or rounds that are not from 1 to 100.
  [[nodiscard]] Status validate() const;
  /// Voxels within half a seed spacing, given in voxels, that a seed needs.
  [[nodiscard]] double fewest_around_seed(double spacing_vox) const;
};

/// A patch of a surface.
struct Supervoxel {
  Eigen::Vector3f centroid_m;  ///< mean of its voxels
  Eigen::Vector3f normal;      ///< mean of its voxels, of unit length
  Eigen::Vector3f color;       ///< mean of its voxels
  std::uint32_t voxels{0};
  std::uint32_t points{0};
};

/// Labels count supervoxels from 0.
struct SupervoxelResult {
  std::vector<std::uint32_t> labels;  ///< one per point; kUnlabelled where there is no point
  std::vector<Supervoxel> supervoxels;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< supervoxels that touch, (a, b) with a < b, sorted
  std::size_t voxels{0};
  double voxel_size_m{0.0};
};

/// Voxel cloud connectivity segmentation (Papon et al., CVPR 2013): seeds on a regular grid, moved to where normals and
/// colours change least, grow from voxel to neighbouring voxel, each voxel going to the nearest seed that reaches it.
/// Unless there are more rounds, seeds stay where they are, unlike the paper's: docs/segmentation.md says what that is
/// good for. A connected part without a seed becomes a supervoxel of its own, so that every point has a label.
/// @return an error of the cloud or the config; no points: no supervoxels.
/// O(points + voxels × rounds). The thread count never changes a bit of the result.
[[nodiscard]] Result<SupervoxelResult> find_supervoxels(const PointCloud& cloud, const SupervoxelConfig& config,
                                                        const Executor& executor);

}  // namespace saccade
