// SPDX-License-Identifier: Apache-2.0
#pragma once
// ShiftChecker: where the centre of the volume kept in memory should be. C++17.

#include <ros/ros.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "kinfu_types.hpp"

/// Rule given by the parameter shift_checker: DEFAULT, NEVER, FIXED x y z, or ROSSERVICE seconds service.
class ShiftChecker {
 public:
  /// Throws std::invalid_argument.
  ShiftChecker(ros::NodeHandle node, const std::string& description, double target_distance, double shift_distance);
  ~ShiftChecker();
  /// Takes the camera's pose; returns the centre if it changed. Never waits for a service.
  std::optional<std::array<double, 3>> follow(const saccade::ros1::PlainPose& camera);
  /// Makes the next pose place the volume anew.
  void reset();

 private:
  enum class Kind { by_distance, never, fixed, service };
  void ask_service();

  ros::NodeHandle node_;
  Kind kind_{Kind::by_distance};
  double target_distance_, shift_distance_;
  std::array<double, 3> fixed_{};
  double period_s_{1.0};
  std::string service_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<std::array<double, 3>> center_;
  bool changed_{false};
  saccade::ros1::PlainPose camera_;
  bool stop_{false};
  std::thread thread_;
};
