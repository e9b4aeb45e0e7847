// SPDX-License-Identifier: Apache-2.0
#pragma once
// TaskWatcher: waits for the tasks of a user's hand, and finds the regions that each may have changed. Thesis §2.2.4.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "saccade/attention/hand_recorder.hpp"
#include "saccade/attention/region_of_interest.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/sensor/hand_tracker.hpp"

namespace saccade {

/// One task, from the hand's entry into the workspace to its exit.
struct UserTask {
  HandTrajectory trajectory;
  std::vector<HandAction> actions;        ///< in order of time
  std::vector<RegionOfInterest> regions;  ///< one around each action
};

/// Detector of a task's actions: GMM-AS, ZVC, dips.
using DetectActions = std::function<Result<std::vector<HandAction>>(const HandTrajectory& trajectory)>;

/// Watcher that listens to the tracker on its own thread, so that it notices a hand while the robot works. One caller
/// at a time, except for hand_inside().
class TaskWatcher {
 public:
  /// @param radius_m  radius of the ball around each action
  /// @param on_enter  called from the listening thread when the hand enters the workspace; may be empty
  /// Answers invalid_argument as HandRecorderConfig::validate(), and for a radius that is not positive.
  [[nodiscard]] static Result<std::unique_ptr<TaskWatcher>> create(std::unique_ptr<HandTracker> hand,
                                                                   const HandRecorderConfig& recorder,
                                                                   DetectActions detect, double radius_m = 0.2,
                                                                   std::function<void()> on_enter = {});
  TaskWatcher(const TaskWatcher&) = delete;
  TaskWatcher& operator=(const TaskWatcher&) = delete;
  /// Waits until the tracker delivers its next sample, or fails to.
  ~TaskWatcher();

  /// Waits for the next finished task. A task without an action has no regions.
  /// @param progress polled every 20 ms; nullptr: never cancelled
  /// @return nullopt: the tracker has no more samples, or the caller cancelled. Errors: those of tracker and detector.
  [[nodiscard]] Result<std::optional<UserTask>> next_task(const Progress* progress = nullptr);

  /// Tells whether a task is in progress, so that frames should not be fused.
  [[nodiscard]] bool hand_inside() const { return inside_.load(); }

 private:
  TaskWatcher(std::unique_ptr<HandTracker> hand, HandRecorder recorder, DetectActions detect, double radius_m,
              std::function<void()> on_enter);
  void listen();
  void keep(std::optional<HandTrajectory> task);
  [[nodiscard]] Result<std::optional<HandTrajectory>> next_trajectory(const Progress* progress);

  std::unique_ptr<HandTracker> hand_;
  HandRecorder recorder_;  ///< used only by the listening thread
  DetectActions detect_;
  double radius_m_;
  std::function<void()> on_enter_;
  std::atomic<bool> inside_{false};
  std::atomic<bool> stops_{false};

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<HandTrajectory> ended_;
  std::optional<Error> problem_;
  bool at_end_{false};
  std::thread listener_;  // last: it uses all other members
};

}  // namespace saccade
