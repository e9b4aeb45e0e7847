// SPDX-License-Identifier: Apache-2.0
#pragma once
// select_points, select_around: the points that a tool selects in a picture. Thesis §4.2.2.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/annotate/screen_shape.hpp"
#include "saccade/annotate/selection_view.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// How far behind the visible surface points are still selected: not at all, only what is seen (the thesis' Surface
/// rect); however far (its Deep rect). What is between takes in what lies slightly below the surface, as its users
/// asked for (§4.2.3).
inline constexpr double kOnSurface_m{0.0};
inline constexpr double kAnyDepth_m{std::numeric_limits<double>::infinity()};

/// The points in view whose pixel is in the shape, and which lie at most `below_m` behind what this pixel shows (see
/// SplatDepth; depth is compared in single precision). Where points are drawn too small to close the surface, what is
/// seen between them is selected too. Points that are not in view or not finite neither are selected nor hide others.
/// @param positions_m  at most 2³² − 1 points, in the frame that the view maps from.
/// @return indices in ascending order; invalid_argument for a bad view or shape, or below_m that is negative or NaN.
/// O(points + pixels). The thread count never changes the result.
[[nodiscard]] Result<std::vector<std::uint32_t>> select_points(std::span<const Eigen::Vector3f> positions_m,
                                                               const SelectionView& view, const ScreenShape& shape,
                                                               double below_m, const Executor& executor);

/// The points in view, hidden or not, at most `radius_m` from the visible surface under a line: a ball drawn along it.
/// The surface is taken where rays through the centres of the pixels within ¾ pixel of the line meet what these show.
/// @param line  as that of a ScreenStroke.
/// @return as select_points; invalid_argument also for a radius that is not finite and positive.
/// O(points + pixels + balls near each point). The thread count never changes the result.
[[nodiscard]] Result<std::vector<std::uint32_t>> select_around(std::span<const Eigen::Vector3f> positions_m,
                                                               const SelectionView& view,
                                                               std::span<const ScreenPoint> line, double radius_m,
                                                               const Executor& executor);

}  // namespace saccade
