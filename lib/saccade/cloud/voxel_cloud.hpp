// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelCloud: a point cloud in voxels, with their neighbours and normals; the input of supervoxels.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// How points are grouped into voxels.
struct VoxelCloudConfig {
  double voxel_size_m{0.0075};
  bool single_camera{false};  ///< voxels grow with depth: cubes in (x/z, y/z, ln z), of the given size at 1 m
  Eigen::Vector3d viewpoint_m{0.0, 0.0, 0.0};  ///< estimated normals turn towards it

  /// @return invalid_argument for a size that is not finite and positive, or a viewpoint that is not finite.
  [[nodiscard]] Status validate() const;
};

/// Averages over the points in one voxel.
struct CloudVoxel {
  Eigen::Vector3f place;       ///< mean in voxel coordinates: metres, or (x/z, y/z, ln z)
  Eigen::Vector3f position_m;  ///< mean in metres
  Eigen::Vector3f normal;      ///< unit normal
  Eigen::Vector3f color;       ///< mean; zero where the cloud has none
  std::uint32_t points{0};
};

/// Voxels in the order of their first points.
struct VoxelCloud {
  std::vector<CloudVoxel> voxels;
  std::vector<std::uint32_t> voxel_of;  ///< per point; kUnlabelled where it is in no voxel
  std::vector<std::uint32_t> starts;    ///< first neighbour of each voxel in `ids`; one entry more than voxels
  std::vector<std::uint32_t> ids;       ///< neighbours, among the 26 voxels around each voxel

  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t voxel) const {
    return std::span{ids}.subspan(starts[voxel], starts[voxel + 1] - starts[voxel]);
  }
};

/// Groups points into voxels as Papon et al. do, CVPR 2013, section 3.1. Where the cloud lacks normals, a voxel's
/// normal is that of the plane through the points up to two voxels away; where these lie on a line, it points to the
/// viewpoint. Points that are not finite are in no voxel, nor, with a single camera, points behind it.
/// @return an error of the cloud or the config; invalid_argument for a point farther than a million voxels.
/// O(points). The thread count never changes a bit of the result.
[[nodiscard]] Result<VoxelCloud> voxelise(const PointCloud& cloud, const VoxelCloudConfig& config,
                                          const Executor& executor);

}  // namespace saccade
