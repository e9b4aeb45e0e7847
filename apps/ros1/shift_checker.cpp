// SPDX-License-Identifier: Apache-2.0
#include "shift_checker.hpp"

#include <kinfu_msgs/CheckForShift.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "kinfu_messages.hpp"

namespace {

/// Returns the point that the camera looks at.
std::array<double, 3> target_of(const saccade::ros1::PlainPose& camera, double distance) {
  std::array<double, 3> target = camera.translation;
  for (std::size_t i = 0; i < 3; ++i) target[i] += distance * camera.linear[3 * i + 2];
  return target;
}

double distance_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

ShiftChecker::ShiftChecker(ros::NodeHandle node, const std::string& description, double target_distance,
                           double shift_distance)
    : node_{node}, target_distance_{target_distance}, shift_distance_{shift_distance} {
  std::istringstream words{description};
  std::string kind;
  words >> kind;
  if (kind == "DEFAULT") {
  } else if (kind == "NEVER") {
    kind_ = Kind::never;
  } else if (kind == "FIXED" && words >> fixed_[0] >> fixed_[1] >> fixed_[2]) {
    kind_ = Kind::fixed;
  } else if (kind == "ROSSERVICE" && words >> period_s_ >> service_ && period_s_ > 0.0) {
    kind_ = Kind::service;
    thread_ = std::thread{[this] { ask_service(); }};
  } else {
    throw std::invalid_argument{"shift_checker is '" + description +
                                "', not DEFAULT, NEVER, FIXED x y z, or ROSSERVICE seconds service"};
  }
}

ShiftChecker::~ShiftChecker() {
  {
    const std::scoped_lock lock{mutex_};
    stop_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ShiftChecker::reset() {
  const std::scoped_lock lock{mutex_};
  center_.reset();
}

std::optional<std::array<double, 3>> ShiftChecker::follow(const saccade::ros1::PlainPose& camera) {
  const std::scoped_lock lock{mutex_};
  camera_ = camera;
  const std::array<double, 3> target = target_of(camera, target_distance_);
  const bool far = center_ && kind_ == Kind::by_distance && distance_between(*center_, target) > shift_distance_;
  if (!center_ || far) {
    center_ = kind_ == Kind::fixed ? fixed_ : target;
    changed_ = true;
  }
  if (!changed_) return std::nullopt;
  changed_ = false;
  return center_;
}

void ShiftChecker::ask_service() {
  ros::ServiceClient client = node_.serviceClient<kinfu_msgs::CheckForShift>(service_);
  const auto period = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>{period_s_});
  std::unique_lock lock{mutex_};
  while (!wake_.wait_for(lock, period, [this] { return stop_; })) {
    if (!center_) continue;
    kinfu_msgs::CheckForShift check;
    check.request.cam_pose = to_message(camera_);
    check.request.current_center.x = (*center_)[0];
    check.request.current_center.y = (*center_)[1];
    check.request.current_center.z = (*center_)[2];
    lock.unlock();
    const bool answered = client.call(check);
    if (!answered)
      ROS_WARN_THROTTLE(30.0, "the service %s does not answer; the volume stays where it is", service_.c_str());
    lock.lock();
    const auto& to = check.response.new_center;
    if (!answered || !check.response.do_shift || !center_) continue;
    if (!std::isfinite(to.x + to.y + to.z)) {
      ROS_WARN_THROTTLE(30.0, "the service %s answered a centre that is not finite", service_.c_str());
      continue;
    }
    center_ = {to.x, to.y, to.z};
    changed_ = true;
  }
}
