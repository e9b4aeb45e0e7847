// SPDX-License-Identifier: Apache-2.0
#pragma once
// Neighbourhood: the graph of a cloud's points on which labels spread. Thesis §4.2.1, eq. 4.17.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/result.hpp"
#include "saccade/core/unset_vector.hpp"

namespace saccade {

/// Costs of paths are whole multiples of Ω_max / 2³⁰, so that sums are exact and do not depend on their order.
inline constexpr std::uint32_t kPathUnits{1U << 30U};

/// Chosen on clouds of a depth camera (docs/decisions/0014-annotation-weights.md).
struct NeighbourhoodConfig {
  int neighbours{10};                 ///< K_nn, 1 to 64; points that have one as a neighbour are its neighbours, too
  double position_weight_per_m{0.2};  ///< α_p
  double normal_weight{8.0};          ///< α_n
  double color_weight{1.0};           ///< α_c; an edge of the colour cube is 1
  double max_path{100.0};             ///< Ω_max: a path is shorter, in the unit of the costs
  /// Distances are divided by the local spacing of the points (the farther K-th neighbour's distance of the two) and
  /// multiplied by its median: for clouds that thin out away from the sensor, as a LiDAR's do.
  bool adapt_to_density{false};

  /// invalid_argument unless weights are finite and not negative, one of them and Ω_max positive.
  [[nodiscard]] Status validate() const;
};

/// Undirected graph over a cloud's points: each is joined to its K nearest, and cost h_ij (eq. 4.17) is the same both
/// ways. Normals that a cloud lacks altogether are estimated (estimate_normals); where a point's normal is not known,
/// and without colours, that part costs nothing. A point that is not finite has no neighbours. Inside, points are nodes
/// in an order that keeps neighbours near each other in memory. Constant; any number of threads may read.
class Neighbourhood {
 public:
  struct Edge {
    std::uint32_t node;
    std::uint32_t cost;  ///< in units of Ω_max / 2³⁰; kPathUnits and more: no path goes along it
  };

  /// Which of several points at the K-th distance are neighbours is decided by the cloud alone.
  /// @return invalid_argument for a bad configuration and for more than 2³¹ points times neighbours; errors of
  /// PointCloud::validate; cancelled, which is looked at between its three stages.
  /// The same for every thread count and instruction set. O(n log n + n K); about 13 K + 76 bytes per point while it
  /// works (1.9 GiB for ten million points), 9 K + 12 after.
  [[nodiscard]] static Result<Neighbourhood> build(const PointCloud& cloud, const NeighbourhoodConfig& config,
                                                   const Executor& executor, const Progress& progress = {});

  [[nodiscard]] const NeighbourhoodConfig& config() const { return config_; }
  /// Points of the cloud, those that are not finite included; as many as nodes.
  [[nodiscard]] std::size_t size() const { return point_of_.size(); }
  [[nodiscard]] std::uint32_t node_of(std::uint32_t point) const { return node_of_[point]; }
  [[nodiscard]] std::uint32_t point_of(std::uint32_t node) const { return point_of_[node]; }
  /// Of a node: its own nearest first, then those that have it among theirs.
  [[nodiscard]] std::span<const Edge> edges(std::uint32_t node) const {
    return {edges_.data() + starts_[node], starts_[node + 1] - starts_[node]};
  }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size() / 2; }
  /// A cost that half of the edges do not exceed, in path units.
  [[nodiscard]] std::uint32_t median_cost() const { return median_cost_; }

 private:
  Neighbourhood() = default;

  NeighbourhoodConfig config_;
  std::vector<std::uint32_t> starts_;
  UnsetVector<Edge> edges_;
  UnsetVector<std::uint32_t> node_of_;
  UnsetVector<std::uint32_t> point_of_;
  std::uint32_t median_cost_{1};
};

}  // namespace saccade
