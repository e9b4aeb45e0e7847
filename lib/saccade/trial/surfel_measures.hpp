// SPDX-License-Identifier: Apache-2.0
#pragma once
// measure_surfels: how complete and accurate surfels are, by the measures of maps. surfel_mesh.

#include "saccade/map/mesh.hpp"
#include "saccade/surfel/surfel_map.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade {

/// Returns the discs of weight w_s ≥ min_weight whose centres lie in a box as hexagons inscribed in them, which lie
/// nowhere beyond a disc. O(surfels).
[[nodiscard]] TriangleMesh surfel_mesh(const SurfelMap& surfels, double min_weight, const Box& box);

/// Measures the surfels' mesh as measure_map does that of a volume: coverage is the share of observable points within
/// within_m of a hexagon. unknown_left counts voxels of free_space, which may be coarse; unknown_near_objects is not
/// measured, since such voxels are no measure of near. Discs overlap, so that accuracy weighs places by how often
/// surfels lie there.
[[nodiscard]] Measures measure_surfels(const GroundTruth& truth, const TsdfSnapshot& free_space,
                                       const SurfelMap& surfels, double min_weight, double within_m,
                                       const Executor& executor);

}  // namespace saccade
