// SPDX-License-Identifier: Apache-2.0
#pragma once
// SpeedDips: minima of a hand's speed between two times of high speed, one value at a time.

#include <optional>

#include "saccade/attention/dip_detector.hpp"

namespace saccade {

/// Finds every minimum of the speed whose drop and rise are large enough, with hysteresis as in peak detection. A dip
/// is certain once the speed has risen by that much; nothing is taken back. The first and last points are never dips.
/// Between equal minima (the floor) the dip is in the middle. O(1) per point, no further memory.
class SpeedDips {
 public:
  explicit SpeedDips(const ProminenceConfig& config) : config_{config} {}

  /// @param floor_mps  > 0; slower speeds count as this.
  /// @return the dip that this point confirms.
  std::optional<Dip> put(const SmoothedPoint& point, double floor_mps);
  /// Returns the largest speed since the last dip, or before the current one; 0 before the first point.
  [[nodiscard]] double peak_mps() const { return peak_mps_; }

 private:
  ProminenceConfig config_;
  bool falling_{false};
  double peak_mps_{0.0};
  double low_mps_{0.0};
  TimedPoint first_low_{};
  TimedPoint last_low_{};
};

}  // namespace saccade
