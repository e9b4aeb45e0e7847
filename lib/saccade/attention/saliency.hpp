// SPDX-License-Identifier: Apache-2.0
#pragma once
// SaliencyHeuristic: rates how much each segment draws attention; Saccade's heuristics.

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "saccade/attention/region_of_interest.hpp"
#include "saccade/attention/segmented_points.hpp"
#include "saccade/core/angle.hpp"

namespace saccade {

/// Saliency of a segment, in [0, 1].
struct Saliency {
  double value{0.0};
  std::string why;  ///< one line for people
};

/// Input of heuristics.
struct MeasuredSegments {
  const SegmentedPoints& points;
  std::span<const SegmentMeasures> measures;  ///< one per segment
  MeasureConfig config;                       ///< parameters of the measures
};

/// Rates every segment, since some heuristics compare them: one entry per segment, in their order. Const, safe to call
/// from several threads. Your own heuristic is a function like these.
using SaliencyHeuristic = std::function<std::vector<Saliency>(const MeasuredSegments&)>;

/// Returns F(S) · d_min / d_max: round, isolated objects come first. Thesis eq. 3.12.
[[nodiscard]] SaliencyHeuristic objectness();
/// Returns d_min / d_max alone. Thesis eq. 3.10, Fig. 3.8 (2).
[[nodiscard]] SaliencyHeuristic roundness_alone();
/// Returns F(S) alone. Thesis eq. 3.11, Fig. 3.8 (3).
[[nodiscard]] SaliencyHeuristic isolation_alone();
/// Returns 1 for every segment.
[[nodiscard]] SaliencyHeuristic equally_salient();
/// Returns the opposite of eq. 3.12, for a rough exploration of the whole (thesis §3.3): one minus it, times the
/// segment's longest size relative to the longest of all, since a small scrap promises no new space.
[[nodiscard]] SaliencyHeuristic rough_first();

struct SizePriorConfig {
  double size_m{0.2};  ///< longest size of the objects sought
  double factor{2.0};  ///< a segment this factor longer or shorter has saliency 0.61

  /// @return invalid_argument unless the size is positive and the factor above 1, both finite.
  [[nodiscard]] Status validate() const;
};
/// Returns values near 1 for segments of about that length: a normal distribution over the logarithm of d_max. Expects
/// a valid config.
[[nodiscard]] SaliencyHeuristic size_prior(const SizePriorConfig& config);

struct HeightConfig {
  Eigen::Vector3d up{0.0, 0.0, 1.0};
  double half_height_m{0.05};  ///< height of a segment's mean with saliency 0.5
  double level_rad{30_deg};    ///< a support is level within this angle, and flat: roundness below 0.2

  /// @return invalid_argument unless `up` is a direction and the others are positive and finite.
  [[nodiscard]] Status validate() const;
};
/// Returns h / (h + half_height_m) for the height h of a segment's mean above the support: the plane of the largest
/// segment that is flat and level, or the level of the lowest point without one. At or below it: 0. Expects a valid
/// config.
[[nodiscard]] SaliencyHeuristic height_above_support(const HeightConfig& config);

/// Returns the share of a segment's points inside a user's box, sphere or cylinder. Expects a valid region.
[[nodiscard]] SaliencyHeuristic inside_region(const Region& region);

/// Heuristic with its weight and a name for the reason.
struct BlendPart {
  std::string name;
  double weight{1.0};
  SaliencyHeuristic heuristic;
};
/// Returns the weighted mean of heuristics. Expects at least one, and weights that are finite and positive.
[[nodiscard]] SaliencyHeuristic weighted_blend(std::vector<BlendPart> parts);

}  // namespace saccade
