// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/zvc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {
namespace {

std::vector<Eigen::Vector3d> mean_filtered(const HandTrajectory& trajectory, int half_window) {
  const auto last = static_cast<std::ptrdiff_t>(trajectory.size()) - 1;
  std::vector<Eigen::Vector3d> smooth;
  smooth.reserve(trajectory.size());
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::ptrdiff_t j = i - half_window; j <= i + half_window; ++j) {
      sum += trajectory[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(j, 0, last))].position_m;
    }
    smooth.emplace_back(sum / (2.0 * half_window + 1.0));
  }
  return smooth;
}

/// Neighbourhood R_i(r): samples first … last, eq. 2.15.
struct Neighbourhood {
  std::size_t first{0};
  std::size_t last{0};
};

/// Grows a neighbourhood while every sample in between lies within the radius of sample i.
Neighbourhood grown(const std::vector<Eigen::Vector3d>& q, std::size_t i, double radius_m, Neighbourhood from) {
  const double squared = radius_m * radius_m;
  const auto within = [&](std::size_t k) { return (q[k] - q[i]).squaredNorm() < squared; };
  while (from.first > 0 && within(from.first - 1)) --from.first;
  while (from.last + 1 < q.size() && within(from.last + 1)) ++from.last;
  return from;
}

std::string reason(double ratio, double near_m, double far_m) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "within %.0f cm %.2f times as slow as within %.0f cm", 100.0 * near_m, ratio,
                100.0 * far_m);
  return text.data();
}

}  // namespace

ZvcConfig ZvcConfig::as_printed() {
  ZvcConfig config;
  config.threshold = 1.72;
  config.drop_at_ends = false;
  return config;
}

Status ZvcConfig::validate() const {
  if (half_window < 0 || !(near_m > 0.0) || !(far_m > near_m) || !(threshold > 0.0)) {
    return Error{Errc::invalid_argument, "0 <= half_window, 0 < near_m < far_m and 0 < threshold are needed",
                 "ZvcConfig"};
  }
  return {};
}

Result<ZvcResult> detect_by_zvc(const HandTrajectory& trajectory, const ZvcConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(validate(trajectory));
  ZvcResult result;
  if (trajectory.size() < 2) return result;
  const std::size_t n = trajectory.size();
  const std::vector<Eigen::Vector3d> q = mean_filtered(trajectory, config.half_window);

  // Sums of the speeds of samples 1 … i; sample 0 has none.
  std::vector<double> speed_sum(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    speed_sum[i] = speed_sum[i - 1] + (q[i] - q[i - 1]).norm() / (trajectory[i].time_s - trajectory[i - 1].time_s);
  }
  const auto mean_speed = [&](const Neighbourhood& near) {  // eq. 2.14
    const std::size_t before = std::max<std::size_t>(near.first, 1) - 1;
    return near.last > before ? (speed_sum[near.last] - speed_sum[before]) / static_cast<double>(near.last - before)
                              : 0.0;
  };

  bool was_slow{false};
  for (std::size_t i = 0; i < n; ++i) {
    const Neighbourhood near = grown(q, i, config.near_m, {i, i});
    const Neighbourhood far = grown(q, i, config.far_m, near);
    result.near_speed_m_s.push_back(mean_speed(near));
    result.far_speed_m_s.push_back(mean_speed(far));
    const bool is_slow = result.near_speed_m_s[i] * config.threshold < result.far_speed_m_s[i];
    if (is_slow) {
      if (!was_slow) result.segments.push_back({i, i, false});
      SlowSegment& segment = result.segments.back();
      segment.last = i;
      segment.at_end = segment.at_end || near.first == 0 || near.last == n - 1;
    }
    was_slow = is_slow;
  }
  for (const SlowSegment& segment : result.segments) {
    if (segment.at_end && config.drop_at_ends) continue;
    const std::size_t middle = (segment.first + segment.last) / 2;
    const double near_m_s = std::max(result.near_speed_m_s[middle], 1e-9);
    const double ratio = result.far_speed_m_s[middle] / near_m_s;
    result.actions.push_back({q[middle], trajectory[middle].time_s, ratio, reason(ratio, config.near_m, config.far_m)});
  }
  return result;
}

}  // namespace saccade
