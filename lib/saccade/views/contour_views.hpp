// SPDX-License-Identifier: Apache-2.0
#pragma once
// ContourViewConfig and contour_views: candidate view poses that look at the contour points of a map.

#include <span>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/views/contours.hpp"

namespace saccade {

/// Sampling of views around the direction of a contour point. Thesis §3.1, Fig. 3.2; the defaults give 40 per point.
struct ContourViewConfig {
  std::vector<double> distances_m{0.8};
  double cone_rad{15_deg};  ///< four further directions are tilted by this
  double roll_step_rad{45_deg};

  /// invalid_argument for distances or a step that are not positive, a cone outside (0, 90°) or more than 10⁷ poses.
  [[nodiscard]] Status validate() const;
  /// Five directions · rolls · distances. For a valid configuration.
  [[nodiscard]] std::size_t views_per_point() const;
};

/// Poses that look at each point from along its normal, and from four directions tilted away from it. Thesis §3.1,
/// GetViewpoints of Algorithm 4. Direction 0 is the normal n: the camera stands at p + distance · n and looks along -n.
/// The others are tilted towards the right, the top, the left and the bottom of its image at roll 0. At roll 0 the
/// image's up is the world's, as in view_sphere; for a camera that looks straight up or down it is world +y. Roll turns
/// the camera about its optical axis.
/// Index order: ((point · distances + distance) · 5 + direction) · rolls + roll.
/// @return world ← camera; invalid_argument for a bad configuration, a point or normal that is not finite, a normal
///         without length, or more than 10⁷ poses.
[[nodiscard]] Result<std::vector<Pose>> contour_views(std::span<const ContourPoint> points,
                                                      const ContourViewConfig& config = {});

}  // namespace saccade
