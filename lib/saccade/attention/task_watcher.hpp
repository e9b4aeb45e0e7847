// SPDX-License-Identifier: Apache-2.0
#pragma once
// TaskWatcher: waits for the tasks of a user's hand, and finds the regions that each may have changed. Thesis §2.2.4.

#include <functional>
#include <optional>
#include <vector>

#include "saccade/attention/hand_recorder.hpp"
#include "saccade/attention/region_of_interest.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/sensor/hand_tracker.hpp"

namespace saccade {

/// One task, from the hand's entering the workspace to its leaving.
struct UserTask {
  HandTrajectory trajectory;
  std::vector<HandAction> actions;        ///< in the order of time
  std::vector<RegionOfInterest> regions;  ///< one around each action
};

/// Finds the actions of a task: GMM-AS, ZVC, dips.
using DetectActions = std::function<Result<std::vector<HandAction>>(const HandTrajectory& trajectory)>;

/// One caller at a time.
class TaskWatcher {
 public:
  /// @param hand      outlives the watcher
  /// @param radius_m  of the ball around each action
  /// invalid_argument as HandRecorderConfig::validate(), and for a radius that is not positive.
  [[nodiscard]] static Result<TaskWatcher> create(HandTracker& hand, const HandRecorderConfig& recorder,
                                                  DetectActions detect, double radius_m = 0.2);

  /// Takes samples until a task has ended. A task without an action has no regions.
  /// @param progress asked after each sample; nullptr: never cancelled
  /// @return nullopt: the tracker has no more samples, or the caller cancelled. Errors: those of tracker and detector.
  [[nodiscard]] Result<std::optional<UserTask>> next_task(const Progress* progress = nullptr);

 private:
  TaskWatcher(HandTracker& hand, HandRecorder recorder, DetectActions detect, double radius_m)
      : hand_{&hand}, recorder_{std::move(recorder)}, detect_{std::move(detect)}, radius_m_{radius_m} {}
  /// The task that ends with the next sample, or with the last one; nullopt: none has ended.
  [[nodiscard]] Result<std::optional<HandTrajectory>> take_sample();

  HandTracker* hand_;
  HandRecorder recorder_;
  DetectActions detect_;
  double radius_m_;
  bool at_end_{false};
};

}  // namespace saccade
