// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connection: a device's program as a node of ROS. Transforms: look-up of frames in TF.

#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace saccade::ros1 {

/// Names the node, takes remappings (a:=b) out of the arguments, and makes SIGTERM end the program like the end of its
/// input. Call it first.
void begin_node(int& argc, char** argv, const std::string& name);

/// Node registered at a master, with callbacks on their own thread.
class Connection {
 public:
  /// Throws when no master answers in time.
  explicit Connection(double wait_s);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection();

  [[nodiscard]] ros::NodeHandle& node() { return *node_; }
  /// Tells whether a master was restarted and does not know this node, so that subscriptions must be renewed. Asks at
  /// most once a second.
  [[nodiscard]] bool forgotten();

 private:
  std::optional<ros::NodeHandle> node_;
  std::optional<ros::AsyncSpinner> spinner_;
  double asked_s_{0.0};
};

/// Returns the published topics of a type, sorted.
[[nodiscard]] std::vector<std::string> topics_of_type(const std::string& type);
/// Returns "a, b and c"; "none" for an empty list.
[[nodiscard]] std::string listed(const std::vector<std::string>& names);
/// Returns seconds as "12.3".
[[nodiscard]] std::string seconds_text(double seconds);

class Transforms {
 public:
  Transforms() { renew(); }
  /// Renews everything after a restart of the master.
  void renew();
  /// Returns a frame in a reference at an instant; the latest one for time zero. nullopt: unknown to TF.
  [[nodiscard]] std::optional<geometry_msgs::TransformStamped> find(const std::string& reference,
                                                                    const std::string& frame, ros::Time time) const;
  /// Waits for a transform; throws TF's explanation when the time is up.
  [[nodiscard]] geometry_msgs::TransformStamped need(const std::string& reference, const std::string& frame,
                                                     ros::Time time, double wait_s) const;
  [[nodiscard]] std::vector<std::string> frames() const;

 private:
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
};

}  // namespace saccade::ros1
