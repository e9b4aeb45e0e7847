// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmStates: joint positions of an arm, picked by name from sensor_msgs/JointState.

#include <optional>
#include <string>
#include <vector>

#include "node.hpp"

namespace saccade::ros2 {

/// States of the joints. Messages with only some of the joints, or with others besides, are merged.
class ArmStates {
 public:
  ArmStates(const Node& node, const std::string& topic, std::vector<std::string> joints);

  /// Handles received messages. Returns whether all joints are known and one of them has new data. Throws for positions
  /// that are not finite.
  bool hear(double longest_s);

  /// Returns the positions in the order of the joints; radians, metres for prismatic ones.
  [[nodiscard]] const std::vector<double>& q() const { return q_; }
  /// Returns the stamp of the latest message, on the robot's clock; nullopt where it has none.
  [[nodiscard]] std::optional<double> stamp_s() const { return stamp_s_; }
  /// Returns the age of the oldest joint's data; infinite where there is none.
  [[nodiscard]] double age_s() const;
  /// Returns how long the joints have been still.
  [[nodiscard]] double still_s() const;
  /// Describes what is missing, for an error.
  [[nodiscard]] std::string silence() const;

 private:
  void take(const messages::JointState& state);

  std::vector<std::string> joints_;
  Reader<messages::JointState> reader_;
  std::vector<double> q_;
  std::vector<double> heard_s_;  ///< per joint
  std::optional<double> stamp_s_;
  std::vector<double> still_q_;
  double still_since_s_{0.0};
};

}  // namespace saccade::ros2
