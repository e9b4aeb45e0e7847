// SPDX-License-Identifier: Apache-2.0
#pragma once
// at_speed, with_noise: a trajectory as a slower or faster hand and a worse sensor would give it. Thesis §2.4.2.

#include <cstdint>

#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// `multiplier` times as many samples as before, at the sampling intervals of before. Undersampling takes every n-th
/// sample, so that 0.25 is a hand four times as fast; oversampling is linear from end to end, orientations interpolated
/// where both neighbours have one, so that 4 is a slow hand. A multiplier of 1 changes nothing.
/// @return invalid_argument for a multiplier that is not positive and finite, or that gives more than 1e8 samples.
/// O(samples returned).
[[nodiscard]] Result<HandTrajectory> at_speed(const HandTrajectory& trajectory, double multiplier);

/// Adds normal noise of this standard deviation to each coordinate, independently. The seed decides it, on every
/// platform. 0 changes nothing.
/// @return invalid_argument for a negative or infinite deviation. O(n).
[[nodiscard]] Result<HandTrajectory> with_noise(HandTrajectory trajectory, double sigma_m, std::uint64_t seed);

}  // namespace saccade
