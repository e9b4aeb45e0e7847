// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/internal/speed_dips.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {

double Dip::prominence() const { return std::log(std::min(before_mps, after_mps) / speed_mps); }

std::optional<Dip> SpeedDips::put(const SmoothedPoint& point, double floor_mps) {
  const double speed_mps = std::max(point.speed_mps, floor_mps);
  if (!falling_) {
    peak_mps_ = std::max(peak_mps_, speed_mps);
    falling_ = std::log(peak_mps_ / speed_mps) >= config_.drop;
    if (!falling_) return std::nullopt;
    low_mps_ = speed_mps;
    first_low_ = {point.time_s, point.position_m};
  }
  if (speed_mps < low_mps_) {
    low_mps_ = speed_mps;
    first_low_ = {point.time_s, point.position_m};
  }
  if (speed_mps <= low_mps_) last_low_ = {point.time_s, point.position_m};
  if (std::log(speed_mps / low_mps_) < config_.rise) return std::nullopt;
  const TimedPoint middle{0.5 * (first_low_.time_s + last_low_.time_s),
                          0.5 * (first_low_.position_m + last_low_.position_m)};
  const Dip dip{middle, low_mps_, peak_mps_, speed_mps};
  falling_ = false;
  peak_mps_ = speed_mps;
  return dip;
}

}  // namespace saccade
