// SPDX-License-Identifier: Apache-2.0
#pragma once
// surface_of_surfels: a map of surfels as the surface that RgbdTracker aligns frames to.

#include "saccade/surfel/surfel_map.hpp"
#include "saccade/tracking/rgbd_tracker.hpp"

namespace saccade {

/// Returns what a camera sees of the surfels, by view_surfels; all must outlive it. O(surfels + covered pixels) per
/// view. Threads change no bit.
/// @param min_weight surfels with a smaller w_s are left out: few frames saw them, and they may be no surface
[[nodiscard]] SurfaceAt surface_of_surfels(const SurfelMap& map, const PinholeCamera& camera, const Executor& executor,
                                           float min_weight = 0.0F);

}  // namespace saccade
