// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/click_start.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace saccade {
namespace {

/// Width of a border: normals are estimated over two rounds of neighbours, so that a fold is about four edges wide.
constexpr std::size_t kBorderEdges{4};

/// Steps from a node back to its root along the shortest path.
class WayBack {
 public:
  WayBack(const ShortestPathForest& forest, std::uint32_t root) : forest_{forest}, root_{root} {}

  /// Returns the node before this one, by the first edge that the shortest path may have come along; nullopt at the
  /// root. Points at the same place (edges of cost 0) count as one.
  [[nodiscard]] std::optional<std::uint32_t> before(std::uint32_t node) const {
    const Neighbourhood& graph = forest_.neighbourhood();
    const std::uint32_t path = path_of(node);
    std::vector<std::uint32_t> same{node};
    for (std::size_t i = 0; i < same.size(); ++i) {
      if (graph.point_of(same[i]) == root_) return std::nullopt;
      for (const Neighbourhood::Edge& edge : graph.edges(same[i])) {
        if (!belongs(edge.node) || path_of(edge.node) + edge.cost != path) continue;
        if (edge.cost > 0) return edge.node;
        if (std::find(same.begin(), same.end(), edge.node) == same.end()) same.push_back(edge.node);
      }
    }
    return std::nullopt;
  }
  [[nodiscard]] std::uint32_t path_of(std::uint32_t node) const {
    return forest_.path_units(forest_.neighbourhood().point_of(node));
  }

 private:
  [[nodiscard]] bool belongs(std::uint32_t node) const {
    return forest_.root_of(forest_.neighbourhood().point_of(node)) == root_;
  }

  const ShortestPathForest& forest_;
  std::uint32_t root_;
};

}  // namespace

double click_start(const ShortestPathForest& forest, std::uint32_t point) {
  const std::optional<std::uint32_t> root = forest.root_of(point);
  if (!root) return 0.0;
  const WayBack way{forest, *root};
  std::vector<std::uint32_t> paths;  // from the point back to the root
  for (std::optional<std::uint32_t> node = forest.neighbourhood().node_of(point); node; node = way.before(*node)) {
    paths.push_back(way.path_of(*node));
  }
  std::uint32_t start = paths.back();
  std::uint32_t strongest{0};
  for (std::size_t i = 0; i + 1 < paths.size(); ++i) {
    const std::uint32_t before = paths[std::min(i + kBorderEdges, paths.size() - 1)];
    if (paths[i] - before <= strongest) continue;
    strongest = paths[i] - before;
    start = before;
  }
  const double unit = forest.neighbourhood().config().max_path / kPathUnits;
  return start * unit;
}

AnnotationAction guarded_click(const Annotation& annotation, AnnotationAction action) {
  auto* set = std::get_if<SetControlPoints>(&action.change);
  if (set == nullptr || set->points.size() != 1 || set->start_cost > 0.0) return action;
  const Neighbourhood& graph = annotation.forest().neighbourhood();
  if (!graph.config().strong_borders || set->points.front() >= graph.size()) return action;
  const std::vector<ControlPoint> others = annotation.control_points();
  const bool has_others = std::any_of(others.begin(), others.end(), [&](const ControlPoint& other) {
    return other.label == set->label && other.point != set->points.front();
  });
  if (has_others) set->start_cost = click_start(annotation.forest(), set->points.front());
  return action;
}

}  // namespace saccade
