// SPDX-License-Identifier: Apache-2.0
#include "kinfu_parameters.hpp"

#include <cmath>

std::string without_slash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

KinfuParameters KinfuParameters::read(const ros::NodeHandle& node) {
  const auto text = [&](const std::string& name, const std::string& otherwise) {
    return node.param<std::string>(name, otherwise);
  };
  KinfuParameters p;
  const std::string prefix = text("prefix_topic", "/camera");
  p.depth_topic = text("depth_image_topic", prefix + "/depth/image_raw");
  p.info_topic = text("camera_info_topic", prefix + "/depth/camera_info");
  p.color_topic = text("image_topic", "");
  p.command_topic = text("command_topic", "/kinfu_command_topic");
  p.command_ack_topic = text("command_ack_topic", "/kinfu_command_ack_topic");
  p.require_reset_topic = text("require_reset_topic", "/kinfu_require_reset_topic");
  p.image_ack_topic = text("image_ack_topic", "/kinfu_image_ack");
  p.current_view_topic = text("current_view_topic", "/kinfu_current_view");
  p.icp_lost_topic = text("icp_lost_topic", "/kinfu_icp_lost_topic");
  p.first_frame = without_slash(text("first_frame_reference_name", "/kinfu_first_frame"));
  p.current_frame = without_slash(text("current_frame_reference_name", "/kinfu_current_frame"));
  p.forced_reference = without_slash(text("forced_tf_reference_frame", ""));
  if (p.forced_reference.empty()) p.forced_reference = p.first_frame;
  p.forced_current = without_slash(text("forced_tf_current_frame", ""));
  p.forced_tf = node.param("forced_tf_position", false);
  p.autostart = node.param("autostart", true);
  p.shift_checker = text("shift_checker", "DEFAULT");

  p.map.volume_size = node.param("volume_size", 3.0);
  p.map.volume_size = node.param("vs", p.map.volume_size);
  const int resolution = node.param("volume_resolution", 512);
  if (!(p.map.volume_size > 0.0) || resolution <= 0)
    throw std::invalid_argument{"volume_size and volume_resolution must be positive"};
  p.map.volume_resolution = static_cast<std::uint32_t>(resolution);
  p.map.truncation = node.param("trunc_dist", 0.0);
  p.map.minimum_motion = node.param("enable_minimum_motion", true);
  p.target_distance = node.param("target_point_distance", 0.6 * p.map.volume_size);
  p.shift_distance = node.param("shift_distance", 1.5);
  p.shift_distance = node.param("sd", p.shift_distance);
  p.map.min_range = node.param("min_range", 0.1);
  p.map.max_range = node.param("max_range", p.target_distance + 0.5 * std::sqrt(3.0) * p.map.volume_size);
  p.map.memory_limit_mb = node.param("memory_limit_mb", 4096.0);

  p.requests.action_name = text("request_action_name", "/kinfu_output/actions/request");
  p.requests.upload_name = text("world_upload_action_name", "/kinfu/world_upload");
  p.requests.topic = text("request_topic", "/kinfu_request_topic");
  p.requests.temporary_folder = text("temporary_file_dir", "/tmp");
  p.requests.largest_message_mb = node.param("largest_message_mb", 900.0);
  p.requests.frame_id = p.first_frame;
  return p;
}
