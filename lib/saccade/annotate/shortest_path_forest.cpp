// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/shortest_path_forest.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "saccade/annotate/internal/parallel_spread.hpp"

namespace saccade {
namespace {

/// Nodes after which a search is shared among threads: visiting these takes as long as waking another thread.
constexpr std::size_t kNodesOfOneThread{4096};

}  // namespace

ShortestPathForest::ShortestPathForest(std::shared_ptr<const Neighbourhood> neighbourhood, const Executor& executor)
    : neighbourhood_{std::move(neighbourhood)},
      reach_(neighbourhood_->size(), kNoPath),
      is_start_(neighbourhood_->size(), false),
      queue_{PathBuckets{*neighbourhood_}},
      executor_{executor} {}

/// Inline, because a call took a tenth of the time.
[[gnu::always_inline]] inline void ShortestPathForest::reach(std::uint32_t node, PathReach reach, PathBuckets& queue) {
  reach_[node] = reach;
  queue.push(path_of(reach), node);
}

/// Runs Algorithm 8.
void ShortestPathForest::spread() {
  const std::size_t most = touched_.size() + kNodesOfOneThread;
  PathBuckets& queue = *queue_;
  const bool has_help = executor_.threads() > 1;
  const auto visit = [this, &queue](std::uint32_t path, std::uint32_t node) {
    const PathReach to_node = reach_[node];
    if (path_of(to_node) != path) return;  // a shorter path came in between
    touched_.push_back(node);
    for_nearer_neighbours(*neighbourhood_, reach_.data(), node, to_node,
                          [this, &queue](std::uint32_t next, PathReach along) { reach(next, along, queue); });
  };
  queue.drain(visit, [&] { return !has_help || touched_.size() < most; });
  if (queue.count() > 0) spread_in_parallel(*neighbourhood_, reach_, queue, executor_, touched_);
}

void ShortestPathForest::rebuild(std::span<const Root> roots) {
  touched_.clear();
  std::fill(reach_.begin(), reach_.end(), kNoPath);
  std::fill(is_start_.begin(), is_start_.end(), false);
  starts_.clear();
  for (const Root& root : roots) start_at(root);
  spread();
  name_touched();
}

void ShortestPathForest::add(const Root& root) {
  touched_.clear();
  start_at(root);
  spread();
  name_touched();
}

void ShortestPathForest::remove(std::uint32_t point) {
  SACCADE_EXPECTS(is_root(point));
  const std::uint32_t first = neighbourhood_->node_of(point);
  is_start_[first] = false;
  starts_.erase(start_of(point));
  touched_.clear();
  if (!belongs_to(first, point)) return;  // the root owned nothing
  // Algorithm 9: clears the tree. The tree is connected, because a root's points are reached through its points.
  // Algorithm 8 continues where other trees enter, or start within the cleared part.
  touched_.assign(1, first);
  entered_.clear();
  reach_[first] = kNoPath;
  bool is_cleared{false};
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    if (!is_cleared && is_large(touched_.size())) {
      clear_all_of(point);
      is_cleared = true;
      if (starts_.empty()) break;  // no tree is left to enter
    }
    entered_.push_back(clear_beside(touched_[i], point));
  }
  for (std::size_t i = 0; i < entered_.size(); ++i) {
    if (entered_[i] < kNoPath) reach(touched_[i], entered_[i], *queue_);
  }
  const std::size_t cleared = touched_.size();
  spread();
  touched_.resize(cleared);  // only the cleared ones
  name_touched();
}

bool ShortestPathForest::belongs_to(std::uint32_t node, std::uint32_t root) const {
  return root_of_reach(reach_[node]) == root && reach_[node] != kNoPath;
}

/// Clears the rest of a tree without following its edges.
void ShortestPathForest::clear_all_of(std::uint32_t root) {
  for (std::uint32_t node = 0; node < reach_.size(); ++node) {
    if (!belongs_to(node, root)) continue;
    reach_[node] = kNoPath;
    touched_.push_back(node);
  }
}

/// Clears the neighbours that belong to the root, too.
/// @return the reach with which a cleared node is entered from other trees, or starts one.
std::uint64_t ShortestPathForest::clear_beside(std::uint32_t node, std::uint32_t root) {
  PathReach best{kNoPath};
  if (is_start_[node]) {
    const Start& start = *start_of(neighbourhood_->point_of(node));
    best = reach_of(start.path, start.point);
  }
  for (const Neighbourhood::Edge& edge : neighbourhood_->edges(node)) {
    PathReach& beyond = reach_[edge.node];
    if (beyond == kNoPath) continue;
    if (root_of_reach(beyond) == root) {
      beyond = kNoPath;
      touched_.push_back(edge.node);
      fetch_edges(*neighbourhood_, edge.node);
    } else {
      best = std::min(best, beyond + reach_of(edge.cost, 0));
    }
  }
  return best;
}

std::vector<Root> ShortestPathForest::roots() const {
  std::vector<Root> roots;
  const double unit = neighbourhood_->config().max_path / kPathUnits;
  for (const Start& start : starts_) roots.push_back({start.point, start.path * unit});
  return roots;
}

bool ShortestPathForest::is_root(std::uint32_t point) const {
  return point < reach_.size() && is_start_[neighbourhood_->node_of(point)];
}

std::optional<std::uint32_t> ShortestPathForest::root_of(std::uint32_t point) const {
  const PathReach reach = reach_[neighbourhood_->node_of(point)];
  if (reach == kNoPath) return std::nullopt;
  return root_of_reach(reach);
}

double ShortestPathForest::path_length(std::uint32_t point) const {
  const PathReach reach = reach_[neighbourhood_->node_of(point)];
  if (reach == kNoPath) return std::numeric_limits<double>::infinity();
  return path_of(reach) * (neighbourhood_->config().max_path / kPathUnits);
}

std::uint32_t ShortestPathForest::path_units(std::uint32_t point) const {
  return path_of(reach_[neighbourhood_->node_of(point)]);
}

std::uint32_t ShortestPathForest::start_units(std::uint32_t point) const {
  SACCADE_EXPECTS(is_root(point));
  return start_of(point)->path;
}

/// Tells whether it is faster to visit this number of nodes in their order in memory.
bool ShortestPathForest::is_large(std::size_t nodes) const {
  constexpr std::size_t kShare{32};
  return nodes > reach_.size() / kShare;
}

/// Converts nodes to points. Large sets are named once each, in memory order: otherwise later work would wait for
/// memory. The order is equal for any number of threads.
void ShortestPathForest::name_touched() {
  if (touched_.size() >= kNodesOfOneThread || is_large(touched_.size())) {
    constexpr std::size_t kBits{64};
    std::vector<std::uint64_t> marks(reach_.size() / kBits + 1, 0);
    for (const std::uint32_t node : touched_) marks[node / kBits] |= std::uint64_t{1} << node % kBits;
    touched_.clear();
    for (std::size_t word = 0; word < marks.size(); ++word) {
      for (std::uint64_t bits = marks[word]; bits != 0; bits &= bits - 1) {
        touched_.push_back(static_cast<std::uint32_t>(kBits * word) +
                           static_cast<std::uint32_t>(std::countr_zero(bits)));
      }
    }
  }
  for (std::uint32_t& touched : touched_) touched = neighbourhood_->point_of(touched);
}

std::vector<ShortestPathForest::Start>::const_iterator ShortestPathForest::start_of(std::uint32_t point) const {
  return std::lower_bound(starts_.begin(), starts_.end(), point,
                          [](const Start& start, std::uint32_t p) { return start.point < p; });
}

void ShortestPathForest::start_at(const Root& root) {
  const double max_path = neighbourhood_->config().max_path;
  SACCADE_EXPECTS(root.point < reach_.size() && !is_root(root.point));
  SACCADE_EXPECTS(root.start_cost >= 0.0 && root.start_cost < max_path);
  const auto units = static_cast<std::uint32_t>(root.start_cost / max_path * kPathUnits);
  const Start start{root.point, std::min(units, kPathUnits - 1)};
  const std::uint32_t node = neighbourhood_->node_of(root.point);
  is_start_[node] = true;
  starts_.insert(start_of(root.point), start);
  const PathReach begun = reach_of(start.path, root.point);
  if (begun < reach_[node]) reach(node, begun, *queue_);
}

}  // namespace saccade
