// SPDX-License-Identifier: Apache-2.0
#pragma once
// ShortestPathForest: assigns each point to a control point, updated incrementally. Thesis Algorithms 8 and 9.

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

/// Point from which a tree grows. It has no label here: labels follow from the root (thesis: L_i = L_{l_i}).
struct Root {
  std::uint32_t point{0};
  double start_cost{0.0};  ///< ω_a, in [0, Ω_max): a larger cost takes less from others
  [[nodiscard]] bool operator==(const Root&) const = default;
};

/// Shortest-path forest of a neighbourhood from roots. Each point belongs to the root with the shortest path to it,
/// start cost included and below Ω_max; at a tie the lower point index wins. Any sequence of add and remove gives
/// exactly the result of rebuild with the remaining roots. One writer.
class ShortestPathForest {
 public:
  /// A search that goes far uses the executor's threads.
  explicit ShortestPathForest(std::shared_ptr<const Neighbourhood> neighbourhood, const Executor& executor = {});

  [[nodiscard]] const Neighbourhood& neighbourhood() const { return *neighbourhood_; }

  /// Builds the forest by Algorithm 8 from all roots at once. Expects roots at different points of the cloud, with
  /// start costs in [0, Ω_max). O(edges of what is reached).
  void rebuild(std::span<const Root> roots);
  /// Adds a root by Algorithm 8. Expects that the point is not a root. O(edges of the points that it takes).
  void add(const Root& root);
  /// Removes a root by Algorithm 9, then Algorithm 8 from the border. Expects that the point is a root. O(edges of its
  /// points).
  void remove(std::uint32_t point);

  /// Returns the roots in ascending order of points.
  [[nodiscard]] std::vector<Root> roots() const;
  [[nodiscard]] bool is_root(std::uint32_t point) const;
  /// Returns the root that a point belongs to; nullopt where no path to it is short enough.
  [[nodiscard]] std::optional<std::uint32_t> root_of(std::uint32_t point) const;
  /// Returns ω_i in the unit of the costs; infinite where there is no root.
  [[nodiscard]] double path_length(std::uint32_t point) const;
  /// Returns ω_i in path units; kPathUnits where there is no root.
  [[nodiscard]] std::uint32_t path_units(std::uint32_t point) const;
  /// Returns the start cost of a root in path units. Expects that the point is a root.
  [[nodiscard]] std::uint32_t start_units(std::uint32_t point) const;
  /// Returns the points whose root the last add or remove may have changed, with some duplicates, or that the last
  /// rebuild reached; in no particular order.
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
