// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelDifference: how far a voxel is from a seed, for the growth of supervoxels.

#include "saccade/segment/supervoxels.hpp"

namespace saccade {

/// Papon et al., CVPR 2013, section 3.3, with the weights of a config.
class VoxelDifference {
 public:
  explicit VoxelDifference(const SupervoxelConfig& config, double seed_spacing_m)
      : spatial_{static_cast<float>(config.spatial_weight / seed_spacing_m)},
        normal_{static_cast<float>(config.normal_weight)},
        color_{static_cast<float>(config.color_weight)} {}
  explicit VoxelDifference(const SupervoxelConfig& config) : VoxelDifference{config, config.seed_spacing_m} {}

  /// Of normals and colours.
  [[nodiscard]] float of_surfaces(const CloudVoxel& a, const CloudVoxel& b) const {
    float sum = normal_ * (1.0F - a.normal.dot(b.normal));
    if (color_ > 0.0F) sum += color_ * (a.color - b.color).norm();
    return sum;
  }
  /// Of these and of places.
  [[nodiscard]] float of(const CloudVoxel& a, const CloudVoxel& b) const {
    return spatial_ * (a.place - b.place).norm() + of_surfaces(a, b);
  }

 private:
  float spatial_, normal_, color_;
};

}  // namespace saccade
