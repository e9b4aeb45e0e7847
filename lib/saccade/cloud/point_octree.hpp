// SPDX-License-Identifier: Apache-2.0
#pragma once
// PointOctree: levels of detail of a large cloud. Each point is in one node; nodes nearer to the root are coarser.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"

namespace saccade {

struct PointOctreeConfig {
  std::size_t leaf_points{20'000};  ///< a cube with at most as many points is not divided; 1 to kMostNodePoints
};

/// Octree in the layout of Potree and COPC: a node holds a sample of the points in its cube, and its descendants hold
/// the others. A node and its ancestors together show its cube, with the detail of the node's level.
///
/// A divided node takes one point of each cell of a grid over its cube, 128 cells along an edge, or the finest of 64
/// and 32 where these would be more than kMostNodePoints. Coincident points are divided no further than kMostLevels:
/// what is left there fills several nodes with one cube, each the child of the one before.
class PointOctree {
 public:
  static constexpr std::size_t kMostNodePoints{65'536};
  static constexpr std::uint32_t kMostLevels{14};
  static constexpr std::uint32_t kNoNode{std::numeric_limits<std::uint32_t>::max()};

  struct Node {
    std::uint32_t parent{kNoNode};  ///< an earlier node; kNoNode: the root
    std::uint32_t level{0};
    std::uint32_t x{0};  ///< place of its cube among the 2^level cubes along each edge of the root's
    std::uint32_t y{0};
    std::uint32_t z{0};
    std::uint32_t count{0};  ///< points
    float spacing_m{0.0F};   ///< edge of the grid's cells; 0: it holds all remaining points of its cube
    std::uint32_t first{0};  ///< first of its points in the order
  };

  /// Builds the tree over the finite points. The thread count never changes a bit of the result.
  /// O(n log n); 32 bytes per point while it works, 4 after.
  PointOctree(std::span<const Eigen::Vector3f> positions_m, const PointOctreeConfig& config, const Executor& executor);

  /// Returns nodes level by level, the root first; none for a cloud without finite points.
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// Returns the points of a node in ascending order of their numbers.
  [[nodiscard]] std::span<const std::uint32_t> points(const Node& node) const {
    return std::span{order_}.subspan(node.first, node.count);
  }
  /// Returns all finite points, node by node.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }
  [[nodiscard]] const Eigen::Vector3d& origin_m() const { return origin_m_; }  ///< least corner of the root's cube
  [[nodiscard]] double edge_m() const { return edge_m_; }                      ///< edge of the root's cube
  /// Returns the node of each of `points` points; kNoNode for points that are not finite. 4 bytes per point.
  [[nodiscard]] std::vector<std::uint32_t> nodes_of_points(std::size_t points, const Executor& executor) const;

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  Eigen::Vector3d origin_m_{0.0, 0.0, 0.0};
  double edge_m_{0.0};
};

}  // namespace saccade
