// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelDifference, SupervoxelGrowth: seeds, and their growth from voxel to voxel; the part of VCCS that is common to
// clouds and maps.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/segment/lccp.hpp"

namespace saccade {

/// Difference of voxels by Papon et al., CVPR 2013, section 3.3, with the weights of a config.
class VoxelDifference {
 public:
  explicit VoxelDifference(const SupervoxelConfig& config)
      : spatial_{static_cast<float>(config.spatial_weight / config.seed_spacing_m)},
        normal_{static_cast<float>(config.normal_weight)},
        color_{static_cast<float>(config.color_weight)},
        opposite_is_alike_{config.opposite_is_alike} {}

  /// Returns the difference in normals and colours.
  [[nodiscard]] float of_surfaces(const CloudVoxel& a, const CloudVoxel& b) const {
    const float cosine = a.normal.dot(b.normal);
    float sum = normal_ * (1.0F - (opposite_is_alike_ ? std::abs(cosine) : cosine));
    if (color_ > 0.0F) sum += color_ * (a.color - b.color).norm();
    return sum;
  }
  /// Returns the difference in normals, colours and positions.
  [[nodiscard]] float of(const CloudVoxel& a, const CloudVoxel& b) const {
    return spatial_ * (a.place - b.place).norm() + of_surfaces(a, b);
  }

 private:
  float spatial_, normal_, color_;
  bool opposite_is_alike_;
};

/// Growth of supervoxels. Borrows the cloud. A voxel's label depends only on voxels and seeds within the seeds' reach
/// and the cells of those seeds, and on the order of cells and of neighbours.
class SupervoxelGrowth {
 public:
  SupervoxelGrowth(const VoxelCloud& cloud, const SupervoxelConfig& config)
      : cloud_{cloud},
        difference_{config},
        seeds_settle_{config.seeds_settle},
        moves_in_growth_{config.moves_in_growth} {}

  /// Places seeds: in each cell the voxel nearest to the mean of its voxels, moved to the smallest change of normals
  /// and colours within the radius if seeds settle. Cells with fewer than `fewest` voxels within the radius get none.
  /// Of two seeds at one voxel, that of the lower cell stays.
  void seed(std::span<const std::uint32_t> cell_of, std::size_t cells, double radius, double fewest,
            const Executor& executor);

  struct Grown {
    std::vector<std::uint32_t> labels;  ///< per voxel: a seed; kUnlabelled where none arrived
    std::vector<std::uint32_t> seeds;   ///< seed voxels, in the order of their cells
  };
  /// Grows for a number of steps from voxel to voxel, among those that are not `outside` (one flag per voxel, or empty:
  /// all). A seed outside does not grow. One thread.
  [[nodiscard]] Grown grow(double steps, std::span<const std::uint8_t> outside = {});

  /// Restarts growth from the means of the voxels' positions, normals and colours, and from the voxel nearest to the
  /// mean position.
  void move_to_means(const Grown& grown);

 private:
  [[nodiscard]] float gradient(std::uint32_t voxel) const;
  [[nodiscard]] std::vector<std::uint32_t> voxels_nearest_to_means(std::span<const std::uint32_t> cell_of,
                                                                   std::size_t cells) const;
  void voxels_around(std::uint32_t centre, double radius, std::vector<std::uint32_t>& around,
                     std::vector<bool>& met) const;
  void step();
  void recenter();

  static constexpr float kOutside{-1.0F};
  const VoxelCloud& cloud_;
  VoxelDifference difference_;
  bool seeds_settle_;
  bool moves_in_growth_;
  Grown grown_;
  std::vector<CloudVoxel> centres_;     ///< centres of supervoxels, to which voxels are compared; at first their seeds
  std::vector<float> distances_;        ///< distance from the label's centre; kOutside for voxels outside
  std::vector<std::uint32_t> changed_;  ///< voxels changed in the last step
  std::vector<std::uint8_t> is_changed_;
};

}  // namespace saccade
