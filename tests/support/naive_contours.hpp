// SPDX-License-Identifier: Apache-2.0
#pragma once
// NaiveContours: contour voxels as eq. 3.2, 3.5 and 3.6 are written, voxel by voxel; the reference for contour_voxels.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "saccade/views/contours.hpp"

namespace saccade::test {

class NaiveContours {
 public:
  /// The map must outlive it.
  NaiveContours(const TsdfSnapshot& map, int known_weight) : map_{&map}, known_weight_{known_weight} {}

  /// Looks at the empty voxels around every occupied one.
  [[nodiscard]] std::vector<ContourVoxel> all() const {
    std::vector<Index3> candidates;
    for (const Index3& sector : map_->grid.sorted_sectors()) {
      for (int i = 0; i < kSectorBricks; ++i) {
        const Index3 brick = sector * kSectorEdge + child_offset(i);
        map_->grid.find(sector)->bricks[static_cast<std::size_t>(i)].occupied_mask().for_each(
            [&](std::size_t k) { add_around(brick * kBrickEdge + child_offset(static_cast<int>(k)), candidates); });
      }
    }
    std::sort(candidates.begin(), candidates.end(), before);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    std::vector<ContourVoxel> found;
    for (const Index3& e : candidates) {
      if (!is_contour(e)) continue;
      const Eigen::Vector3d n = frontier_normal(e);
      if (n.norm() > 0.0) found.push_back({e, n.normalized().cast<float>()});
    }
    return found;
  }

 private:
  static std::array<Index3, 27> around(const Index3& voxel) {
    std::array<Index3, 27> all;
    for (int i = 0; i < 27; ++i) {
      all[static_cast<std::size_t>(i)] = voxel + Index3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    }
    return all;
  }
  static int squared_distance(const Index3& a, const Index3& b) {
    const Index3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z;
  }
  static int order(const Index3& a, const Index3& b) {
    if (a == b) return 0;
    return zyx_less(a, b) ? -1 : 1;
  }
  /// By sector, brick, voxel.
  static bool before(const Index3& a, const Index3& b) {
    if (const int by = order(parent(parent(a)), parent(parent(b))); by != 0) return by < 0;
    if (const int by = order(parent(a), parent(b)); by != 0) return by < 0;
    return order(a, b) < 0;
  }
  void add_around(const Index3& o, std::vector<Index3>& candidates) const {
    for (const Index3& e : around(o)) {
      if (squared_distance(e, o) <= 2 && is_empty(e)) candidates.push_back(e);
    }
  }

  [[nodiscard]] Voxel at(const Index3& i) const { return map_->grid.voxel(i); }
  [[nodiscard]] bool inside(const Index3& i) const {
    const auto& workspace = map_->config.workspace;
    return !workspace || contains(*workspace, voxel_center(i, map_->config.voxel_size_m));
  }
  [[nodiscard]] bool is_empty(const Index3& i) const { return at(i).w >= known_weight_ && at(i).v > 0 && inside(i); }
  [[nodiscard]] bool is_unknown(const Index3& i) const { return at(i).w < known_weight_ && inside(i); }
  [[nodiscard]] bool is_occupied(const Index3& i) const { return at(i).w >= known_weight_ && at(i).v <= 0; }

  [[nodiscard]] bool is_contour(const Index3& e) const {
    bool frontier{false};
    bool surface{false};
    for (const Index3& c : around(e)) {
      frontier = frontier || (squared_distance(c, e) == 1 && is_unknown(c));
      surface = surface || (squared_distance(c, e) <= 2 && is_occupied(c));
    }
    return frontier && surface;
  }

  [[nodiscard]] double modified_weight(const Index3& c) const {
    const Voxel voxel = at(c);
    if (is_occupied(c)) return -known_weight_;
    if (voxel.w < known_weight_) return inside(c) ? voxel.w - known_weight_ : 0.0;
    if (voxel.v == kTsdfOne && voxel.w == map_->config.free_weight) return known_weight_;
    return std::min(voxel.w - known_weight_, known_weight_);
  }

  /// Before normalising. Added up by the length of the steps, so that the sums are exact.
  [[nodiscard]] Eigen::Vector3d frontier_normal(const Index3& e) const {
    std::array<Eigen::Vector3d, 4> sums;
    sums.fill(Eigen::Vector3d::Zero());
    for (const Index3& c : around(e)) {
      const Index3 step = c - e;
      sums[static_cast<std::size_t>(squared_distance(c, e))] +=
          modified_weight(c) * Eigen::Vector3d{Eigen::Vector3i{step.x, step.y, step.z}.cast<double>()};
    }
    return sums[1] + sums[2] / std::sqrt(2.0) + sums[3] / std::sqrt(3.0);
  }

  const TsdfSnapshot* map_;
  int known_weight_;
};

}  // namespace saccade::test
