// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelDifference, SupervoxelGrowth: seeds, and their growth from voxel to voxel; the part of VCCS that clouds and maps
// share.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/segment/lccp.hpp"

namespace saccade {

/// Papon et al., CVPR 2013, section 3.3, with the weights of a config.
class VoxelDifference {
 public:
  VoxelDifference(const SupervoxelConfig& config, double seed_spacing_m)
      : spatial_{static_cast<float>(config.spatial_weight / seed_spacing_m)},
        normal_{static_cast<float>(config.normal_weight)},
        color_{static_cast<float>(config.color_weight)} {}

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

/// Borrows the cloud. Where a voxel ends up depends on nothing farther from it than the seeds' reach and the cells of
/// those seeds, and on no number but the order of cells and of neighbours.
class SupervoxelGrowth {
 public:
  SupervoxelGrowth(const VoxelCloud& cloud, const VoxelDifference& difference)
      : cloud_{cloud}, difference_{difference} {}

  /// In each cell the voxel nearest to the mean of those in it, moved to the least change of normals and colours within
  /// the radius; none where fewer than `fewest` voxels lie there. Of two seeds at one voxel the one of the lower cell
  /// stays.
  void seed(std::span<const std::uint32_t> cell_of, std::size_t cells, double radius, double fewest,
            const Executor& executor);

  struct Grown {
    std::vector<std::uint32_t> labels;  ///< per voxel: a seed; kUnlabelled: none came there
    std::vector<std::uint32_t> seeds;   ///< voxels, in the order of their cells
  };
  /// As many steps from voxel to voxel, among those that are not `outside` (one flag per voxel, or none: all). A seed
  /// outside does not grow. One thread.
  [[nodiscard]] Grown grow(double steps, std::span<const std::uint8_t> outside = {});

  /// What has grown is to grow anew: from the means of its voxels' places, normals and colours, and from the voxel
  /// nearest to the mean place.
  void move_to_means(const Grown& grown);

 private:
  [[nodiscard]] float gradient(std::uint32_t voxel) const;
  [[nodiscard]] std::vector<std::uint32_t> voxels_nearest_to_means(std::span<const std::uint32_t> cell_of,
                                                                   std::size_t cells) const;
  void voxels_around(std::uint32_t centre, double radius, std::vector<std::uint32_t>& around,
                     std::vector<bool>& met) const;
  void step();

  static constexpr float kOutside{-1.0F};
  const VoxelCloud& cloud_;
  VoxelDifference difference_;
  Grown grown_;
  std::vector<CloudVoxel> centres_;     ///< of supervoxels, from which voxels differ; at first their seeds
  std::vector<float> distances_;        ///< from the centre of the label; of those outside kOutside
  std::vector<std::uint32_t> changed_;  ///< in the last step
  std::vector<std::uint8_t> is_changed_;
};

}  // namespace saccade
