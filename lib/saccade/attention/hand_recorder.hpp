// SPDX-License-Identifier: Apache-2.0
#pragma once
// HandRecorder: cuts the stream of a motion sensor into tasks, from the hand's entry into the workspace to its exit.

#include <optional>

#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

struct HandRecorderConfig {
  Box workspace{};                     ///< world frame, metres
  double margin_m{0.02};               ///< a hand that entered has left when it is outside by more than this
  double dropout_s{0.5};               ///< longest time without a good sample, or outside, within a task
  std::size_t min_samples{2};          ///< shorter tasks are ignored: the hand only brushed the border
  std::size_t max_samples{1'000'000};  ///< a task that lasts longer ends there

  /// Answers invalid_argument for an empty box or a value out of range.
  [[nodiscard]] Status validate() const;
};

/// Recorder of tasks. Thesis §2.2.4, Fig. 2.6. A task begins with the first good sample inside the workspace. It ends
/// with the last one before the hand was outside, or sent no samples, for longer than `dropout_s`. Samples that are not
/// finite, or whose time does not increase, are counted and dropped; where only the position is not finite, time
/// passes.
class HandRecorder {
 public:
  /// invalid_argument as validate().
  [[nodiscard]] static Result<HandRecorder> create(HandRecorderConfig config);

  /// Takes the next sample of the stream. Returns a task if this sample ended one. Amortised O(1).
  [[nodiscard]] std::optional<HandTrajectory> push(const HandSample& sample);

  /// Ends the stream. Returns the current task, if there is one.
  [[nodiscard]] std::optional<HandTrajectory> finish();

  /// Returns the samples of the current task so far; those after its last one inside may yet be dropped.
  [[nodiscard]] const HandTrajectory& under_way() const { return task_; }
  [[nodiscard]] std::size_t bad_samples() const { return bad_samples_; }

 private:
  explicit HandRecorder(HandRecorderConfig config) : config_{std::move(config)} {}
  [[nodiscard]] bool is_inside(const HandSample& sample) const;

  HandRecorderConfig config_;
  HandTrajectory task_;
  std::size_t inside_{0};  ///< samples of task_ up to the last one inside
  std::optional<double> last_time_s_;
  std::size_t bad_samples_{0};
};

}  // namespace saccade
