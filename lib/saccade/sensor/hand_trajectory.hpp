// SPDX-License-Identifier: Apache-2.0
#pragma once
// HandTrajectory: positions of a hand, sample by sample. HandAction: place and time of an action. check_samples,
// usable_samples: faults of samples, and the samples that detectors can use.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// One reading of the motion sensor on the hand.
struct HandSample {
  double time_s{0.0};
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};  ///< in the world frame
  std::optional<Eigen::Quaterniond> R_world_hand{};     ///< where the sensor measures it
};

/// Samples of one task of the hand, by increasing time.
using HandTrajectory = std::vector<HandSample>;

/// Place where the hand may have changed something: a point of interest (POI) of thesis §2.2.4.
struct HandAction {
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
  double time_s{0.0};
  double saliency{0.0};  ///< in the unit of the detector that found it; larger is more certain
  std::string why;       ///< one line for people
};

/// A trajectory with the places where the hand is known to have acted.
struct LabelledTrajectory {
  std::string name;
  HandTrajectory trajectory;
  std::vector<Eigen::Vector3d> labels_m;
};

/// Faults among the samples of a motion sensor. Repeats and gaps are normal for such sensors.
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
  /// Returns one line for people: "830 samples, 10 ms apart; 2 not finite, 118 repeats". Faults that did not occur are
  /// omitted.
  [[nodiscard]] std::string to_string() const;
};

/// Counts the faults. O(n).
[[nodiscard]] SampleReport check_samples(std::span<const HandSample> samples);

/// Returns the samples without those that SampleReport counts as bad; repeats stay. O(n).
[[nodiscard]] HandTrajectory usable_samples(std::span<const HandSample> samples);

/// Answers invalid_argument for the first bad sample, with its number from 0. Detectors require that none is bad. O(n).
[[nodiscard]] Status validate(std::span<const HandSample> trajectory);

}  // namespace saccade
