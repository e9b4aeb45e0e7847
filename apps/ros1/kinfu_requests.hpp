// SPDX-License-Identifier: Apache-2.0
#pragma once
// KinfuRequests: answers requests by action and by topic, and takes uploads, on threads of their own. C++17.

#include <actionlib/server/action_server.h>
#include <kinfu_msgs/RequestAction.h>
#include <kinfu_msgs/WorldUploadAction.h>
#include <ros/ros.h>

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <string>

#include "kinfu_map.hpp"
#include "workers.hpp"

struct RequestSettings {
  std::string action_name, upload_name, topic;
  std::string frame_id;  ///< in the headers of answers
  std::string temporary_folder;
  double largest_message_mb{900.0};
};

class KinfuRequests {
 public:
  KinfuRequests(ros::NodeHandle node, saccade::ros1::KinfuMap& map, const RequestSettings& settings,
                std::function<void()> on_reset);
  ~KinfuRequests();

 private:
  using Requests = actionlib::ActionServer<kinfu_msgs::RequestAction>;
  using Uploads = actionlib::ActionServer<kinfu_msgs::WorldUploadAction>;
  struct Kept {
    ros::Publisher publisher;
    ros::WallTime until;
    bool seen{false};
  };

  /// Result: the answer, written to a file where it is too large for a message; error is empty on success.
  struct Outcome {
    kinfu_msgs::RequestResult result;
    std::string error;
    bool cancelled{false};
  };
  Outcome answer(const kinfu_msgs::KinfuTsdfRequest& request, const std::atomic<bool>& cancelled);
  void on_goal(Requests::GoalHandle goal);
  void on_upload(Uploads::GoalHandle goal);
  void on_message(const kinfu_msgs::KinfuTsdfRequest::ConstPtr& request);
  void publish(const kinfu_msgs::KinfuTsdfRequest& request, const kinfu_msgs::RequestResult& result);
  template <class Message>
  void keep(const std::string& topic, const Message& message);
  void drop_kept();

  ros::NodeHandle node_;
  saccade::ros1::KinfuMap& map_;
  RequestSettings settings_;
  std::function<void()> on_reset_;
  std::atomic<unsigned> files_{0};
  std::mutex kept_mutex_;
  std::list<Kept> kept_;
  ros::WallTimer timer_;
  ros::Subscriber subscriber_;
  Requests requests_;
  Uploads uploads_;
  Workers workers_;  ///< last member, so that they end first
};
