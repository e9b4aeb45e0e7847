// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/dip_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <iterator>

#include "saccade/attention/internal/hand_smoothing.hpp"
#include "saccade/attention/internal/speed_dips.hpp"

namespace saccade {

namespace {

constexpr std::size_t kFewest{8};  // fewest samples of a trajectory with an action
constexpr double kShortest_s{1e-6};
constexpr int kRounds{3};             // mean speed and kernel width depend on each other
constexpr double kFirstKernel{16.0};  // sampling intervals: wide enough for noise, narrow enough for actions

/// Chooses the kernel iteratively, since speed and kernel depend on each other. 0 where the hand does not move.
double choose_kernel_s(const std::vector<TimedPoint>& samples, const DipConfig& config, DipResult& result) {
  const double duration_s = samples.back().time_s - samples.front().time_s;
  const double sampling_s = interval_s(samples);
  const double widest_s = config.max_kernel_share * duration_s;
  double kernel_s = std::min(widest_s, kFirstKernel * sampling_s);
  for (int round = 0; round < kRounds; ++round) {
    result.mean_speed_mps = path_speed_mps(smooth(samples, kernel_s, result.noise_m));
    if (!(result.mean_speed_mps > 0.0)) return 0.0;
    const double wanted_s = kernel_width_s(config.kernel, result.mean_speed_mps, result.noise_m, sampling_s);
    kernel_s = std::min(std::max(wanted_s, sampling_s), widest_s);
  }
  return kernel_s;
}

std::vector<Dip> find_dips(const std::vector<SmoothedPoint>& motion, const ProminenceConfig& config, double floor_mps) {
  std::vector<Dip> dips;
  SpeedDips finder{config};
  for (const SmoothedPoint& point : motion) {
    if (const auto dip = finder.put(point, floor_mps)) dips.push_back(*dip);
  }
  for (std::size_t i = 0; i < dips.size(); ++i) {
    dips[i].after_mps = i + 1 < dips.size() ? dips[i + 1].before_mps : finder.peak_mps();
  }
  return dips;
}

std::string in_words(const DipResult& result) {
  char text[160];
  std::snprintf(text, sizeof text,
                "%zu dips of the speed, %.2f m/s on average, smoothed over %.0f ms for %.1f mm of noise",
                result.dips.size(), result.mean_speed_mps, 1e3 * result.kernel_s, 1e3 * result.noise_m);
  return text;
}

}  // namespace

Status DipConfig::validate() const {
  for (const double value : {kernel.length_m, kernel.speed_noise_share, max_kernel_share, prominence.drop,
                             prominence.rise, speed_floor_share, outlier_limit}) {
    if (!std::isfinite(value) || !(value > 0.0)) {
      return Error{Errc::invalid_argument, "parameters of the dip detector are positive numbers", ""};
    }
  }
  if (max_kernel_share > 1.0) return Error{Errc::invalid_argument, "max_kernel_share is at most 1", ""};
  return {};
}

HandAction action_of(const Dip& dip) {
  char why[128];
  std::snprintf(why, sizeof why, "the hand slowed from %.2f to %.2f m/s and left with %.2f m/s", dip.before_mps,
                dip.speed_mps, dip.after_mps);
  return {dip.at.position_m, dip.at.time_s, dip.prominence(), why};
}

Result<DipResult> detect_dips(const HandTrajectory& trajectory, const DipConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(check_order(trajectory));
  DipResult result;
  const std::vector<TimedPoint> fresh = fresh_samples(trajectory);
  result.repeated_samples = trajectory.size() - fresh.size();
  result.noise_m = noise_deviation_m(fresh);
  const std::vector<TimedPoint> samples = without_outliers(fresh, result.noise_m, config.outlier_limit);
  result.outliers = fresh.size() - samples.size();
  if (result.outliers > 0) result.noise_m = noise_deviation_m(samples);
  if (samples.size() < kFewest || !(samples.back().time_s - samples.front().time_s > kShortest_s)) {
    result.why = "too few samples that differ: " + std::to_string(samples.size());
    return result;
  }
  result.kernel_s = choose_kernel_s(samples, config, result);
  if (result.kernel_s > 0.0) result.motion = smooth(samples, result.kernel_s, result.noise_m);
  const double noise_left_m = position_noise_m(result.noise_m, interval_s(samples), result.kernel_s);
  PositionSpread spread;
  for (const SmoothedPoint& point : result.motion) spread.add(point.position_m, noise_left_m);
  if (!spread.exceeds_noise()) {
    result.why = "the hand did not move by more than its noise";
    return result;
  }
  result.dips = find_dips(result.motion, config.prominence, config.speed_floor_share * result.mean_speed_mps);
  std::transform(result.dips.begin(), result.dips.end(), std::back_inserter(result.actions), action_of);
  result.why = in_words(result);
  return result;
}

}  // namespace saccade
