// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/clock_match.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "saccade/core/angle.hpp"

namespace saccade {
namespace {

constexpr double kStep_s{0.005};
constexpr double kInterval_s{0.1};                // speeds are means over this time, which averages out tracking noise
constexpr double kMinSpeedChange_rad_s{2.0_deg};  // standard deviation of the speed of turning
constexpr std::size_t kMinIntervals{8};

struct TurnInterval {
  double from_s{0.0};
  double to_s{0.0};
  double speed_rad_s{0.0};  ///< mean speed of the camera
};

std::vector<TurnInterval> intervals_of(std::span<const TimedPose> camera) {
  std::vector<TurnInterval> intervals;
  for (std::size_t a = 0; a < camera.size(); ++a) {
    std::size_t b = a + 1;
    while (b < camera.size() && camera[b].time_s - camera[a].time_s < kInterval_s) ++b;
    if (b == camera.size()) break;
    const double duration_s = camera[b].time_s - camera[a].time_s;
    if (duration_s > 3.0 * kInterval_s) continue;  // frames were lost in between
    const double turn_rad = rotation_angle_rad(camera[a].T_world_camera.inverse() * camera[b].T_world_camera);
    intervals.push_back({camera[a].time_s, camera[b].time_s, turn_rad / duration_s});
  }
  return intervals;
}

/// Returns the mean squared difference of the turning speeds; infinite where the record covers fewer than half of the
/// intervals.
double mismatch(const FlangeRecord& record, const std::vector<TurnInterval>& intervals, double offset_s) {
  double sum{0.0};
  std::size_t count{0};
  for (const TurnInterval& interval : intervals) {
    const double from_s = interval.from_s + offset_s;
    const double to_s = interval.to_s + offset_s;
    if (!record.covers(from_s) || !record.covers(to_s)) continue;
    const double flange = rotation_angle_rad(record.at(from_s).inverse() * record.at(to_s)) / (to_s - from_s);
    sum += (flange - interval.speed_rad_s) * (flange - interval.speed_rad_s);
    ++count;
  }
  if (2 * count < intervals.size()) return std::numeric_limits<double>::infinity();
  return sum / static_cast<double>(count);
}

double variance_of(const std::vector<TurnInterval>& intervals) {
  double mean{0.0};
  for (const TurnInterval& interval : intervals) mean += interval.speed_rad_s / static_cast<double>(intervals.size());
  double variance{0.0};
  for (const TurnInterval& interval : intervals) {
    variance += (interval.speed_rad_s - mean) * (interval.speed_rad_s - mean) / static_cast<double>(intervals.size());
  }
  return variance;
}

}  // namespace

bool FlangeRecord::covers(double time_s) const {
  return !samples_.empty() && time_s >= samples_.front().time_s && time_s <= samples_.back().time_s;
}

Pose FlangeRecord::at(double time_s) const {
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), time_s,
                                      [](double time, const FlangeSample& sample) { return time < sample.time_s; });
  if (after == samples_.begin()) return samples_.front().T_base_flange;
  if (after == samples_.end()) return samples_.back().T_base_flange;
  const FlangeSample& a = *std::prev(after);
  const double share = (time_s - a.time_s) / (after->time_s - a.time_s);
  const Eigen::Quaterniond turned =
      Eigen::Quaterniond{a.T_base_flange.linear()}.slerp(share, Eigen::Quaterniond{after->T_base_flange.linear()});
  Pose T{Pose::Identity()};
  T.linear() = turned.toRotationMatrix();
  T.translation() = (1.0 - share) * a.T_base_flange.translation() + share * after->T_base_flange.translation();
  return T;
}

Vector6d FlangeRecord::twist_at(double time_s) const {
  constexpr double kHalf_s{0.01};
  const Pose T_before_after = at(time_s - kHalf_s).inverse() * at(time_s + kHalf_s);
  const Eigen::AngleAxisd turn{T_before_after.linear()};
  Vector6d twist;
  twist << turn.angle() * turn.axis(), T_before_after.translation();
  return twist / (2.0 * kHalf_s);
}

ClockMatch match_clocks(const FlangeRecord& record, std::span<const TimedPose> camera, double max_offset_s) {
  const std::vector<TurnInterval> intervals = intervals_of(camera);
  if (intervals.size() < kMinIntervals) return {{}, "too few frames of the motion could be tracked"};
  const double variance = variance_of(intervals);
  if (variance < kMinSpeedChange_rad_s * kMinSpeedChange_rad_s) {
    return {{}, "the camera's speed of turning hardly changed; start, stop and turn during the motion"};
  }
  const int steps = static_cast<int>(std::ceil(max_offset_s / kStep_s));
  std::vector<double> cost;
  for (int step = -steps; step <= steps; ++step) cost.push_back(mismatch(record, intervals, step * kStep_s));
  const auto best = static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  if (!std::isfinite(cost[best])) return {{}, "the flange's record does not cover the frames' times"};
  if (cost[best] > 0.5 * variance) return {{}, "the turning of camera and flange matches at no offset of the clocks"};
  if (best == 0 || best + 1 == cost.size() || !std::isfinite(cost[best - 1]) || !std::isfinite(cost[best + 1])) {
    return {{}, "the clocks differ by more than the offsets that were tried, or the flange's record is too short"};
  }
  const auto apart = static_cast<std::size_t>(std::lround(0.15 / kStep_s));
  for (std::size_t i = 1; i + 1 < cost.size(); ++i) {
    const bool far = i + apart < best || i > best + apart;
    const bool dip = cost[i] < cost[i - 1] && cost[i] < cost[i + 1];
    if (far && dip && cost[i] < 2.0 * cost[best] + 0.02 * variance) {
      return {{}, "the motion repeats itself, so that two offsets of the clocks match; move less evenly"};
    }
  }
  const double bend = cost[best - 1] - 2.0 * cost[best] + cost[best + 1];
  const double peak = bend > 0.0 ? 0.5 * (cost[best - 1] - cost[best + 1]) / bend : 0.0;
  return {(static_cast<double>(best) - steps + peak) * kStep_s, {}};
}

}  // namespace saccade
