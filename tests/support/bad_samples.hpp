// SPDX-License-Identifier: Apache-2.0
#pragma once
// Gross outliers and repeated samples, which a sensor may give besides noise.

#include <cmath>
#include <cstdint>

#include "saccade/core/seeded_random.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade::test {

struct BadSamples {
  double outlier_share{0.0};      ///< share of samples moved by up to 0.5 m along each axis
  bool farthest_outliers{false};  ///< all outliers by 0.5 m along each axis
  double repeat_share{0.0};       ///< share of samples replaced by the previous one; applied last

  [[nodiscard]] bool any() const { return outlier_share > 0.0 || repeat_share > 0.0; }
};

/// The seed decides it, on every platform.
inline HandTrajectory with_bad_samples(HandTrajectory hand, const BadSamples& bad, std::uint64_t seed) {
  SeededRandom random{seed};
  for (std::size_t k = 0; k < hand.size(); ++k) {
    if (random.uniform(0.0, 1.0) < bad.outlier_share) {
      for (double& coordinate : hand[k].position_m) {
        const double off_m = random.uniform(-0.5, 0.5);
        coordinate += bad.farthest_outliers ? std::copysign(0.5, off_m) : off_m;
      }
    }
    if (k > 0 && random.uniform(0.0, 1.0) < bad.repeat_share) hand[k].position_m = hand[k - 1].position_m;
  }
  return hand;
}

}  // namespace saccade::test
