// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelCloud: a point cloud in voxels, with their neighbours and normals; what supervoxels are made of.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// How points become voxels.
struct VoxelCloudConfig {
  double voxel_size_m{0.0075};
  bool single_camera{false};  ///< voxels grow with depth: they are cubes in (x/z, y/z, ln z), as large as said at 1 m
  Eigen::Vector3d viewpoint_m{0.0, 0.0, 0.0};  ///< estimated normals turn towards it

  /// @return invalid_argument for a size that is not finite and positive, or a viewpoint that is not finite.
  [[nodiscard]] Status validate() const;
};

/// What the points in one voxel have in common.
struct CloudVoxel {
  Eigen::Vector3f place;       ///< of the mean, in the coordinates of the voxels: metres, or (x/z, y/z, ln z)
  Eigen::Vector3f position_m;  ///< mean
  Eigen::Vector3f normal;      ///< of unit length
  Eigen::Vector3f color;       ///< mean; zero where the cloud has none
  std::uint32_t points{0};
};

/// Voxels in the order of their first points.
struct VoxelCloud {
  std::vector<CloudVoxel> voxels;
  std::vector<std::uint32_t> voxel_of;  ///< per point; kUnlabelled: none
  std::vector<std::uint32_t> starts;    ///< of a voxel's neighbours, one more than voxels
  std::vector<std::uint32_t> ids;       ///< neighbours, of the 26 around a voxel

  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t voxel) const {
    return std::span{ids}.subspan(starts[voxel], starts[voxel + 1] - starts[voxel]);
  }
};

/// Papon et al., CVPR 2013, section 3.1. A normal that the cloud lacks is that of the plane through the points up to
/// two voxels away; where these lie on a line, it points to the viewpoint. Points that are not finite, and with a
/// single camera those behind it, are in no voxel.
/// @return an error of the cloud or the config; invalid_argument for a point farther than a million voxels.
/// O(points). The thread count never changes a bit of the result.
[[nodiscard]] Result<VoxelCloud> voxelise(const PointCloud& cloud, const VoxelCloudConfig& config,
                                          const Executor& executor);

}  // namespace saccade
