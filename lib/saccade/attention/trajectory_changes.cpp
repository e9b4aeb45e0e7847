// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/trajectory_changes.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/attention/seeded_random.hpp"

namespace saccade {
namespace {

HandSample between(const HandSample& a, const HandSample& b, double share) {
  HandSample sample;
  sample.time_s = a.time_s + share * (b.time_s - a.time_s);
  sample.position_m = a.position_m + share * (b.position_m - a.position_m);
  if (a.R_world_hand && b.R_world_hand) sample.R_world_hand = a.R_world_hand->slerp(share, *b.R_world_hand);
  return sample;
}

}  // namespace

Result<HandTrajectory> at_speed(const HandTrajectory& trajectory, double multiplier) {
  constexpr double kMaxSamples{1e8};
  const auto intervals = static_cast<double>(trajectory.empty() ? 0 : trajectory.size() - 1);
  if (!(multiplier > 0.0) || !std::isfinite(multiplier) || intervals * multiplier > kMaxSamples) {
    return Error{Errc::invalid_argument, "a speed multiplier must be positive, and give at most 1e8 samples", {}};
  }
  if (trajectory.size() < 2 || multiplier == 1.0) return trajectory;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(intervals * multiplier)));
  const double step = intervals / static_cast<double>(count);
  HandTrajectory resampled;
  resampled.reserve(count + 1);
  for (std::size_t i = 0; i <= count; ++i) {
    const double at = std::min(step * static_cast<double>(i), intervals);
    const std::size_t before = std::min(static_cast<std::size_t>(at), trajectory.size() - 2);
    resampled.push_back(between(trajectory[before], trajectory[before + 1], at - static_cast<double>(before)));
  }
  const double start_s = trajectory.front().time_s;
  for (HandSample& sample : resampled) sample.time_s = start_s + (sample.time_s - start_s) / step;
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
