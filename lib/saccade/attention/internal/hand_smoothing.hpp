// SPDX-License-Identifier: Apache-2.0
#pragma once
// First steps of the dip detectors on a hand trajectory: distinct samples, their noise, and the smoothed motion.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "saccade/attention/dip_detector.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// Check that times and positions are finite (at most 1e12 s and m), and that the times of a trajectory never decrease.
/// @return invalid_argument, for a trajectory naming the first bad sample. O(n)
[[nodiscard]] Status check_order(const HandSample& sample);
[[nodiscard]] Status check_order(std::span<const HandSample> trajectory);

/// Returns the informative samples: without those equal to the previous one, samples of one time as their mean. Expects
/// a valid trajectory. O(n)
[[nodiscard]] std::vector<TimedPoint> fresh_samples(std::span<const HandSample> trajectory);

/// Returns the standard deviation of the noise on each coordinate: the median length of third differences (divided
/// ones, since samples may be missing, with coefficients of unit norm) over that of a Gaussian vector. Motion that is
/// quadratic over four samples leaves no trace in it. 0 below four samples. Expects increasing times. O(n)
[[nodiscard]] double noise_deviation_m(std::span<const TimedPoint> samples);

/// Return the length of one such difference, and the noise estimated from any number of lengths.
[[nodiscard]] double third_difference_m(std::span<const TimedPoint, 4> samples);
[[nodiscard]] double noise_of_third_differences_m(std::vector<double> lengths_m);

/// Spread of positions, summed up one by one.
class PositionSpread {
 public:
  /// @param noise_m  expected standard deviation of the position on each axis.
  void add(const Eigen::Vector3d& position_m, double noise_m);
  /// Tells whether their variance is more than four times that of the noise: whether anything moved.
  [[nodiscard]] bool exceeds_noise() const { return squares_m2_ > 4.0 * noise_squares_m2_; }

 private:
  double count_{0.0};
  Eigen::Vector3d mean_m_{Eigen::Vector3d::Zero()};
  double squares_m2_{0.0};
  double noise_squares_m2_{0.0};
};

/// Number of samples in the window of an outlier test.
inline constexpr std::size_t kOutlierWindow{7};

/// Tells whether a sample is a gross outlier: farther from the medoid of the window than `limit` times the largest of
/// the medoid's distance to its nearest sample, the median length of the noise, and 2 cm. Independent of the world
/// frame.
[[nodiscard]] bool is_outlier(std::span<const TimedPoint, kOutlierWindow> window, std::size_t index, double noise_m,
                              double limit);

/// Returns the samples without outliers in their windows; all of them where there are fewer than a window. O(n)
[[nodiscard]] std::vector<TimedPoint> without_outliers(std::span<const TimedPoint> samples, double noise_m,
                                                       double limit);

/// Sums of a Gaussian local-linear fit around a time.
struct LocalLinearSums {
  double weight{0.0};
  double time{0.0};
  double time_squared{0.0};
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};
  Eigen::Vector3d time_position{Eigen::Vector3d::Zero()};
  double weight_squared{0.0};  ///< the first three sums with squared weights
  double squared_time{0.0};
  double squared_time_squared{0.0};
};

/// Fits a line by weighted least squares (Fan and Gijbels, Local Polynomial Modelling, 1996). Where the sums hold only
/// one time, the motion is at rest.
[[nodiscard]] SmoothedPoint solve(const LocalLinearSums& sums, double time_s, double noise_m);

/// Returns the motion every `kernel_s` / 5, from the first sample to the last: local-linear fits with a Gaussian kernel
/// of that standard deviation, over samples gathered in bins of that step. Where no sample lies within a kernel width,
/// the hand is on the straight line between its neighbours. Steps are widened to at most 8 per sample plus 4096.
/// Expects at least two samples of increasing times, and kernel_s > 0. O(n)
[[nodiscard]] std::vector<SmoothedPoint> smooth(std::span<const TimedPoint> samples, double kernel_s, double noise_m);

/// Returns the mean time between samples, s, without intervals of more than 8.5 times the median one. Expects at least
/// two samples.
[[nodiscard]] double interval_s(std::span<const TimedPoint> samples);

/// Returns the mean speed along the path, m/s: Σ v² / Σ v, so that rests do not count. 0 without motion.
[[nodiscard]] double path_speed_mps(std::span<const SmoothedPoint> motion);

/// Return the standard deviation per axis that a kernel of width h leaves of noise: for the position σ √(Δt / (2 √π
/// h)), for the velocity σ √(Δt / (4 √π h³)).
[[nodiscard]] double position_noise_m(double noise_m, double interval_s, double kernel_s);
[[nodiscard]] double velocity_noise_mps(double noise_m, double interval_s, double kernel_s);

/// Returns the standard deviation of the kernel, s: root of the sum of the squares of length_m / v and of the width h
/// at which the velocity noise is that share of the speed v. Expects v > 0.
[[nodiscard]] double kernel_width_s(const KernelConfig& config, double speed_mps, double noise_m, double interval_s);

}  // namespace saccade
