// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelGraph: which surfels of a cloud touch.

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/cell_index.hpp"
#include "saccade/cloud/disjoint_sets.hpp"
#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/segment/flood_fill.hpp"

namespace saccade {

/// Neighbourhood graph of a surfel cloud: two surfels touch when ‖p₁ − p₂‖ < r₁ + r₂ (thesis eq. 4.13). Edges are found
/// anew on each request, never stored.
///
/// Surfels lie in grids by their size, each at most half as wide as a cell of its grid, so that a few large ones do not
/// slow down the small ones. Cells of a coarser grid consist of cells of the finer ones.
class SurfelGraph {
 public:
  /// Copies positions and radii. A point that is not finite is no surfel.
  /// @return an error of the cloud; invalid_argument without radii, for a surfel whose radius is negative or not
  /// finite, or one that lies farther away than a million times its size.
  /// O(surfels), one thread.
  [[nodiscard]] static Result<SurfelGraph> create(const PointCloud& cloud);

  /// Returns the surfels by node, with those of a cell adjacent.
  [[nodiscard]] std::span<const std::uint32_t> surfels() const { return surfels_; }
  /// Returns the number of points of the cloud, including those that are no surfels.
  [[nodiscard]] std::size_t points() const { return points_; }

  /// Calls body(a, b) with nodes once for every edge, from several threads at once, in any order. O(surfels ·
  /// neighbours).
  template <class Body>
  void for_each_edge(const Executor& executor, const Body& body) const {
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      constexpr std::size_t kCellGrain{256};
      executor.parallel_for(levels_[level].cells.size(), kCellGrain, [&](std::size_t begin, std::size_t end) {
        Nearby near;
        for (std::size_t cell = begin; cell < end; ++cell) {
          gather(level, cell, near);
          for (std::size_t i = 0; i < near.own; ++i) {
            find_near(i, near);
            for (std::size_t block = (i + 1) / kBlock; block < near.found.size(); ++block) {
              for (std::uint64_t found = near.found[block]; found != 0; found &= found - 1) {
                const std::size_t k = kBlock * block + static_cast<std::size_t>(std::countr_zero(found)) / 8;
                if (touch(near.nodes[i], near.nodes[k])) body(near.nodes[i], near.nodes[k]);
              }
            }
          }
        }
      });
    }
  }

 private:
  struct Range {
    std::uint32_t begin, end;  ///< range of nodes
  };
  struct Level {
    PointCells cells;
    std::uint32_t first{0};  ///< first node
  };

  [[nodiscard]] Range range_of(std::size_t level, std::uint32_t cell) const {
    const Level& at = levels_[level];
    return {at.first + at.cells.first_of(cell), at.first + at.cells.end_of(cell)};
  }

  static constexpr std::size_t kBlock{8};
  /// Surfels of a cell, followed by all later ones in the order of pairs that may touch them; in whole blocks.
  struct Nearby {
    std::size_t own{0};  ///< number of the cell's own surfels, which come first
    std::vector<std::uint32_t> nodes;
    std::array<std::vector<float>, 4> lanes;  ///< x, y, z, radius; NaN where the last block is padded
    std::vector<std::uint64_t> found;         ///< by block: one byte each, not 0 for surfels that may touch
  };
  void gather(std::size_t level, std::size_t cell, Nearby& near) const;
  /// Marks the surfels after `i` that may touch it, in single precision with a margin for rounding.
  static void find_near(std::size_t i, Nearby& near);

  [[nodiscard]] bool touch(std::uint32_t a, std::uint32_t b) const {
    const Eigen::Vector4f& i = nodes_[a];
    const Eigen::Vector4f& k = nodes_[b];
    const double sum_m = static_cast<double>(i.w()) + static_cast<double>(k.w());
    return (i.head<3>().cast<double>() - k.head<3>().cast<double>()).squaredNorm() < sum_m * sum_m;
  }

  std::vector<Level> levels_;           ///< finest first
  std::vector<Eigen::Vector4f> nodes_;  ///< position and radius
  std::vector<std::uint32_t> surfels_;
  std::size_t points_{0};
};

/// Numbers the components of sets of nodes.
[[nodiscard]] SurfelComponents number_components(const SurfelGraph& graph, DisjointSets& sets);

/// Finds the components connected by edges whose ends satisfy `alike`, which is called with nodes by several threads at
/// once. Near-linear in the edges. The thread count never changes the result.
template <class Alike>
[[nodiscard]] SurfelComponents connected_surfels(const SurfelGraph& graph, const Executor& executor,
                                                 const Alike& alike) {
  DisjointSets sets{graph.surfels().size()};
  graph.for_each_edge(executor, [&](std::uint32_t a, std::uint32_t b) {
    if (alike(a, b)) sets.join(a, b);
  });
  return number_components(graph, sets);
}

/// Splits labels into parts that do not touch (thesis §4.1.3: truth segments that are not connected on the graph are
/// split). A point without a label or position gets none.
/// @return size_mismatch unless there is one label per point.
[[nodiscard]] Result<SurfelComponents> split_unconnected(const SurfelGraph& graph,
                                                         std::span<const std::uint32_t> labels,
                                                         const Executor& executor);

}  // namespace saccade
