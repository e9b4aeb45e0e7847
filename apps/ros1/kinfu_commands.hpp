// SPDX-License-Identifier: Apache-2.0
#pragma once
// KinfuCommands: the author's ten commands, and their effect on the following frames. C++17.

#include <kinfu_msgs/KinfuCommand.h>
#include <ros/ros.h>

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "kinfu_map.hpp"

class KinfuCommands {
 public:
  KinfuCommands(ros::NodeHandle node, saccade::ros1::KinfuMap& map, const std::string& topic,
                const std::string& ack_topic, bool running, bool forced_tf, std::function<void()> on_reset);

  /// Instructions for the next frame.
  struct Turn {
    bool wanted{false};
    bool forced_tf{false};
    saccade::ros1::Hint hint{saccade::ros1::Hint::none};
    saccade::ros1::PlainPose pose;
  };
  /// Returns the instructions, including the pending hint.
  Turn next_turn();
  /// Reports that a frame was tracked, or lost: acknowledges a trigger.
  void frame_done(bool ok);

 private:
  void on_command(const kinfu_msgs::KinfuCommand& command);
  void take_hint(const kinfu_msgs::KinfuCommand& command);
  bool trigger(const std::string& id);
  void acknowledge(const std::string& id, bool ok);

  saccade::ros1::KinfuMap& map_;
  std::function<void()> on_reset_;
  ros::Publisher acks_;
  std::mutex mutex_;
  bool running_;
  bool forced_tf_;
  std::optional<std::string> trigger_;
  std::optional<kinfu_msgs::KinfuCommand> hint_;  ///< until it expires or a frame uses it
  ros::Subscriber subscriber_;
};
