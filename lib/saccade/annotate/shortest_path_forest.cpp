// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/shortest_path_forest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade {
namespace {

// A node's state is one number: ω above the root's point. That of a shorter path is less, at equal paths that of the
// lower root, and one path further along an edge is one addition: least states are all that Algorithm 8 looks for.
constexpr std::uint64_t kNoPath{std::numeric_limits<std::uint64_t>::max()};
constexpr std::uint64_t kTooFar{std::uint64_t{kPathUnits} << 32U};

std::uint32_t path_of(std::uint64_t state) { return static_cast<std::uint32_t>(state >> 32U); }
std::uint32_t root_of_state(std::uint64_t state) { return static_cast<std::uint32_t>(state); }
std::uint64_t along(std::uint64_t state, const Neighbourhood::Edge& edge) {
  return state + (std::uint64_t{edge.cost} << 32U);
}

}  // namespace

ShortestPathForest::ShortestPathForest(std::shared_ptr<const Neighbourhood> neighbourhood)
    : neighbourhood_{std::move(neighbourhood)},
      state_(neighbourhood_->size(), kNoPath),
      start_(neighbourhood_->size(), kNoPath),
      queue_{*neighbourhood_} {}

/// Algorithm 8.
template <class Visit>
void ShortestPathForest::spread(const Visit& visit) {
  queue_.drain([&](std::uint32_t path, std::uint32_t node) {
    const std::uint64_t state = state_[node];
    if (path_of(state) != path) return;  // a shorter path came in between
    visit(node);
    for (const Neighbourhood::Edge& edge : neighbourhood_->edges(node)) {
      const std::uint64_t further = along(state, edge);
      if (further < state_[edge.node] && further < kTooFar) reach(edge.node, further);
    }
  });
}

void ShortestPathForest::rebuild(std::span<const Root> roots) {
  touched_.clear();
  std::fill(state_.begin(), state_.end(), kNoPath);
  std::fill(start_.begin(), start_.end(), kNoPath);
  root_points_.clear();
  for (const Root& root : roots) start_at(root);
  spread([this](std::uint32_t node) { touched_.push_back(neighbourhood_->point_of(node)); });
}

void ShortestPathForest::add(const Root& root) {
  touched_.clear();
  start_at(root);
  spread([this](std::uint32_t node) { touched_.push_back(neighbourhood_->point_of(node)); });
}

void ShortestPathForest::remove(std::uint32_t point) {
  SACCADE_EXPECTS(is_root(point));
  touched_.clear();
  const std::uint32_t first = neighbourhood_->node_of(point);
  start_[first] = kNoPath;
  root_points_.erase(std::lower_bound(root_points_.begin(), root_points_.end(), point));
  if (root_of_state(state_[first]) != point || state_[first] == kNoPath) return;  // nothing was its own
  // Algorithm 9: the tree is cleared. It is connected: what belongs to a root is reached along what belongs to it.
  // Where other trees enter, or start in what this one had covered, Algorithm 8 goes on.
  cleared_.assign(1, first);
  entered_.clear();
  state_[first] = kNoPath;
  for (std::size_t i = 0; i < cleared_.size(); ++i) {
    const std::uint32_t node = cleared_[i];
    touched_.push_back(neighbourhood_->point_of(node));
    std::uint64_t best = start_[node];
    for (const Neighbourhood::Edge& edge : neighbourhood_->edges(node)) {
      std::uint64_t& beyond = state_[edge.node];
      if (beyond == kNoPath) continue;
      if (root_of_state(beyond) == point) {
        beyond = kNoPath;
        cleared_.push_back(edge.node);
        fetch_edges_soon(*neighbourhood_, edge.node);
      } else {
        best = std::min(best, along(beyond, edge));
      }
    }
    entered_.push_back(best);
  }
  for (std::size_t i = 0; i < cleared_.size(); ++i) {
    if (entered_[i] < kTooFar) reach(cleared_[i], entered_[i]);
  }
  spread([](std::uint32_t /*node*/) {});  // none but the cleared ones
}

std::vector<Root> ShortestPathForest::roots() const {
  std::vector<Root> roots;
  const double unit = neighbourhood_->config().max_path / kPathUnits;
  for (const std::uint32_t point : root_points_) {
    roots.push_back({point, path_of(start_[neighbourhood_->node_of(point)]) * unit});
  }
  return roots;
}

bool ShortestPathForest::is_root(std::uint32_t point) const {
  return point < state_.size() && start_[neighbourhood_->node_of(point)] != kNoPath;
}

std::optional<std::uint32_t> ShortestPathForest::root_of(std::uint32_t point) const {
  const std::uint64_t state = state_[neighbourhood_->node_of(point)];
  if (state == kNoPath) return std::nullopt;
  return root_of_state(state);
}

double ShortestPathForest::path_length(std::uint32_t point) const {
  const std::uint64_t state = state_[neighbourhood_->node_of(point)];
  if (state == kNoPath) return std::numeric_limits<double>::infinity();
  return path_of(state) * (neighbourhood_->config().max_path / kPathUnits);
}

void ShortestPathForest::start_at(const Root& root) {
  const double max_path = neighbourhood_->config().max_path;
  SACCADE_EXPECTS(root.point < state_.size() && !is_root(root.point));
  SACCADE_EXPECTS(root.start_cost >= 0.0 && root.start_cost < max_path);
  const auto units = static_cast<std::uint64_t>(root.start_cost / max_path * kPathUnits);
  const std::uint32_t node = neighbourhood_->node_of(root.point);
  start_[node] = std::min<std::uint64_t>(units, kPathUnits - 1) << 32U | root.point;
  root_points_.insert(std::upper_bound(root_points_.begin(), root_points_.end(), root.point), root.point);
  if (start_[node] < state_[node]) reach(node, start_[node]);
}

void ShortestPathForest::reach(std::uint32_t node, std::uint64_t state) {
  state_[node] = state;
  queue_.push(path_of(state), node);
  fetch_edges_soon(*neighbourhood_, node);
}

}  // namespace saccade
