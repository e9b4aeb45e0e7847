// SPDX-License-Identifier: Apache-2.0
#pragma once
// A robot on the side of Fast DDS: FastCamera, whose images a test makes; FastArm, a simulated
// joint_trajectory_controller.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "fast_node.hpp"
#include "robot_messagesPubSubTypes.h"

namespace saccade::test {

using FastImage = sensor_msgs::msg::dds_::Image_;
using FastInfo = sensor_msgs::msg::dds_::CameraInfo_;
using FastStates = sensor_msgs::msg::dds_::JointState_;
using FastTrajectory = trajectory_msgs::msg::dds_::JointTrajectory_;
using FastTransform = geometry_msgs::msg::dds_::TransformStamped_;

inline double wall_s() {
  return std::chrono::duration<double>{std::chrono::system_clock::now().time_since_epoch()}.count();
}

inline std_msgs::msg::dds_::Header_ header_at(double time_s, const std::string& frame) {
  std_msgs::msg::dds_::Header_ header;
  header.frame_id_(frame);
  header.stamp_().sec_(static_cast<std::int32_t>(time_s));
  header.stamp_().nanosec_(static_cast<std::uint32_t>(1e9 * (time_s - static_cast<std::int32_t>(time_s))));
  return header;
}

/// Does something again and again, in a thread, until it is destroyed.
class Repeated {
 public:
  Repeated(std::chrono::microseconds period, std::function<void()> action)
      : thread_{[period, action = std::move(action)](const std::stop_token& stop) {
          for (auto next = std::chrono::steady_clock::now(); !stop.stop_requested();) {
            action();
            std::this_thread::sleep_until(next += period);
          }
        }} {}

 private:
  std::jthread thread_;
};

inline FastInfo camera_info(std::uint32_t width, std::uint32_t height, double f, double cx, double cy) {
  FastInfo info;
  info.width_(width);
  info.height_(height);
  info.distortion_model_("plumb_bob");
  info.d_({0.0, 0.0, 0.0, 0.0, 0.0});
  info.k_({f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0});
  info.r_({1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  info.p_({f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0});
  return info;
}

/// Publishes /camera/depth and /camera/camera_info as a driver does.
class FastCamera {
 public:
  FastCamera(FastNode& node, FastInfo info, std::function<FastImage()> take, FastQos qos = {.reliable = false},
             std::chrono::milliseconds period = std::chrono::milliseconds{33})
      : images_{node, "/camera/depth", qos},
        infos_{node, "/camera/camera_info", qos},
        thread_{period, [this, info = std::move(info), take = std::move(take)] {
                  if (silent) return;
                  FastImage image = take();
                  infos_.write(info);
                  images_.write(std::move(image));
                }} {}

  std::atomic<bool> silent{false};

 private:
  FastWriter<sensor_msgs::msg::dds_::Image_PubSubType> images_;
  FastWriter<sensor_msgs::msg::dds_::CameraInfo_PubSubType> infos_;
  Repeated thread_;
};

/// Follows trajectories straight from point to point, and tells its joints in another order, with a gripper among them.
class FastArm {
 public:
  using Moved = std::function<void(const std::vector<double>& q)>;
  FastArm(FastNode& node, std::vector<std::string> names, std::vector<double> start, Moved moved = {})
      : moved_{std::move(moved)},
        names_{std::move(names)},
        q_{std::move(start)},
        states_{node, "/joint_states", {}},
        trajectories_{node, "/arm_controller/joint_trajectory", {}, [this](const FastTrajectory& t) { follow(t); }},
        thread_{std::chrono::milliseconds{5}, [this] { step(); }} {}

  std::atomic<bool> silent{false};
  std::atomic<bool> refuses{false};

  [[nodiscard]] std::vector<double> q() const {
    const std::lock_guard lock{mutex_};
    return q_;
  }
  [[nodiscard]] std::vector<FastTrajectory> heard() const {
    const std::lock_guard lock{mutex_};
    return heard_;
  }

 private:
  void follow(const FastTrajectory& trajectory) {
    const std::lock_guard lock{mutex_};
    heard_.push_back(trajectory);
    if (refuses) return;
    from_ = q_;
    began_s_ = wall_s();
    way_ = trajectory;
  }

  [[nodiscard]] std::vector<double> in_my_order(const std::vector<double>& positions) const {
    std::vector<double> q(names_.size());
    for (std::size_t i = 0; i < names_.size(); ++i) {
      for (std::size_t k = 0; k < names_.size(); ++k) {
        if (way_.joint_names_()[k] == names_[i]) q[i] = positions[k];
      }
    }
    return q;
  }

  void step() {
    const std::lock_guard lock{mutex_};
    if (!way_.points_().empty()) {
      const double t_s = wall_s() - began_s_;
      double before_s = 0.0;
      std::vector<double> a = from_;
      for (const auto& point : way_.points_()) {
        const double at_s = point.time_from_start_().sec_() + 1e-9 * point.time_from_start_().nanosec_();
        const std::vector<double> b = in_my_order(point.positions_());
        const double share = at_s > before_s ? std::clamp((t_s - before_s) / (at_s - before_s), 0.0, 1.0) : 1.0;
        for (std::size_t i = 0; i < q_.size(); ++i) q_[i] = a[i] + share * (b[i] - a[i]);
        if (t_s < at_s) break;
        a = b;
        before_s = at_s;
      }
    }
    if (moved_) moved_(q_);
    if (silent) return;
    FastStates states;
    states.header_(header_at(wall_s(), ""));
    states.name_() = {"gripper"};
    states.position_() = {0.02};
    for (std::size_t i = names_.size(); i-- > 0;) {
      states.name_().push_back(names_[i]);
      states.position_().push_back(q_[i]);
    }
    states_.write(states);
  }

  Moved moved_;
  std::vector<std::string> names_;
  mutable std::mutex mutex_;
  std::vector<double> q_, from_;
  FastTrajectory way_;
  double began_s_{0.0};
  std::vector<FastTrajectory> heard_;
  FastWriter<sensor_msgs::msg::dds_::JointState_PubSubType> states_;
  FastReader<trajectory_msgs::msg::dds_::JointTrajectory_PubSubType> trajectories_;
  Repeated thread_;
};

}  // namespace saccade::test
