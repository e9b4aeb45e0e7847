// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/annotation_margin.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/click_start.hpp"
#include "saccade/annotate/internal/path_buckets.hpp"

namespace saccade {
namespace {

constexpr std::size_t kMostCandidates{16};
/// Limit of trials, in multiples of the number of points taken; the first trials take the most.
constexpr std::size_t kMostTaken{4};
/// Share of all doubt that the candidates' points carry.
constexpr double kDoubtShare{0.5};

/// Returns the doubt of points that could be settled, 0 for others.
std::vector<float> doubts(const Annotation& annotation, std::span<const float> margins) {
  const Neighbourhood& graph = annotation.forest().neighbourhood();
  std::vector<float> doubts(margins.size(), 0.0F);
  for (std::uint32_t point = 0; point < doubts.size(); ++point) {
    const bool is_fixed = annotation.painted(point) != kNoLabel || annotation.locked(point) != kNoLabel;
    if (is_fixed || graph.edges(graph.node_of(point)).empty()) continue;
    doubts[point] = 1.0F - margins[point];
  }
  return doubts;
}

/// Returns connected regions of the most doubtful points, which carry a share of all doubt; the most doubtful regions
/// first.
std::vector<ErrorRegion> doubtful_regions(const Neighbourhood& graph, const std::vector<float>& doubts) {
  constexpr std::size_t kLevels{1024};
  std::vector<double> sums(kLevels + 1, 0.0);  // by doubt
  const auto level = [](float doubt) { return static_cast<std::size_t>(doubt * static_cast<float>(kLevels)); };
  double left{0.0};
  for (const float doubt : doubts) {
    sums[level(doubt)] += static_cast<double>(doubt);
    left += static_cast<double>(doubt);
  }
  left *= kDoubtShare;
  std::size_t least = kLevels;
  for (left -= sums[least]; left > 0.0 && least > 0; left -= sums[least]) --least;
  std::vector<std::uint32_t> wanted(doubts.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = doubts[i] > 0.0F && level(doubts[i]) >= least ? 1 : 0;
  const std::vector<std::uint32_t> none(doubts.size(), 0);
  std::vector<ErrorRegion> regions = error_regions(graph, none, wanted).value();
  std::vector<std::pair<double, std::size_t>> order;  // by doubt, the most first
  for (std::size_t i = 0; i < regions.size(); ++i) {
    order.emplace_back(0.0, i);
    for (const std::uint32_t point : regions[i].points) order.back().first -= static_cast<double>(doubts[point]);
  }
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), kMostCandidates));
  std::vector<ErrorRegion> first;
  for (const auto& [doubt, i] : order) first.push_back(std::move(regions[i]));
  return first;
}

/// Trial of Algorithm 8 from one more root, without changing the forest.
class Trials {
 public:
  Trials(const ShortestPathForest& forest, std::span<const float> doubts)
      : forest_{forest}, graph_{forest.neighbourhood()}, queue_{graph_}, nodes_(doubts.size()) {
    for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
      const std::uint32_t point = graph_.point_of(node);
      const std::uint32_t own = forest.path_units(point);
      nodes_[node] = {own, own, weight(doubts[point])};
    }
  }

  double gain(std::uint32_t point) {
    taken_.clear();
    reach(start(point), graph_.node_of(point));
    queue_.drain([&](std::uint32_t path, std::uint32_t node) {
      if (nodes_[node].path != path) return;  // a shorter path came in between
      for (const Neighbourhood::Edge& edge : graph_.edges(node)) {
        if (path + edge.cost < nodes_[edge.node].path) reach(path + edge.cost, edge.node);
      }
    });
    double sum{0.0};
    for (const std::uint32_t node : taken_) {
      Node& taken = nodes_[node];
      sum += static_cast<double>(taken.weight) * (1.0 - static_cast<double>(taken.path) / taken.own);
      taken.path = taken.own;
    }
    taken_points_ += taken_.size();
    return sum;
  }

  /// Returns the number of points taken by all trials.
  [[nodiscard]] std::size_t taken_points() const { return taken_points_; }

 private:
  struct Node {
    std::uint32_t own;
    std::uint32_t path;  ///< with the new root
    float weight;
  };

  /// Returns d⁸.
  static float weight(float doubt) {
    const float squared = doubt * doubt;
    return squared * squared * squared * squared;
  }

  /// Returns where the path of a click begins, as guarded_click has it for a label with other control points.
  [[nodiscard]] std::uint32_t start(std::uint32_t point) const {
    if (!graph_.config().strong_borders) return 0;
    const double unit = graph_.config().max_path / kPathUnits;
    return static_cast<std::uint32_t>(std::lround(click_start(forest_, point) / unit));
  }

  void reach(std::uint32_t path, std::uint32_t node) {
    Node& reached = nodes_[node];
    if (path >= reached.path) return;
    if (reached.path == reached.own) taken_.push_back(node);
    reached.path = path;
    queue_.push(path, node);
  }

  const ShortestPathForest& forest_;
  const Neighbourhood& graph_;
  PathBuckets queue_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> taken_;
  std::size_t taken_points_{0};
};

}  // namespace

std::optional<BestClick> next_best_click(const Annotation& annotation, std::span<const float> margins,
                                         std::span<const std::uint8_t> ends) {
  const ShortestPathForest& forest = annotation.forest();
  const Neighbourhood& graph = forest.neighbourhood();
  SACCADE_EXPECTS(margins.size() == graph.size() && (ends.empty() || ends.size() == graph.size()));
  const std::vector<float> doubt = doubts(annotation, margins);
  const std::vector<ErrorRegion> regions = doubtful_regions(graph, doubt);
  Trials trials{forest, doubt};
  std::optional<BestClick> best;
  for (const std::uint32_t centre : region_centres(graph, ends, regions)) {
    const double gain = trials.gain(centre);
    if (gain > (best ? best->gain : 0.0)) best = BestClick{centre, annotation.label_of(centre), gain};
    if (trials.taken_points() > kMostTaken * graph.size()) break;
  }
  return best;
}

double click_gain(const Annotation& annotation, std::span<const float> margins, std::uint32_t point) {
  SACCADE_EXPECTS(margins.size() == annotation.labels().size() && point < margins.size());
  const std::vector<float> doubt = doubts(annotation, margins);
  return Trials{annotation.forest(), doubt}.gain(point);
}

}  // namespace saccade
