// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/detector_evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/seeded_random.hpp"

namespace saccade {
namespace {

/// Makes the hand faster: takes the samples at steps of 1 / multiplier, rounded down.
HandTrajectory left_out(const HandTrajectory& trajectory, double multiplier) {
  HandTrajectory fewer;
  for (std::size_t i = 0; static_cast<double>(i) / multiplier < static_cast<double>(trajectory.size()); ++i) {
    fewer.push_back(trajectory[static_cast<std::size_t>(static_cast<double>(i) / multiplier)]);
  }
  return fewer;
}

HandSample between(const HandSample& a, const HandSample& b, double share) {
  HandSample sample;
  sample.time_s = a.time_s + share * (b.time_s - a.time_s);
  sample.position_m = a.position_m + share * (b.position_m - a.position_m);
  if (a.R_world_hand && b.R_world_hand) sample.R_world_hand = a.R_world_hand->slerp(share, *b.R_world_hand);
  return sample;
}

/// Makes the hand slower: more samples, from end to end.
HandTrajectory interpolated(const HandTrajectory& trajectory, double multiplier) {
  const auto intervals = static_cast<double>(trajectory.size() - 1);
  const auto count = static_cast<std::size_t>(std::round(intervals * multiplier));
  const double step = intervals / static_cast<double>(count);
  HandTrajectory more;
  more.reserve(count + 1);
  for (std::size_t i = 0; i <= count; ++i) {
    const double at = std::min(step * static_cast<double>(i), intervals);
    const std::size_t before = std::min(static_cast<std::size_t>(at), trajectory.size() - 2);
    more.push_back(between(trajectory[before], trajectory[before + 1], at - static_cast<double>(before)));
  }
  return more;
}

}  // namespace

Result<HandTrajectory> at_speed(const HandTrajectory& trajectory, double multiplier) {
  constexpr double kMaxSamples{1e8};
  if (!(multiplier > 0.0) || !std::isfinite(multiplier) ||
      static_cast<double>(trajectory.size()) * multiplier > kMaxSamples) {
    return Error{Errc::invalid_argument, "a speed multiplier must be positive, and give at most 1e8 samples", {}};
  }
  if (trajectory.size() < 2 || multiplier == 1.0) return trajectory;
  HandTrajectory resampled = multiplier < 1.0 ? left_out(trajectory, multiplier) : interpolated(trajectory, multiplier);
  const double start_s = trajectory.front().time_s;
  for (HandSample& sample : resampled) sample.time_s = start_s + (sample.time_s - start_s) * multiplier;
  return resampled;
}

Result<HandTrajectory> with_noise(HandTrajectory trajectory, double sigma_m, std::uint64_t seed) {
  if (!(sigma_m >= 0.0) || !std::isfinite(sigma_m)) {
    return Error{Errc::invalid_argument, "the standard deviation of noise must be finite and not negative", {}};
  }
  if (sigma_m == 0.0) return trajectory;
  SeededRandom random{seed};
  for (HandSample& sample : trajectory) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) sample.position_m[axis] += sigma_m * random.normal();
  }
  return trajectory;
}

}  // namespace saccade
