// SPDX-License-Identifier: Apache-2.0
#pragma once
// FlangeRecord: poses of a flange over time. match_clocks: offset of a camera's clock, found from turning speeds.

#include <optional>
#include <span>
#include <string>

#include "saccade/core/pose.hpp"
#include "saccade/tracking/hand_eye.hpp"
#include "saccade/tracking/internal/alignment.hpp"

namespace saccade {

/// Flange poses over time. Borrows samples with increasing times.
class FlangeRecord {
 public:
  explicit FlangeRecord(std::span<const FlangeSample> samples) : samples_{samples} {}
  [[nodiscard]] bool covers(double time_s) const;
  /// Returns the pose at a time: positions interpolated along lines, turns about one axis; at rest beyond the ends.
  /// Expects a sample. O(log samples).
  [[nodiscard]] Pose at(double time_s) const;
  /// Returns angular velocity and velocity in the flange's own frame, rad/s and m/s, from differences over 20 ms.
  [[nodiscard]] Vector6d twist_at(double time_s) const;

 private:
  std::span<const FlangeSample> samples_;
};

struct TimedPose {
  double time_s{0.0};
  Pose T_world_camera{Pose::Identity()};
};

struct ClockMatch {
  std::optional<double> offset_s;  ///< record's time = camera's time + this
  std::string why;                 ///< reason where there is no offset
};

/// Finds the offset, within ± max_offset_s, at which camera and flange turn equally fast, which holds for every mount.
/// Accurate to a few milliseconds. Says why where the turning is too slow or too even, or matches nowhere or twice.
[[nodiscard]] ClockMatch match_clocks(const FlangeRecord& record, std::span<const TimedPose> camera,
                                      double max_offset_s);

}  // namespace saccade
