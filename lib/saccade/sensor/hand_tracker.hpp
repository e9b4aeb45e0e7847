// SPDX-License-Identifier: Apache-2.0
#pragma once
// HandTracker: source of a hand's motion, sample by sample. RecordedHand: plays a recording.

#include <optional>

#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// Source of hand samples. One caller at a time.
class HandTracker {
 public:
  virtual ~HandTracker() = default;
  /// Waits for the next sample.
  /// @return nullopt at the end; an Error means that the tracker failed.
  [[nodiscard]] virtual Result<std::optional<HandSample>> next() = 0;
};

/// Recorded hand. With an empty recording the hand never appears.
class RecordedHand final : public HandTracker {
 public:
  explicit RecordedHand(HandTrajectory trajectory = {}) : trajectory_{std::move(trajectory)} {}
  [[nodiscard]] Result<std::optional<HandSample>> next() override {
    return next_ < trajectory_.size() ? std::optional{trajectory_[next_++]} : std::nullopt;
  }

 private:
  HandTrajectory trajectory_;
  std::size_t next_{0};
};

}  // namespace saccade
