// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelGraph: which surfels of a cloud touch.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/segment/disjoint_sets.hpp"
#include "saccade/segment/point_cells.hpp"
#include "saccade/segment/point_cloud.hpp"

namespace saccade {

/// The neighbourhood graph of a surfel cloud: two surfels touch when ‖p₁ − p₂‖ < r₁ + r₂ (thesis eq. 4.13). Its edges
/// are found anew each time that they are asked for, and never stored.
///
/// Surfels lie in grids by their size, each at most as wide as half a cell of its grid, so that a few large ones cost
/// the small ones nothing. Cells of a coarser grid are made of cells of the finer ones.
class SurfelGraph {
 public:
  /// Copies places and radii. A point that is not finite is no surfel.
  /// @return an error of the cloud; invalid_argument without radii, for a surfel whose radius is negative or not
  /// finite, or one that lies farther away than a million times its size.
  /// O(surfels), one thread.
  [[nodiscard]] static Result<SurfelGraph> create(const PointCloud& cloud);

  /// Surfels by node: those of a cell next to each other.
  [[nodiscard]] std::span<const std::uint32_t> surfels() const { return surfels_; }
  /// Of the cloud, those that are no surfels included.
  [[nodiscard]] std::size_t points() const { return points_; }

  /// Calls body(a, b) with nodes once for every edge, from several threads at once, in any order.
  /// O(surfels · those nearby).
  template <class Body>
  void for_each_edge(const Executor& executor, const Body& body) const {
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      constexpr std::size_t kCellGrain{256};
      executor.parallel_for(levels_[level].cells.size(), kCellGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<Range> others;
        for (std::size_t cell = begin; cell < end; ++cell) {
          const Range own = range_of(level, static_cast<std::uint32_t>(cell));
          find_others(level, cell, others);
          for (std::uint32_t a = own.begin; a < own.end; ++a) {
            for (std::uint32_t b = a + 1; b < own.end; ++b) {
              if (touch(a, b)) body(a, b);
            }
            for (const Range& other : others) {
              for (std::uint32_t b = other.begin; b < other.end; ++b) {
                if (touch(a, b)) body(a, b);
              }
            }
          }
        }
      });
    }
  }

 private:
  struct Range {
    std::uint32_t begin, end;  ///< nodes
  };
  struct Level {
    PointCells cells;
    std::uint32_t first{0};  ///< node
  };

  [[nodiscard]] Range range_of(std::size_t level, std::uint32_t cell) const {
    const Level& at = levels_[level];
    return {at.first + at.cells.first_of(cell), at.first + at.cells.end_of(cell)};
  }
  /// Where surfels may touch those of a cell, besides itself: half of the cells around it, so that a pair comes once,
  /// and all around it in coarser grids.
  void find_others(std::size_t level, std::size_t cell, std::vector<Range>& others) const;

  /// Decides in single precision where that is sure, else as the equation says.
  [[nodiscard]] bool touch(std::uint32_t a, std::uint32_t b) const {
    constexpr float kMargin{1.0F + 1e-5F};
    const Eigen::Vector4f& i = nodes_[a];
    const Eigen::Vector4f& k = nodes_[b];
    const float reach_m = i.w() + k.w();
    const float squared_m2 = (i - k).head<3>().squaredNorm();
    if (squared_m2 > reach_m * reach_m * kMargin) return false;
    const double sum_m = static_cast<double>(i.w()) + static_cast<double>(k.w());
    return (i.head<3>().cast<double>() - k.head<3>().cast<double>()).squaredNorm() < sum_m * sum_m;
  }

  std::vector<Level> levels_;           ///< the finest first
  std::vector<Eigen::Vector4f> nodes_;  ///< place and radius
  std::vector<std::uint32_t> surfels_;
  std::size_t points_{0};
};

/// Labels count from 0, in the order of the first surfels.
struct SurfelComponents {
  std::vector<std::uint32_t> labels;  ///< one per point; kUnlabelled where there is no surfel
  std::size_t count{0};
};

/// Those that are surfels of the graph.
[[nodiscard]] SurfelComponents number_components(const SurfelGraph& graph, DisjointSets& sets);

/// What edges connect whose ends are alike. `alike` is given nodes, by several threads at once.
/// Near-linear in the edges. The thread count never changes the result.
template <class Alike>
[[nodiscard]] SurfelComponents connected_surfels(const SurfelGraph& graph, const Executor& executor,
                                                 const Alike& alike) {
  DisjointSets sets{graph.points()};
  const std::span<const std::uint32_t> surfels = graph.surfels();
  graph.for_each_edge(executor, [&](std::uint32_t a, std::uint32_t b) {
    if (alike(a, b)) sets.join(surfels[a], surfels[b]);
  });
  return number_components(graph, sets);
}

/// Labels with the parts of each that do not touch told apart (thesis §4.1.3: truth segments that are not connected on
/// the graph are split). A point without a label, or without a place, has none.
/// @return size_mismatch unless there is one label per point.
[[nodiscard]] Result<SurfelComponents> split_unconnected(const SurfelGraph& graph,
                                                         std::span<const std::uint32_t> labels,
                                                         const Executor& executor);

}  // namespace saccade
