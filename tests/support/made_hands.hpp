// SPDX-License-Identifier: Apache-2.0
#pragma once
// Made-up hands that stop at known places, and the smoothing of their motion without bins.

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "saccade/attention/internal/hand_smoothing.hpp"

namespace saccade::test {

/// How a made-up hand moves.
struct HandPace {
  double move_s{0.8};
  double stay_s{0.2};
  double interval_s{0.01};
};

/// From the first place to the last, with a stop of stay_s at each in between; between two of them the hand moves on a
/// straight line with the least jerk.
inline HandTrajectory hand_through(std::span<const Eigen::Vector3d> places_m, const HandPace& pace = {}) {
  HandTrajectory hand;
  const double lap_s = pace.move_s + pace.stay_s;
  const double end_s = lap_s * static_cast<double>(places_m.size() - 1) - pace.stay_s;
  for (double time_s = 0.0; time_s <= end_s; time_s = pace.interval_s * static_cast<double>(hand.size())) {
    const auto from = std::min(static_cast<std::size_t>(time_s / lap_s), places_m.size() - 2);
    const double t = std::min(1.0, (time_s - lap_s * static_cast<double>(from)) / pace.move_s);
    const double share = t * t * t * (10.0 + t * (6.0 * t - 15.0));
    hand.push_back({time_s, (1.0 - share) * places_m[from] + share * places_m[from + 1], {}});
  }
  return hand;
}

/// Places on a table, from one to the next at least 0.5 m apart.
inline std::vector<Eigen::Vector3d> places_on_table(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> across_m{-0.6, 0.6};
  std::uniform_real_distribution<double> up_m{0.0, 0.3};
  std::vector<Eigen::Vector3d> places_m;
  while (places_m.size() < count) {
    const Eigen::Vector3d place_m{across_m(random), across_m(random), up_m(random)};
    if (places_m.empty() || (place_m - places_m.back()).norm() >= 0.5) places_m.push_back(place_m);
  }
  return places_m;
}

inline void add_noise(HandTrajectory& hand, double noise_m, std::mt19937_64& random) {
  std::normal_distribution<double> noise{0.0, noise_m};
  for (HandSample& sample : hand) {
    for (double& coordinate : sample.position_m) coordinate += noise(random);
  }
}

/// One fit of smooth, over all samples.
inline SmoothedPoint smoothed_at(std::span<const TimedPoint> samples, double time_s, double kernel_s, double noise_m) {
  LocalLinearSums sums;
  for (const TimedPoint& sample : samples) {
    const double t = sample.time_s - time_s;
    const double w = std::exp(-0.5 * t * t / (kernel_s * kernel_s));
    sums.weight += w;
    sums.time += w * t;
    sums.time_squared += w * t * t;
    sums.position += w * sample.position_m;
    sums.time_position += w * t * sample.position_m;
    sums.weight_squared += w * w;
    sums.squared_time += w * w * t;
    sums.squared_time_squared += w * w * t * t;
  }
  return solve(sums, time_s, noise_m);
}

}  // namespace saccade::test
