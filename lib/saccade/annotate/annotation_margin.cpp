// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/annotation_margin.hpp"

#include <algorithm>

#include "saccade/annotate/internal/path_buckets.hpp"

namespace saccade {
namespace {

/// Label and path of a node in the forest.
struct Owned {
  std::uint32_t label{kNoLabel};
  std::uint32_t path{kPathUnits};
};

std::vector<Owned> owned_nodes(const ShortestPathForest& forest, std::span<const std::uint32_t> label_of_point) {
  const Neighbourhood& graph = forest.neighbourhood();
  std::vector<Owned> owned(graph.size());
  for (std::uint32_t point = 0; point < owned.size(); ++point) {
    const std::optional<std::uint32_t> root = forest.root_of(point);
    if (root) owned[graph.node_of(point)] = {label_of_point[*root], forest.path_units(point)};
  }
  return owned;
}

/// Returns the length of the shortest path into a node's region that ends there: from a neighbour with another label.
std::uint32_t entering(const Neighbourhood& graph, const std::vector<Owned>& owned, std::uint32_t node) {
  std::uint32_t best{kPathUnits};
  for (const Neighbourhood::Edge& edge : graph.edges(node)) {
    const Owned& beyond = owned[edge.node];
    if (beyond.label != owned[node].label) best = std::min(best, beyond.path + edge.cost);
  }
  return best;
}

}  // namespace

LabelPaths label_paths(const ShortestPathForest& forest, std::span<const std::uint32_t> label_of_root) {
  const Neighbourhood& graph = forest.neighbourhood();
  const std::vector<Root> roots = forest.roots();
  SACCADE_EXPECTS(roots.size() == label_of_root.size());
  SACCADE_EXPECTS(std::find(label_of_root.begin(), label_of_root.end(), kNoLabel) == label_of_root.end());
  LabelPaths paths;
  paths.own.assign(graph.size(), kNoLabel);  // labels of roots, at first
  for (std::size_t i = 0; i < roots.size(); ++i) paths.own[roots[i].point] = label_of_root[i];
  const std::vector<Owned> owned = owned_nodes(forest, paths.own);
  std::vector<std::uint32_t> other(graph.size(), kPathUnits);  // per node
  PathBuckets queue{graph};
  for (std::uint32_t node = 0; node < other.size(); ++node) {
    if (owned[node].label != kNoLabel) other[node] = entering(graph, owned, node);
  }
  for (std::size_t i = 0; i < roots.size(); ++i) {  // roots that another label covers
    const std::uint32_t node = graph.node_of(roots[i].point);
    if (owned[node].label != label_of_root[i]) other[node] = std::min(other[node], forest.start_units(roots[i].point));
  }
  for (std::uint32_t node = 0; node < other.size(); ++node) {
    if (other[node] < kPathUnits) queue.push(other[node], node);
  }
  queue.drain([&](std::uint32_t path, std::uint32_t node) {
    if (other[node] != path) return;  // a shorter path came in between
    for (const Neighbourhood::Edge& edge : graph.edges(node)) {
      const std::uint32_t further = path + edge.cost;
      if (further >= other[edge.node] || owned[edge.node].label != owned[node].label) continue;
      other[edge.node] = further;
      queue.push(further, edge.node);
    }
  });
  paths.other.resize(graph.size());
  for (std::uint32_t node = 0; node < other.size(); ++node) {
    const std::uint32_t point = graph.point_of(node);
    paths.own[point] = owned[node].path;
    paths.other[point] = other[node];
  }
  return paths;
}

std::vector<float> label_margins(const Annotation& annotation) {
  std::vector<std::uint32_t> labels;  // in the order of points, as the forest's roots
  for (const ControlPoint& control : annotation.control_points()) labels.push_back(control.label);
  const LabelPaths paths = label_paths(annotation.forest(), labels);
  std::vector<float> margins(paths.own.size());
  for (std::uint32_t point = 0; point < margins.size(); ++point) {
    const bool is_painted = annotation.painted(point) != kNoLabel || annotation.locked(point) != kNoLabel;
    margins[point] = is_painted ? 1.0F : label_margin(paths.own[point], paths.other[point]);
  }
  return margins;
}

}  // namespace saccade
