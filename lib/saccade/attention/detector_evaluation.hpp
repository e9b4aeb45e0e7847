// SPDX-License-Identifier: Apache-2.0
#pragma once
// evaluate_detector: precision, recall and location error of a detector of hand actions on labelled trajectories.
// at_speed, with_noise: slower or faster hands and worse sensors. Thesis §2.4.2.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// Tells whether a label lies farther than `distance_m` from every sample, so that the hand cannot have acted there.
[[nodiscard]] bool is_mislabelled(const LabelledTrajectory& labelled, double distance_m = 0.2);

/// Counts of thesis §2.4.2; those of several trajectories add up.
struct DetectionCounts {
  std::size_t labels{0};
  std::size_t true_positives{0};   ///< labels with a point of interest within the match radius
  std::size_t false_positives{0};  ///< points of interest with no label within it
  [[nodiscard]] std::size_t false_negatives() const { return labels - true_positives; }
  /// Returns TP / (TP + FP); nullopt where nothing was found.
  [[nodiscard]] std::optional<double> precision() const;
  /// Returns TP / labels; nullopt without labels.
  [[nodiscard]] std::optional<double> recall() const;
  DetectionCounts& operator+=(const DetectionCounts& other);
};

/// Score of one trajectory.
struct TrajectoryScore {
  DetectionCounts counts;
  std::vector<double> location_errors_m;  ///< distance of each true positive from the nearest point of interest
};

[[nodiscard]] TrajectoryScore score(std::span<const HandAction> actions, std::span<const Eigen::Vector3d> labels_m,
                                    double match_radius_m = 0.2);

/// Changes of trajectories before detection: speed first, then noise.
struct EvaluationConditions {
  double speed{1.0};    ///< see at_speed
  double sigma_m{0.0};  ///< see with_noise
  std::uint64_t seed{1};
  double match_radius_m{0.2};
  std::size_t first_index{0};       ///< index of the first trajectory within a larger set, which determines the noise
  bool exclude_mislabelled{false};  ///< drop whole trajectories in which a label is_mislabelled
};

struct DetectorEvaluation {
  DetectionCounts counts;
  std::size_t trajectories{0};
  std::size_t excluded{0};
  std::vector<double> location_errors_m;
  std::vector<double> ms;  ///< wall time of the detector per trajectory

  /// Adds another evaluation: of other conditions, seeds or trajectories.
  DetectorEvaluation& operator+=(const DetectorEvaluation& other);
  [[nodiscard]] std::optional<double> median_location_error_m() const;
  [[nodiscard]] std::optional<double> median_ms() const;
};

using HandActionDetector = std::function<Result<std::vector<HandAction>>(const HandTrajectory&)>;

/// Runs the detector over all trajectories, one after the other on this thread. Noise differs between trajectories and
/// seeds; equal conditions give equal results.
/// @return invalid_argument for conditions out of range; errors of the detector, with the trajectory's name.
[[nodiscard]] Result<DetectorEvaluation> evaluate_detector(const HandActionDetector& detector,
                                                           std::span<const LabelledTrajectory> trajectories,
                                                           const EvaluationConditions& conditions = {});

/// Resamples to `multiplier` times the number of samples, at the original sampling intervals. Undersampling takes every
/// n-th sample, so that 0.25 is a hand four times as fast. Oversampling is linear from end to end, orientations
/// interpolated where both neighbours have one, so that 4 is a slow hand. A multiplier of 1 changes nothing.
/// @return invalid_argument for a multiplier that is not positive and finite, or that gives more than 1e8 samples.
/// O(samples returned).
[[nodiscard]] Result<HandTrajectory> at_speed(const HandTrajectory& trajectory, double multiplier);

/// Adds normal noise of this standard deviation to each coordinate, independently. The seed determines it on every
/// platform. 0 changes nothing.
/// @return invalid_argument for a negative or infinite deviation. O(n).
[[nodiscard]] Result<HandTrajectory> with_noise(HandTrajectory trajectory, double sigma_m, std::uint64_t seed);

}  // namespace saccade
