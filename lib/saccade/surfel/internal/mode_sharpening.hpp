// SPDX-License-Identifier: Apache-2.0
#pragma once
// sharpened_modes: the final colour and position of surfels, from their modes and their neighbours' modes. Decision 19.

#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/mode_store.hpp"

namespace saccade {

/// Chooses a mode for each surfel. Wrong poses spread the colours of a thing over its neighbourhood. Where the thing is
/// narrow, such as a letter, its colour has the largest weight nowhere, but a larger one in its place than around. So
/// modes count by
///   near + λ (near − around),
/// where `around` is the share of the weight that similar colours have in surfels within reach, under a Gaussian of
/// half the reach, and `near` that under a Gaussian of a twelfth: one step of deblurring after van Cittert (1931). λ is
/// smaller where neighbours are on one side only, as at a step in depth: a colour spread from the other side would seem
/// to belong to the rim. The result is densest_mode among the modes that look like the winner. Expects a valid config.
/// @param bandwidth  bandwidth of densest_mode.
/// @return one per surfel, with weight 0 where there is no mode. The number of threads changes no bit. O(surfels ·
/// modes²) and some fifty neighbours for surfels whose modes differ.
[[nodiscard]] std::vector<SurfelMode> sharpened_modes(const ModeStore& store, const ModeSharpeningConfig& config,
                                                      double bandwidth, const Executor& executor);

}  // namespace saccade
