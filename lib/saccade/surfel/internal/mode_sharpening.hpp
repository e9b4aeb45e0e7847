// SPDX-License-Identifier: Apache-2.0
#pragma once
// sharpened_modes: what surfels are in the end, of their modes and those of their neighbours.  Decision 19.

#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/mode_store.hpp"

namespace saccade {

/// Wrong poses spread the colours of a thing over its neighbourhood. Where it is narrow, such as a letter, its colour
/// has most of the weight nowhere, but more of it in its place than around. So modes count by
///   near + λ (near − around),
/// where `around` is the share of the weight that colours like theirs have in surfels within reach, under a Gaussian of
/// half the reach, and `near` that under a Gaussian of a twelfth: one step of deblurring after van Cittert (1931).
/// Where neighbours are on one side only, as before a step in depth, λ is less: there a colour that came from the other
/// side would seem to have its place at the rim. Of the modes that look like the winner it is densest_mode.
/// Expects a valid config. @param bandwidth  of densest_mode.
/// @return one per surfel, of weight 0 where there is no mode. Any number of threads gives the same bits. O(surfels ·
/// modes²) and some fifty neighbours for surfels whose modes differ.
[[nodiscard]] std::vector<SurfelMode> sharpened_modes(const ModeStore& store, const ModeSharpeningConfig& config,
                                                      double bandwidth, const Executor& executor);

}  // namespace saccade
