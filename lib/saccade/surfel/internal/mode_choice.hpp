// SPDX-License-Identifier: Apache-2.0
#pragma once
// heaviest_mode, densest_mode, densest_mode_like: what a surfel is in the end, of its modes.  Thesis §4.1.1, eq. 4.11;
// decision 18.

#include <span>

#include "saccade/surfel/mode_store.hpp"

namespace saccade {

/// Eq. 4.11: the mode of the largest weight, the first of equal ones; weight 0 where there is none.
[[nodiscard]] SurfelMode heaviest_mode(std::span<const SurfelMode> modes);

/// Where the modes' weights are densest in the space of colours, seen through a Gaussian of `bandwidth` (in [0, 1] as
/// colours are): mean shift from the mode that is densest (Comaniciu and Meer, PAMI 2002). So several modes that noise
/// made of one colour count together, and colours far away count nothing. Its place is the mean over all modes, its
/// weight that under the Gaussian. Weight 0 where there is no mode. Expects a bandwidth above 0. O(modes²).
[[nodiscard]] SurfelMode densest_mode(std::span<const SurfelMode> modes, double bandwidth);

/// The same from the mode that is densest among those that look like a colour, under a Gaussian of `color_sigma`.
[[nodiscard]] SurfelMode densest_mode_like(std::span<const SurfelMode> modes, double bandwidth,
                                           const Eigen::Vector3f& color, double color_sigma);

}  // namespace saccade
