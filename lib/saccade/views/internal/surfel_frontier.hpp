// SPDX-License-Identifier: Apache-2.0
#pragma once
// seen_voxels and frontier_discs: the steps of unknown_surfels, on a volume of states.

#include <cstdint>
#include <vector>

#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/unknown_surfels.hpp"

namespace saccade {

/// Returns 1 for each voxel of the volume in which surfels have been seen (UnknownSurfelConfig::seen_share), else 0.
[[nodiscard]] std::vector<std::uint8_t> seen_voxels(const StateVolume& volume, const SurfelMap& surfels,
                                                    const UnknownSurfelConfig& config);

/// Returns the discs of unknown_surfels.
[[nodiscard]] std::vector<SurfelDisc> frontier_discs(const StateVolume& volume, const std::vector<std::uint8_t>& seen,
                                                     const Executor& executor);

}  // namespace saccade
