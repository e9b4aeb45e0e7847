// SPDX-License-Identifier: Apache-2.0
#pragma once
// ShortestPathForest: which control point each point belongs to, kept up to date. Thesis Algorithms 8 and 9.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/hidden.hpp"

namespace saccade {

class PathBuckets;

/// A point from which a tree grows. It has no label here: labels follow from the root (thesis: L_i = L_{l_i}).
struct Root {
  std::uint32_t point{0};
  double start_cost{0.0};  ///< ω_a, in [0, Ω_max): the larger, the less it takes from others
  [[nodiscard]] bool operator==(const Root&) const = default;
};

/// The shortest-path forest of a neighbourhood from roots: each point belongs to the root from which a path is
/// shortest, start cost included, and below Ω_max; of equal paths to the one of lower point index. Any sequence of
/// add and remove leaves exactly what rebuild gives with the roots that are left. One writer.
class ShortestPathForest {
 public:
  /// A search that goes far uses the executor's threads.
  explicit ShortestPathForest(std::shared_ptr<const Neighbourhood> neighbourhood, const Executor& executor = {});

  [[nodiscard]] const Neighbourhood& neighbourhood() const { return *neighbourhood_; }

  /// From nothing: Algorithm 8 from all roots at once. Expects roots of different points, in the cloud, with start
  /// costs in [0, Ω_max). O(edges of what is reached).
  void rebuild(std::span<const Root> roots);
  /// Algorithm 8 from one more root. Expects that the point is none. O(edges of the points that it takes).
  void add(const Root& root);
  /// Algorithm 9, then Algorithm 8 from the border. Expects that the point is a root. O(edges of its points).
  void remove(std::uint32_t point);

  /// In ascending order of points.
  [[nodiscard]] std::vector<Root> roots() const;
  [[nodiscard]] bool is_root(std::uint32_t point) const;
  /// The root that a point belongs to; none: no path to it is short enough.
  [[nodiscard]] std::optional<std::uint32_t> root_of(std::uint32_t point) const;
  /// ω_i in the unit of the costs; infinite where there is no root.
  [[nodiscard]] double path_length(std::uint32_t point) const;
  /// ω_i in path units; kPathUnits where there is no root.
  [[nodiscard]] std::uint32_t path_units(std::uint32_t point) const;
  /// The start cost of a root in path units. Expects that the point is one.
  [[nodiscard]] std::uint32_t start_units(std::uint32_t point) const;
  /// Points whose root the last add or remove may have changed, some of them twice, or that the last rebuild reached;
  /// in no particular order.
  [[nodiscard]] std::span<const std::uint32_t> touched() const { return touched_; }

 private:
  using PathReach = std::uint64_t;  ///< path_reach.hpp
  struct Start {
    std::uint32_t point;
    std::uint32_t path;
  };
  void start_at(const Root& root);
  void reach(std::uint32_t node, PathReach reach, PathBuckets& queue);
  void spread();
  [[nodiscard]] PathReach clear_beside(std::uint32_t node, std::uint32_t root);
  [[nodiscard]] bool belongs_to(std::uint32_t node, std::uint32_t root) const;
  void clear_all_of(std::uint32_t root);
  [[nodiscard]] bool is_large(std::size_t nodes) const;
  void name_touched();
  [[nodiscard]] std::vector<Start>::const_iterator start_of(std::uint32_t point) const;

  std::shared_ptr<const Neighbourhood> neighbourhood_;
  std::vector<PathReach> reach_;  ///< per node
  std::vector<bool> is_start_;    ///< per node
  std::vector<Start> starts_;     ///< roots, by ascending point
  std::vector<std::uint32_t> touched_;
  Hidden<PathBuckets> queue_;
  std::vector<PathReach> entered_;
  Executor executor_;
};

}  // namespace saccade
