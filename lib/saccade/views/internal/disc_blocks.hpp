// SPDX-License-Identifier: Apache-2.0
#pragma once
// thinned_discs: fewer, larger discs that hide about the same. DiscBlocks: discs by place, of which those in a cone are
// found quickly. ViewCone.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Returns for each cell of cell_m the heaviest disc, ties by the smallest id, enlarged to the ball around a cell if it
/// is smaller. Discs lighter than min_weight are left out. In the order of cells. O(n log n).
[[nodiscard]] std::vector<SurfelDisc> thinned_discs(const SurfelMap& surfels, double min_weight, double cell_m);

/// Cone from a place around directions, with a largest distance.
struct ViewCone {
  Eigen::Vector3f apex_m;
  Eigen::Vector3f axis;
  float half_angle_rad;
  float reach_m;

  /// Returns the cone that holds all points, at least one, widened by an angle.
  [[nodiscard]] static ViewCone around(const Eigen::Vector3f& apex_m, std::span<const Eigen::Vector3f> points_m,
                                       float margin_rad);
  /// Tells whether a ball lies outside.
  [[nodiscard]] bool misses(const Eigen::Vector3f& middle_m, float radius_m) const;
};

/// Discs in blocks of space. Immutable.
class DiscBlocks {
 public:
  DiscBlocks() = default;
  DiscBlocks(std::vector<SurfelDisc> discs, double block_m);

  /// Calls visit(span of discs) for each block that a cone meets.
  template <class Visit>
  void for_each_in(const ViewCone& cone, const Visit& visit) const {
    for (const Block& block : blocks_) {
      if (!cone.misses(block.middle_m, block.radius_m))
        visit(std::span<const SurfelDisc>{discs_}.subspan(block.begin, block.count));
    }
  }
  [[nodiscard]] std::span<const SurfelDisc> discs() const { return discs_; }

 private:
  struct Block {
    std::size_t begin;
    std::size_t count;
    Eigen::Vector3f middle_m;
    float radius_m;  ///< radius of a ball around its discs
  };
  std::vector<SurfelDisc> discs_;
  std::vector<Block> blocks_;
};

}  // namespace saccade
