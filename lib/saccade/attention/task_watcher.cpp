// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/task_watcher.hpp"

#include <chrono>
#include <utility>

namespace saccade {

Result<std::unique_ptr<TaskWatcher>> TaskWatcher::create(std::unique_ptr<HandTracker> hand,
                                                         const HandRecorderConfig& recorder, DetectActions detect,
                                                         double radius_m, std::function<void()> on_enter) {
  SACCADE_EXPECTS(hand != nullptr && detect != nullptr);
  SACCADE_CHECK(validate(Region{Sphere{Eigen::Vector3d::Zero(), radius_m}}));
  SACCADE_TRY(HandRecorder made, HandRecorder::create(recorder));
  return std::unique_ptr<TaskWatcher>{
      new TaskWatcher{std::move(hand), std::move(made), std::move(detect), radius_m, std::move(on_enter)}};
}

TaskWatcher::TaskWatcher(std::unique_ptr<HandTracker> hand, HandRecorder recorder, DetectActions detect,
                         double radius_m, std::function<void()> on_enter)
    : hand_{std::move(hand)},
      recorder_{std::move(recorder)},
      detect_{std::move(detect)},
      radius_m_{radius_m},
      on_enter_{std::move(on_enter)},
      listener_{[this] { listen(); }} {}

TaskWatcher::~TaskWatcher() {
  stops_ = true;
  listener_.join();
}

void TaskWatcher::listen() {
  while (!stops_) {
    const auto sample = hand_->next();
    if (sample && *sample) {
      keep(recorder_.push(**sample));
      const bool inside = !recorder_.under_way().empty();
      if (inside_.exchange(inside) != inside && inside && on_enter_) on_enter_();
      continue;
    }
    if (sample) keep(recorder_.finish());
    inside_ = false;
    const std::lock_guard lock{mutex_};
    if (!sample) problem_ = sample.error();
    at_end_ = true;
    changed_.notify_one();
    return;
  }
}

void TaskWatcher::keep(std::optional<HandTrajectory> task) {
  if (!task) return;
  const std::lock_guard lock{mutex_};
  ended_.push_back(*std::move(task));
  changed_.notify_one();
}

Result<std::optional<HandTrajectory>> TaskWatcher::next_trajectory(const Progress* progress) {
  std::unique_lock lock{mutex_};
  for (;;) {
    if (progress != nullptr && progress->cancelled()) return std::optional<HandTrajectory>{};
    if (!ended_.empty()) {
      HandTrajectory task = std::move(ended_.front());
      ended_.pop_front();
      return std::optional{std::move(task)};
    }
    if (problem_) return *problem_;
    if (at_end_) return std::optional<HandTrajectory>{};
    changed_.wait_for(lock, std::chrono::milliseconds{20});
  }
}

Result<std::optional<UserTask>> TaskWatcher::next_task(const Progress* progress) {
  SACCADE_TRY(std::optional<HandTrajectory> trajectory, next_trajectory(progress));
  if (!trajectory) return std::optional<UserTask>{};
  UserTask task;
  SACCADE_TRY(task.actions, detect_(*trajectory));
  SACCADE_TRY(task.regions, regions_of_interest(task.actions, radius_m_));
  task.trajectory = *std::move(trajectory);
  return std::optional{std::move(task)};
}

}  // namespace saccade
