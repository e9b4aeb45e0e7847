// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion between messages of ROS and the plain types. C++17.

#include <geometry_msgs/Pose.h>
#include <kinfu_msgs/KinfuCommand.h>
#include <kinfu_msgs/KinfuTsdfRequest.h>
#include <kinfu_msgs/RequestResult.h>
#include <kinfu_msgs/WorldUploadGoal.h>

#include <functional>
#include <string>
#include <vector>

#include "kinfu_map.hpp"

/// Names of frames in answers.
struct AnswerHeader {
  std::string frame_id;
  ros::Time stamp;
};

saccade::ros1::MapRequest to_plain(const kinfu_msgs::KinfuTsdfRequest& request);
/// Returns an error text for a bad message.
std::string to_plain(const kinfu_msgs::WorldUploadGoal& goal, saccade::ros1::MapUpload& upload);
geometry_msgs::Pose to_message(const saccade::ros1::PlainPose& pose);
saccade::ros1::PlainPose to_plain(const geometry_msgs::Pose& pose);
/// Returns the pose hint of a command.
saccade::ros1::PlainPose hint_of(const kinfu_msgs::KinfuCommand& command);

kinfu_msgs::RequestResult to_message(const saccade::ros1::MapAnswer& answer,
                                     const kinfu_msgs::KinfuTsdfRequest& request, const AnswerHeader& header);
sensor_msgs::PointCloud2 to_message(const saccade::ros1::PlainCloud& cloud, const AnswerHeader& header);
sensor_msgs::Image to_image(const saccade::ros1::MapAnswer& answer, const AnswerHeader& header);

/// Calls visit(values of these fields) for each point; returns an error text for a bad cloud. Float fields only.
std::string read_points(const sensor_msgs::PointCloud2& cloud, const std::vector<std::string>& fields,
                        const std::function<void(const float*)>& visit);
