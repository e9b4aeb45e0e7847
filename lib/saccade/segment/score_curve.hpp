// SPDX-License-Identifier: Apache-2.0
#pragma once
// ScoreCurve: scores of one algorithm over its threshold; precision over recall, the area below, the largest F.

#include <optional>
#include <span>
#include <vector>

#include "saccade/core/progress.hpp"
#include "saccade/segment/flood_fill.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/segment/segmentation_truth.hpp"

namespace saccade {

struct CurvePoint {
  double threshold{0.0};
  std::size_t segments{0};
  SegmentationScore score;
};

/// Curve of scores. Thesis Figs. 4.10, 4.11 and Table 4.3.
struct ScoreCurve {
  std::vector<CurvePoint> points;  ///< in the order of the given thresholds

  /// Returns the area under precision over recall: at each recall the greatest precision reached at it or at a greater
  /// one; nothing beyond the greatest recall. More thresholds, or another order, never reduce it.
  [[nodiscard]] double area() const;
  /// Returns the point with the largest F, the first at a tie; none without an F.
  [[nodiscard]] std::optional<CurvePoint> best_f() const;
  /// Returns the point with the smallest BCE, the first at a tie.
  [[nodiscard]] std::optional<CurvePoint> least_bce() const;
};

/// Runs flood_fill at each T_ff, which replaces that of the config; the graph is made once.
/// @return an error of cloud, config, a threshold, or the truth; cancelled, checked between thresholds.
[[nodiscard]] Result<ScoreCurve> flood_fill_curve(const PointCloud& cloud, const SegmentationTruth& truth,
                                                  std::span<const double> thresholds, const FloodFillConfig& config,
                                                  const Executor& executor, const Progress& progress = {});

/// Runs prune_by_color and segment_by_convexity at each T_lccp; the supervoxels are made once.
[[nodiscard]] Result<ScoreCurve> sv_lccp_curve(const SupervoxelResult& supervoxels, const SegmentationTruth& truth,
                                               std::span<const double> thresholds, const LccpConfig& config,
                                               const Executor& executor, const Progress& progress = {});

}  // namespace saccade
