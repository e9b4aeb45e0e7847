// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connection: a device's program as a node of ROS. Transforms: where TF has a frame.

#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace saccade::ros1 {

/// Before all else: names the node, takes remappings (a:=b) out of the arguments, and lets SIGTERM end the program as
/// the end of its input does.
void begin_node(int& argc, char** argv, const std::string& name);

/// A node that is registered at a master, and callbacks in a thread of their own.
class Connection {
 public:
  /// Throws when no master answers in time.
  explicit Connection(double wait_s);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection();

  [[nodiscard]] ros::NodeHandle& node() { return *node_; }
  /// Whether a master was started anew and knows nothing of this node: its subscriptions must be made again. Asks it
  /// once a second at most.
  [[nodiscard]] bool forgotten();

 private:
  std::optional<ros::NodeHandle> node_;
  std::optional<ros::AsyncSpinner> spinner_;
  double asked_s_{0.0};
};

/// Returns the topics of a type that someone publishes, sorted.
[[nodiscard]] std::vector<std::string> topics_of_type(const std::string& type);
/// "a, b and c"; "none".
[[nodiscard]] std::string listed(const std::vector<std::string>& names);
/// "12.3", seconds.
[[nodiscard]] std::string seconds_text(double seconds);

class Transforms {
 public:
  Transforms() { renew(); }
  /// Begins anew, after the master did.
  void renew();
  /// Frame in reference at an instant; the latest one there is for time zero. nullopt: TF does not say.
  [[nodiscard]] std::optional<geometry_msgs::TransformStamped> find(const std::string& reference,
                                                                    const std::string& frame, ros::Time time) const;
  /// Waits for it; throws what TF says when the time is up.
  [[nodiscard]] geometry_msgs::TransformStamped need(const std::string& reference, const std::string& frame,
                                                     ros::Time time, double wait_s) const;
  [[nodiscard]] std::vector<std::string> frames() const;

 private:
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
};

}  // namespace saccade::ros1
