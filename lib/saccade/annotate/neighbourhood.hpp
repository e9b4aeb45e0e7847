// SPDX-License-Identifier: Apache-2.0
#pragma once
// Neighbourhood: the graph of a cloud's points on which labels spread. Thesis §4.2.1, eq. 4.17.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/disk_memory.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Costs of paths are integer multiples of Ω_max / 2³⁰, so that sums are exact and independent of their order.
inline constexpr std::uint32_t kPathUnits{1U << 30U};

/// Chosen on clouds of a depth camera (docs/decisions/0014-annotation-weights.md).
struct NeighbourhoodConfig {
  int neighbours{10};                 ///< K_nn, 1 to 64; neighbourhood is symmetric
  double position_weight_per_m{0.2};  ///< α_p
  double normal_weight{8.0};          ///< α_n
  double color_weight{1.0};           ///< α_c; an edge of the colour cube is 1
  double max_path{100.0};             ///< Ω_max: limit of a path, in the unit of the costs
  /// Distances are divided by the local spacing of the points (the farther K-th neighbour's distance of the two) and
  /// multiplied by its median: for clouds that thin out away from the sensor, as a LiDAR's do.
  bool adapt_to_density{false};
  /// Costs above the median count more, those below it less, each by its ratio to the median, at most ten times; and
  /// later clicks stop at strong borders (click_start.hpp). Where many points share a place, one of them is joined to
  /// its nearest, and the others to it alone (nearest_places). False: eq. 4.17 and Algorithm 8 as printed.
  bool strong_borders{false};

  /// invalid_argument unless weights are finite and not negative, one of them and Ω_max positive.
  [[nodiscard]] Status validate() const;
};

/// Undirected graph over a cloud's points. Each is joined to its K nearest, with symmetric cost h_ij (eq. 4.17).
/// Normals that a cloud lacks altogether are estimated (estimate_normals). The normal part costs nothing where a
/// point's normal is unknown, nor does the colour part without colours. A point that is not finite has no neighbours.
/// Inside, points are nodes in an order that keeps neighbours close in memory. Constant; any number of threads may
/// read.
class Neighbourhood {
 public:
  struct Edge {
    std::uint32_t node;
    std::uint32_t cost;  ///< in units of Ω_max / 2³⁰; kPathUnits and more: no path goes along it
  };

  /// Builds the graph. The cloud alone decides which of several points at the K-th distance are neighbours.
  /// @return invalid_argument for a bad configuration and for more than 2³¹ points times neighbours; errors of
  /// PointCloud::validate; cancelled, tested between its three stages. The thread count and instruction set never
  /// change the result. O(n log n + n K); about 13 K + 54 bytes per point while it works (1.7 GiB for ten million
  /// points), 9 K + 12 after; of these, 13 K + 20 and 9 K on `disk` where there is one.
  [[nodiscard]] static Result<Neighbourhood> build(const PointCloud& cloud, const NeighbourhoodConfig& config,
                                                   const Executor& executor, const Progress& progress = {},
                                                   const std::shared_ptr<const DiskMemory>& disk = {});

  /// Returns an estimate of the memory that `build` takes, in bytes.
  [[nodiscard]] static std::size_t building_bytes(std::size_t points, const NeighbourhoodConfig& config);

  [[nodiscard]] const NeighbourhoodConfig& config() const { return config_; }
  /// Returns the number of the cloud's points, including those that are not finite; equals the number of nodes.
  [[nodiscard]] std::size_t size() const { return point_of_.size(); }
  [[nodiscard]] std::uint32_t node_of(std::uint32_t point) const { return node_of_[point]; }
  [[nodiscard]] std::uint32_t point_of(std::uint32_t node) const { return point_of_[node]; }
  /// Edges of a node: to its own nearest neighbours first, then to nodes that count it among theirs.
  [[nodiscard]] std::span<const Edge> edges(std::uint32_t node) const {
    return {edges_.data() + starts_[node], starts_[node + 1] - starts_[node]};
  }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size() / 2; }
  /// Returns a cost that half of the edges do not exceed, in path units.
  [[nodiscard]] std::uint32_t median_cost() const { return median_cost_; }

 private:
  Neighbourhood() = default;

  NeighbourhoodConfig config_;
  std::vector<std::uint32_t> starts_;
  DiskVector<Edge> edges_;
  UninitializedVector<std::uint32_t> node_of_;
  UninitializedVector<std::uint32_t> point_of_;
  std::uint32_t median_cost_{1};
};

}  // namespace saccade
