// SPDX-License-Identifier: Apache-2.0
#pragma once
// JointStates: the positions of named joints, from messages that list them in any order and may be incomplete.

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "../../devices/protocol.hpp"
#include "connection.hpp"

namespace saccade::ros1 {

struct JointPositions {
  std::vector<double> q;
  double time_s{0.0};  ///< stamp of the latest message
  double came_s{0.0};  ///< on this machine's steady clock; arrival of the joint that has waited longest
};

class JointStates {
 public:
  void name(const std::vector<std::string>& joints) {
    const std::lock_guard lock{mutex_};
    names_ = joints;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  void take(const sensor_msgs::JointStateConstPtr& state) {
    const std::lock_guard lock{mutex_};
    const double came_s = devices::now_s();
    for (std::size_t i = 0; i < std::min(state->name.size(), state->position.size()); ++i) {
      joints_[state->name[i]] = {state->position[i], came_s};
    }
    time_s_ = state->header.stamp.toSec();
    came_.notify_all();
  }

  /// Returns all positions, if each came after that instant. Throws for a position that is not a number.
  [[nodiscard]] std::optional<JointPositions> after(double instant_s) const {
    const std::lock_guard lock{mutex_};
    return find(instant_s);
  }
  [[nodiscard]] std::optional<JointPositions> wait_after(double instant_s, double wait_s) const {
    std::unique_lock lock{mutex_};
    std::optional<JointPositions> found;
    came_.wait_for(lock, std::chrono::duration<double>{wait_s}, [&] { return (found = find(instant_s)).has_value(); });
    return found;
  }

  /// Describes for an error which joints are missing, or that nothing arrives.
  [[nodiscard]] std::string silence(const std::string& topic) const {
    const std::lock_guard lock{mutex_};
    if (joints_.empty()) {
      return "no positions came on " + topic +
             "; topics with joint states: " + listed(topics_of_type("sensor_msgs/JointState"));
    }
    std::vector<std::string> there;
    for (const auto& [name, joint] : joints_) there.push_back(name);
    double oldest_s = devices::now_s();
    for (const std::string& name : names_) {
      const auto found = joints_.find(name);
      if (found == joints_.end()) return topic + " has no joint '" + name + "'; it has " + listed(there);
      oldest_s = std::min(oldest_s, found->second.came_s);
    }
    return "no positions come on " + topic + " any more; the last ones came " +
           seconds_text(devices::now_s() - oldest_s) + " s ago";
  }

 private:
  struct Joint {
    double position{0.0};
    double came_s{0.0};
  };
  [[nodiscard]] std::optional<JointPositions> find(double instant_s) const {
    JointPositions all{{}, time_s_, devices::now_s()};
    for (const std::string& name : names_) {
      const auto found = joints_.find(name);
      if (found == joints_.end() || found->second.came_s <= instant_s) return std::nullopt;
      if (!std::isfinite(found->second.position))
        throw std::runtime_error{name + " stands at a position that is not a number"};
      all.q.push_back(found->second.position);
      all.came_s = std::min(all.came_s, found->second.came_s);
    }
    return all;
  }

  std::vector<std::string> names_;
  mutable std::mutex mutex_;
  mutable std::condition_variable came_;
  std::map<std::string, Joint> joints_;
  double time_s_{0.0};
};

}  // namespace saccade::ros1
