// SPDX-License-Identifier: Apache-2.0
#pragma once
// FloodFillConfig, flood_fill: segments of surfels that touch and look alike.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

class SurfelGraph;

/// Connected surfels. Labels count from 0, in the order of the first surfels.
struct SurfelComponents {
  std::vector<std::uint32_t> labels;  ///< one per point; kUnlabelled where it is no surfel
  std::size_t count{0};
};

/// Parameters of flood_fill: thesis eq. (4.14), Table 4.2.
struct FloodFillConfig {
  double color_weight{1.0};     ///< α_c, weight of ‖c₁ − c₂‖ with colours in [0, 1]
  double normal_weight{0.5};    ///< α_n, weight of 1 − N₁ · N₂
  double threshold{0.05};       ///< T_ff: touching surfels belong to one segment when their difference is smaller
  bool unknown_is_alike{true};  ///< a normal that is zero or not finite equals all others; false: N₁ · N₂ is 0

  /// Eq. 4.14 for unknown normals, too. Nothing else in our flood fill departs from the thesis (decision 41).
  [[nodiscard]] static FloodFillConfig as_printed() {
    FloodFillConfig config;
    config.unknown_is_alike = false;
    return config;
  }

  /// @return invalid_argument for a number that is not finite or negative.
  [[nodiscard]] Status validate() const;
};

/// Returns α_c ‖c₁ − c₂‖ + α_n (1 − N₁ · N₂), eq. (4.14). An unknown normal, zero or not finite, counts as equal, or as
/// zero (unknown_is_alike).
[[nodiscard]] double surfel_difference(const Eigen::Vector3f& color_a, const Eigen::Vector3f& normal_a,
                                       const Eigen::Vector3f& color_b, const Eigen::Vector3f& normal_b,
                                       const FloodFillConfig& config);

/// Flood fill on the surfel graph (thesis §4.1.2). Edges of the graph (eq. 4.13) whose ends differ by less than T_ff
/// (eq. 4.14) connect the surfels of a segment. Normals have unit length. A cloud without colours is filled by normals,
/// one without normals by colours.
/// @param graph  graph of this cloud; make it once for several thresholds.
/// @return an error of the config; size_mismatch when the graph belongs to another cloud. O(surfels · neighbours). The
/// thread count never changes a bit of the result.
[[nodiscard]] Result<SurfelComponents> flood_fill(const SurfelGraph& graph, const PointCloud& cloud,
                                                  const FloodFillConfig& config, const Executor& executor);
/// Makes the graph and fills it.
[[nodiscard]] Result<SurfelComponents> flood_fill(const PointCloud& cloud, const FloodFillConfig& config,
                                                  const Executor& executor);

}  // namespace saccade
