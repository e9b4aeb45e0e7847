// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/tiles.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "server/annotate/display_order.hpp"

namespace saccade::server {
namespace {

constexpr std::size_t kMostNodes{4096};  // in one list

Error bad_list(const char* key, const std::string& what) {
  return {Errc::invalid_argument, std::string{key} + what, key};
}

/// Returns the nodes with the squared distances of their cubes from a place, the nearest first.
std::vector<std::pair<double, std::uint32_t>> nodes_by_distance(const PointOctree& tree,
                                                                const Eigen::Vector3f& here_m) {
  std::vector<std::pair<double, std::uint32_t>> nodes;
  for (const PointOctree::Node& node : tree.nodes()) {
    const double edge_m = std::ldexp(tree.edge_m(), -static_cast<int>(node.level));
    const Eigen::Vector3d least_m = tree.origin_m() + edge_m * Eigen::Vector3d(node.x, node.y, node.z);
    const Eigen::AlignedBox3d cube{least_m, least_m + Eigen::Vector3d::Constant(edge_m)};
    nodes.emplace_back(cube.squaredExteriorDistance(here_m.cast<double>()), static_cast<std::uint32_t>(nodes.size()));
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

double Tiles::typical_spacing_m(std::span<const Eigen::Vector3f> positions_m, const Executor& executor) const {
  constexpr std::size_t kSamples{48};
  const std::span<const std::uint32_t> order = tree_.order();
  std::vector<float> distances_m2(std::min(kSamples, order.size()));
  executor.parallel_for(distances_m2.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t sample = begin; sample < end; ++sample) {
      const Eigen::Vector3f& here_m = positions_m[order[order.size() / distances_m2.size() * sample]];
      FourNearest nearest;
      for (const auto& [distance_m2, node] : nodes_by_distance(tree_, here_m)) {
        if (distance_m2 > static_cast<double>(nearest.fourth_m2())) break;
        for (const std::uint32_t point : points_of(node)) nearest.add((positions_m[point] - here_m).squaredNorm());
      }
      distances_m2[sample] = nearest.fourth_m2();
    }
  });
  return distances_m2.empty() ? 0.0 : median_distance_m(distances_m2);
}

std::vector<bool> Tiles::table_of(const HeldTiles& held) const {
  std::vector<bool> table(tree_.nodes().size(), false);
  for (const std::uint32_t node : held) table[node] = true;
  return table;
}

std::vector<std::uint32_t> Tiles::points_of(const HeldTiles& held) const {
  std::vector<std::uint32_t> points;
  for (const std::uint32_t node : held) {
    const std::span<const std::uint32_t> of_node = points_of(node);
    points.insert(points.end(), of_node.begin(), of_node.end());
  }
  return points;
}

Result<std::vector<std::uint32_t>> node_list(const nlohmann::json& head, const char* key, const Tiles& tiles,
                                             std::size_t most) {
  std::vector<std::uint32_t> nodes;
  const auto list = head.find(key);
  if (list == head.end()) return nodes;
  const std::size_t there = tiles.tree().nodes().size();
  const bool is_list = list->is_array() && list->size() <= most;
  if (!is_list) return bad_list(key, " is a list of at most " + std::to_string(most) + " nodes");
  std::set<std::uint32_t> known;
  for (const auto& node : *list) {
    const bool fits = node.is_number_unsigned() && node.get<std::uint64_t>() < there;
    if (!fits) return bad_list(key, " is a list of nodes, 0 to " + std::to_string(there - 1));
    nodes.push_back(node.get<std::uint32_t>());
    if (!known.insert(nodes.back()).second) return bad_list(key, " names a node twice");
  }
  return nodes;
}

Result<std::vector<std::uint32_t>> asked_points(const nlohmann::json& head, const Tiles& tiles,
                                                std::size_t most_points) {
  SACCADE_TRY(const std::vector<std::uint32_t> nodes, node_list(head, "nodes", tiles, kMostNodes));
  std::vector<std::uint32_t> points;
  for (const std::uint32_t node : nodes) {
    const std::span<const std::uint32_t> of_node = tiles.points_of(node);
    if (points.size() + of_node.size() > most_points) {
      return bad_list("nodes", " may have " + std::to_string(most_points) + " points together");
    }
    points.insert(points.end(), of_node.begin(), of_node.end());
  }
  return points;
}

Status update_held(HeldTiles& held, const nlohmann::json& head, const Tiles& tiles, std::size_t most_points) {
  SACCADE_TRY(const std::vector<std::uint32_t> dropped, node_list(head, "drop", tiles, tiles.tree().nodes().size()));
  SACCADE_TRY(const std::vector<std::uint32_t> added, node_list(head, "nodes", tiles, kMostNodes));
  HeldTiles next = held;
  for (const std::uint32_t node : dropped) next.erase(node);
  next.insert(added.begin(), added.end());
  std::size_t points{0};
  for (const std::uint32_t node : next) points += tiles.points_of(node).size();
  if (points > most_points) {
    return bad_list("nodes", ": with these the page would hold " + std::to_string(points) + " points, more than the " +
                                 std::to_string(most_points) + " of its budget; drop others");
  }
  held = std::move(next);
  return {};
}

}  // namespace saccade::server
