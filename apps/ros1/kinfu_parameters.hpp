// SPDX-License-Identifier: Apache-2.0
#pragma once
// KinfuParameters: the node's parameters, with the author's names and defaults. C++17.

#include <ros/ros.h>

#include <string>

#include "kinfu_map.hpp"
#include "kinfu_requests.hpp"

struct KinfuParameters {
  std::string depth_topic, info_topic, color_topic;
  std::string command_topic, command_ack_topic, require_reset_topic, image_ack_topic, current_view_topic,
      icp_lost_topic;
  std::string first_frame, current_frame;        ///< names for TF, without a leading slash
  std::string forced_reference, forced_current;  ///< current empty: the image's own frame
  std::string shift_checker;
  double target_distance{0.0}, shift_distance{0.0};
  bool autostart{true}, forced_tf{false};
  saccade::ros1::KinfuConfig map;
  RequestSettings requests;

  static KinfuParameters read(const ros::NodeHandle& node);
};

/// Removes a leading slash, which tf2 does not accept.
std::string without_slash(const std::string& frame);
