// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tiles: a large cloud as nodes of an octree, of which a page holds those that it looks at.

#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <vector>

#include "saccade/cloud/point_octree.hpp"
#include "saccade/core/result.hpp"

namespace saccade::server {

/// Nodes that a page holds.
using HeldTiles = std::set<std::uint32_t>;

/// Octree of a cloud, with the node of each point. 8 bytes per point.
class Tiles {
 public:
  Tiles(std::span<const Eigen::Vector3f> positions_m, const Executor& executor)
      : tree_{positions_m, {}, executor}, node_of_{tree_.nodes_of_points(positions_m.size(), executor)} {}

  [[nodiscard]] const PointOctree& tree() const { return tree_; }
  [[nodiscard]] std::span<const std::uint32_t> points_of(std::uint32_t node) const {
    return tree_.points(tree_.nodes()[node]);
  }
  [[nodiscard]] std::uint32_t node_of(std::uint32_t point) const { return node_of_[point]; }
  /// Returns the median distance to the fourth nearest neighbour over some points, as typical_spacing_m.
  [[nodiscard]] double typical_spacing_m(std::span<const Eigen::Vector3f> positions_m, const Executor& executor) const;
  /// Returns a table that tells for each node whether it is held.
  [[nodiscard]] std::vector<bool> table_of(const HeldTiles& held) const;
  /// Returns the points of all these nodes, node by node.
  [[nodiscard]] std::vector<std::uint32_t> points_of(const HeldTiles& held) const;

 private:
  PointOctree tree_;
  std::vector<std::uint32_t> node_of_;
};

/// Reads a list of different nodes from the head.
/// @return invalid_argument unless it is a list of nodes, at most `most` of them.
[[nodiscard]] Result<std::vector<std::uint32_t>> node_list(const nlohmann::json& head, const char* key,
                                                           const Tiles& tiles, std::size_t most);
/// Returns the points of the nodes in `nodes`, in the order of the list.
/// @return errors of node_list; invalid_argument where they are more than `most_points`.
[[nodiscard]] Result<std::vector<std::uint32_t>> asked_points(const nlohmann::json& head, const Tiles& tiles,
                                                              std::size_t most_points);
/// Replaces what a page holds: without the nodes in `drop`, and with those in `nodes`.
/// @return errors of node_list; invalid_argument where it would hold more than `most_points`. Then nothing changes.
[[nodiscard]] Status update_held(HeldTiles& held, const nlohmann::json& head, const Tiles& tiles,
                                 std::size_t most_points);

}  // namespace saccade::server
