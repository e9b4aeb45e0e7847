// SPDX-License-Identifier: Apache-2.0
#pragma once
// baseline_planners: strategies with the gains of other authors, to compare with.

#include "saccade/explore/planners.hpp"

namespace saccade {

/// The table of planners that choose contour views by volumetric_gain, surface_edge_gain and projection_gain. They have
/// no threshold of their own: while a view gains anything, they go on. docs/baselines.md.
[[nodiscard]] std::vector<NamedPlanner> baseline_planners();

}  // namespace saccade
