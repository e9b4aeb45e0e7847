// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/task_watcher.hpp"

#include <utility>

namespace saccade {

Result<TaskWatcher> TaskWatcher::create(HandTracker& hand, const HandRecorderConfig& recorder, DetectActions detect,
                                        double radius_m) {
  SACCADE_EXPECTS(detect != nullptr);
  SACCADE_CHECK(validate(Region{Sphere{Eigen::Vector3d::Zero(), radius_m}}));
  SACCADE_TRY(HandRecorder made, HandRecorder::create(recorder));
  return TaskWatcher{hand, std::move(made), std::move(detect), radius_m};
}

Result<std::optional<HandTrajectory>> TaskWatcher::take_sample() {
  SACCADE_TRY(const std::optional<HandSample> sample, hand_->next());
  if (sample) return recorder_.push(*sample);
  at_end_ = true;
  return recorder_.finish();
}

Result<std::optional<UserTask>> TaskWatcher::next_task(const Progress* progress) {
  while (!at_end_ && (progress == nullptr || !progress->cancelled())) {
    SACCADE_TRY(std::optional<HandTrajectory> trajectory, take_sample());
    if (!trajectory) continue;
    UserTask task;
    SACCADE_TRY(task.actions, detect_(*trajectory));
    SACCADE_TRY(task.regions, regions_of_interest(task.actions, radius_m_));
    task.trajectory = *std::move(trajectory);
    return std::optional{std::move(task)};
  }
  return std::optional<UserTask>{};
}

}  // namespace saccade
