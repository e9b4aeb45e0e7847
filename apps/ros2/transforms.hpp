// SPDX-License-Identifier: Apache-2.0
#pragma once
// Transforms: the tree of frames from /tf and /tf_static. Located: pose of one frame in another.

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saccade/io/messages/messages.hpp"

namespace saccade::ros2 {

/// Pose of a frame in another one.
struct Located {
  Eigen::Isometry3d T_reference_frame;
  std::optional<double> time_s;  ///< nullopt: all transforms between the two are fixed
};

class Transforms {
 public:
  /// Adds a message. Returns a description of rejected transforms; empty if there are none.
  std::string add(const messages::TFMessage& message, bool fixed);

  /// Finds a frame at the latest time for which all moving transforms between the two are known, interpolating each.
  /// nullopt: the two are not connected, or share no time.
  [[nodiscard]] std::optional<Located> find(const std::string& reference, const std::string& frame) const;

  /// Returns the names of all frames, for messages.
  [[nodiscard]] std::string frames() const;

 private:
  struct Sample {
    double time_s;
    Eigen::Vector3d position;
    Eigen::Quaterniond rotation;
  };
  /// Edge from a frame to its parent.
  struct Edge {
    std::string parent;
    bool fixed{false};
    std::vector<Sample> samples;  ///< by time; a single one where fixed

    [[nodiscard]] std::optional<Eigen::Isometry3d> at(double time_s) const;
  };

  /// Returns the edges from a frame up to the root of its tree, by the names of their lower ends; nullopt in a loop.
  [[nodiscard]] std::optional<std::vector<const std::string*>> to_root(const std::string& frame) const;

  std::map<std::string, Edge> edges_;  ///< by the names of their lower ends
};

}  // namespace saccade::ros2
