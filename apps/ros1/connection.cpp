// SPDX-License-Identifier: Apache-2.0
#include "connection.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "../../devices/protocol.hpp"

namespace saccade::ros1 {
namespace {

using devices::now_s;

/// Ends the standard input.
void end_input(int /*signal*/) {
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
}

void pause_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds{ms}); }

}  // namespace

void begin_node(int& argc, char** argv, const std::string& name) {
  ::setenv("ROS_MASTER_URI", "http://localhost:11311", 0);  // without it, roscpp aborts
  ros::init(argc, argv, name,
            ros::init_options::NoSigintHandler | ros::init_options::AnonymousName | ros::init_options::NoRosout);
  std::signal(SIGTERM, end_input);
  std::signal(SIGPIPE, SIG_IGN);
}

Connection::Connection(double wait_s) {
  const double until_s = now_s() + wait_s;
  while (!ros::master::check()) {
    if (now_s() > until_s) {
      throw std::runtime_error{"no ROS master answers at " + ros::master::getURI() + " for " + seconds_text(wait_s) +
                               " s; start roscore, or set ROS_MASTER_URI"};
    }
    pause_ms(50);
  }
  node_.emplace();
  spinner_.emplace(1);
  spinner_->start();
  asked_s_ = now_s();
}

Connection::~Connection() {
  spinner_->stop();
  ros::shutdown();
}

bool Connection::forgotten() {
  if (now_s() - asked_s_ < 1.0) return false;
  asked_s_ = now_s();
  if (!ros::master::check()) return false;
  XmlRpc::XmlRpcValue arguments;
  XmlRpc::XmlRpcValue result;
  XmlRpc::XmlRpcValue payload;
  arguments[0] = ros::this_node::getName();
  arguments[1] = ros::this_node::getName();
  return !ros::master::execute("lookupNode", arguments, result, payload, false);
}

std::vector<std::string> topics_of_type(const std::string& type) {
  ros::master::V_TopicInfo topics;
  std::vector<std::string> names;
  if (!ros::master::check() || !ros::master::getTopics(topics)) return names;
  for (const ros::master::TopicInfo& topic : topics) {
    if (topic.datatype == type) names.push_back(topic.name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text.empty() ? "none" : text;
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", seconds);
  return text;
}

void Transforms::renew() {
  listener_.reset();
  buffer_ = std::make_unique<tf2_ros::Buffer>();
  listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_);
}

std::optional<geometry_msgs::TransformStamped> Transforms::find(const std::string& reference, const std::string& frame,
                                                                ros::Time time) const {
  const tf2::BufferCore& known = *buffer_;
  if (!known.canTransform(reference, frame, time)) return std::nullopt;
  try {
    return known.lookupTransform(reference, frame, time);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

geometry_msgs::TransformStamped Transforms::need(const std::string& reference, const std::string& frame, ros::Time time,
                                                 double wait_s) const {
  for (const double until_s = now_s() + wait_s; now_s() < until_s; pause_ms(2)) {
    if (const auto found = find(reference, frame, time)) return *found;
  }
  std::string why;
  static_cast<const tf2::BufferCore&>(*buffer_).canTransform(reference, frame, time, &why);
  throw std::runtime_error{"TF does not say where " + frame + " is in " + reference + ": " + why};
}

std::vector<std::string> Transforms::frames() const {
  std::vector<std::string> names;
  static_cast<const tf2::BufferCore&>(*buffer_)._getFrameStrings(names);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace saccade::ros1
