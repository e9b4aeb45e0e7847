// SPDX-License-Identifier: Apache-2.0
#pragma once
// SaliencyHeuristic: how much each segment draws attention, and the heuristics that Saccade has.

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

/// How much a segment draws attention, in [0, 1].
struct Saliency {
  double value{0.0};
  std::string why;  ///< one line for people
};

/// What heuristics judge.
struct MeasuredSegments {
  const SegmentedPoints& points;
  std::span<const SegmentMeasures> measures;  ///< one per segment
  MeasureConfig config;                       ///< that they were measured by
};

/// Judges every segment, since some compare them: one entry per segment, in their order. Const, safe to call from
/// several threads. An own heuristic is a function like these.
using SaliencyHeuristic = std::function<std::vector<Saliency>(const MeasuredSegments&)>;

/// F(S) · d_min / d_max: round things that stand alone come first. Thesis eq. 3.12.
[[nodiscard]] SaliencyHeuristic objectness();
/// d_min / d_max alone. Thesis eq. 3.10, Fig. 3.8 (2).
[[nodiscard]] SaliencyHeuristic roundness_alone();
/// F(S) alone. Thesis eq. 3.11, Fig. 3.8 (3).
[[nodiscard]] SaliencyHeuristic isolation_alone();
/// 1 for every segment.
[[nodiscard]] SaliencyHeuristic equally_salient();
/// The opposite of eq. 3.12, for a rough exploration of the whole (thesis §3.3): one minus it, times the longest size
/// of the segment as a share of the longest of all, since a small scrap promises no new space.
[[nodiscard]] SaliencyHeuristic rough_first();

struct SizePriorConfig {
  double size_m{0.2};  ///< longest size of what is looked for
  double factor{2.0};  ///< a segment so many times as long, or as short, has 0.61

  /// @return invalid_argument unless the size is positive and the factor above 1, both finite.
  [[nodiscard]] Status validate() const;
};
/// Near 1 for segments of about that length: a normal distribution over the logarithm of d_max. Expects a valid config.
[[nodiscard]] SaliencyHeuristic size_prior(const SizePriorConfig& config);

struct HeightConfig {
  Eigen::Vector3d up{0.0, 0.0, 1.0};
  double half_height_m{0.05};  ///< a segment whose mean lies so high has 0.5
  double level_rad{30_deg};    ///< a support is level within this angle, and flat: roundness below 0.2

  /// @return invalid_argument unless `up` is a direction and the others are positive and finite.
  [[nodiscard]] Status validate() const;
};
/// h / (h + half_height_m) for the height h of a segment's mean above the support: the plane of the segment of largest
/// extent that is flat and level; without one, above the lowest point. At or below it: 0. Expects a valid config.
[[nodiscard]] SaliencyHeuristic height_above_support(const HeightConfig& config);

/// The share of a segment's points that a user's box, sphere or cylinder contains. Expects a valid region.
[[nodiscard]] SaliencyHeuristic inside_region(const Region& region);

/// A heuristic and its weight, named for the reason.
struct BlendPart {
  std::string name;
  double weight{1.0};
  SaliencyHeuristic heuristic;
};
/// The mean of heuristics by their weights. Expects at least one, and weights that are finite and positive.
[[nodiscard]] SaliencyHeuristic weighted_blend(std::vector<BlendPart> parts);

}  // namespace saccade
