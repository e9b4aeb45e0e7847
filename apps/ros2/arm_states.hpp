// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmStates: where the joints of an arm stand, picked by name from sensor_msgs/JointState.

#include <optional>
#include <string>
#include <vector>

#include "node.hpp"

namespace saccade::ros2 {

/// Messages that name some of the joints, or others besides, are merged.
class ArmStates {
 public:
  ArmStates(const Node& node, const std::string& topic, std::vector<std::string> joints);

  /// Takes what has come. Returns whether all joints are known and one of them was told anew. Throws for positions that
  /// are not finite.
  bool hear(double longest_s);

  /// In the order of the joints; radians, metres for prismatic ones.
  [[nodiscard]] const std::vector<double>& q() const { return q_; }
  /// The stamp of the latest message, on the robot's clock; nullopt: it has none.
  [[nodiscard]] std::optional<double> stamp_s() const { return stamp_s_; }
  /// How long ago the joint that was told longest ago was told; infinite: never.
  [[nodiscard]] double age_s() const;
  /// How long the joints have been standing where they are.
  [[nodiscard]] double still_s() const;
  /// Says what is missing, for an error.
  [[nodiscard]] std::string silence() const;

 private:
  void take(const messages::JointState& state);

  std::vector<std::string> joints_;
  Reader<messages::JointState> reader_;
  std::vector<double> q_;
  std::vector<double> heard_s_;  ///< for each joint
  std::optional<double> stamp_s_;
  std::vector<double> still_q_;
  double still_since_s_{0.0};
};

}  // namespace saccade::ros2
