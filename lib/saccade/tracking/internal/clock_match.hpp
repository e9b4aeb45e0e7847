// SPDX-License-Identifier: Apache-2.0
#pragma once
// FlangeRecord: where a flange was at a time; match_clocks: the offset of a camera's clock by speeds of turning.

#include <optional>
#include <span>
#include <string>

#include "saccade/core/pose.hpp"
#include "saccade/tracking/hand_eye.hpp"
#include "saccade/tracking/internal/alignment.hpp"

namespace saccade {

/// Borrows samples whose times rise.
class FlangeRecord {
 public:
  explicit FlangeRecord(std::span<const FlangeSample> samples) : samples_{samples} {}
  [[nodiscard]] bool covers(double time_s) const;
  /// Interpolates between samples, positions along lines and turns about one axis; stands still beyond the ends.
  /// Expects a sample. O(log samples).
  [[nodiscard]] Pose at(double time_s) const;
  /// Turning velocity and velocity, in the flange's own frame, rad/s and m/s; from differences over 20 ms.
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
  std::string why;                 ///< where there is none
};

/// Finds the offset, within ± max_offset_s, at which camera and flange turn equally fast; that is the same whatever the
/// mount. To a few milliseconds. Says why where the turning is too little or too even, or matches nowhere or twice.
[[nodiscard]] ClockMatch match_clocks(const FlangeRecord& record, std::span<const TimedPose> camera,
                                      double max_offset_s);

}  // namespace saccade
