// SPDX-License-Identifier: Apache-2.0
#pragma once
// Transforms: the tree of frames that /tf and /tf_static tell of; Located: where one frame is in another.

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saccade/io/messages/messages.hpp"

namespace saccade::ros2 {

/// A frame in another one.
struct Located {
  Eigen::Isometry3d T_reference_frame;
  std::optional<double> time_s;  ///< nullopt: nothing between the two ever moves
};

class Transforms {
 public:
  /// Takes what came. Returns what is wrong with the transforms that were refused, in words; empty: nothing.
  std::string add(const messages::TFMessage& message, bool fixed);

  /// Looks up a frame at the latest time for which all moving transforms between the two are known; each is
  /// interpolated. nullopt: the two are not connected, or not at a common time.
  [[nodiscard]] std::optional<Located> find(const std::string& reference, const std::string& frame) const;

  /// Names of all frames, for messages.
  [[nodiscard]] std::string frames() const;

 private:
  struct Sample {
    double time_s;
    Eigen::Vector3d position;
    Eigen::Quaterniond rotation;
  };
  /// From a frame to its parent.
  struct Edge {
    std::string parent;
    bool fixed{false};
    std::vector<Sample> samples;  ///< by time; one alone where fixed

    [[nodiscard]] std::optional<Eigen::Isometry3d> at(double time_s) const;
  };

  /// Edges from a frame up to the root of its tree, by the names of their lower ends; nullopt in a loop.
  [[nodiscard]] std::optional<std::vector<const std::string*>> to_root(const std::string& frame) const;

  std::map<std::string, Edge> edges_;  ///< by the names of their lower ends
};

}  // namespace saccade::ros2
