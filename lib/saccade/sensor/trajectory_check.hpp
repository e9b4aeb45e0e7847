// SPDX-License-Identifier: Apache-2.0
#pragma once
// check_samples: what is wrong with the samples of a hand. usable_samples: those that a detector can work with.

#include <cstddef>
#include <span>
#include <string>

#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// What a motion sensor delivered besides good samples. Repeats and gaps are normal for such sensors.
struct SampleReport {
  std::size_t samples{0};
  std::size_t not_finite{0};      ///< NaN or infinite time or position
  std::size_t not_increasing{0};  ///< time not later than that of the last good sample
  std::size_t repeats{0};         ///< good, with exactly the position of the good sample before
  std::size_t gaps{0};            ///< good, later than the one before by more than kGapIntervals median intervals
  double interval_s{0.0};         ///< median, between good samples; 0 with fewer than two
  double longest_interval_s{0.0};

  static constexpr double kGapIntervals{3.0};

  [[nodiscard]] std::size_t bad() const { return not_finite + not_increasing; }
  [[nodiscard]] std::size_t good() const { return samples - bad(); }
  /// One line for people: "830 samples, 10 ms apart; 2 not finite, 118 repeats"; what did not occur is left out.
  [[nodiscard]] std::string to_string() const;
};

/// O(n).
[[nodiscard]] SampleReport check_samples(std::span<const HandSample> samples);

/// The samples without those that SampleReport counts as bad; repeats stay. O(n).
[[nodiscard]] HandTrajectory usable_samples(std::span<const HandSample> samples);

/// Ok when no sample is bad; otherwise invalid_argument naming the first, from 0. What detectors ask for. O(n).
[[nodiscard]] Status validate(std::span<const HandSample> trajectory);

}  // namespace saccade
