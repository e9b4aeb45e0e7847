// SPDX-License-Identifier: Apache-2.0
#pragma once
// baseline_planners: strategies with the gains of other authors, for comparison.

#include "saccade/explore/planners.hpp"

namespace saccade {

/// Returns the planners that choose contour views by volumetric_gain, surface_edge_gain and projection_gain. They have
/// no threshold of their own: they continue while a view gains anything. docs/design/baselines.md.
[[nodiscard]] std::vector<NamedPlanner> baseline_planners();

}  // namespace saccade
