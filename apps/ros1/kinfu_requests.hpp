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
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "kinfu_map.hpp"

/// Threads that work on one thing each; joined when they are done, or when this ends.
class Workers {
 public:
  ~Workers();
  /// Returns false where too many are at work.
  bool start(std::function<void(const std::atomic<bool>& cancelled)> work, const std::string& name);
  void cancel(const std::string& name);
  void cancel_all();

 private:
  struct Worker {
    std::string name;
    std::atomic<bool> cancelled{false};
    std::atomic<bool> done{false};
    std::thread thread;
  };
  std::mutex mutex_;
  std::list<Worker> workers_;
};

struct RequestSettings {
  std::string action_name, upload_name, topic;
  std::string frame_id;  ///< of answers
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

  /// The answer, written to a file where it is too large for a message; error is empty where it went well.
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
  Workers workers_;  ///< the last, so that they end first
};
