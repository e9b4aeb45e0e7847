// SPDX-License-Identifier: Apache-2.0
#pragma once
// heaviest_mode, densest_mode, densest_mode_like: the final colour and position of a surfel, from its modes. Thesis
// §4.1.1, eq. 4.11; decision 18.

#include <span>

#include "saccade/surfel/mode_store.hpp"

namespace saccade {

/// Returns the mode with the largest weight (eq. 4.11), the first at a tie; weight 0 without modes.
[[nodiscard]] SurfelMode heaviest_mode(std::span<const SurfelMode> modes);

/// Returns the point in the space of colours where the modes' weights are densest under a Gaussian of `bandwidth` (in
/// the unit of colours, [0, 1]), found by mean shift from the densest mode (Comaniciu and Meer, PAMI 2002). Several
/// modes that noise made of one colour thus count together, and distant colours do not count. Its position is the mean
/// over all modes, its weight the sum under the Gaussian; 0 without modes. Expects a bandwidth above 0. O(modes²).
[[nodiscard]] SurfelMode densest_mode(std::span<const SurfelMode> modes, double bandwidth);

/// As densest_mode, from the densest mode among those near `color` under a Gaussian of `color_sigma`.
[[nodiscard]] SurfelMode densest_mode_like(std::span<const SurfelMode> modes, double bandwidth,
                                           const Eigen::Vector3f& color, double color_sigma);

}  // namespace saccade
