// SPDX-License-Identifier: Apache-2.0
#pragma once
// TfBuffer: the tree of frames from /tf and /tf_static, and transforms between them over time.

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/io/bags/bags.hpp"
#include "saccade/io/messages/messages.hpp"

namespace saccade::internal::io_bags {

/// Returns the name of a frame: "/camera" and "camera" are equal.
[[nodiscard]] std::string_view frame_name(std::string_view name);
[[nodiscard]] std::int64_t time_ns(const messages::Time& time);
/// Converts a pose; nullopt for NaN, and for an invalid rotation.
[[nodiscard]] std::optional<Pose> finite_pose(const messages::Pose& pose);

class TfBuffer {
 public:
  /// Reads all of /tf and /tf_static. Unreadable messages are skipped.
  [[nodiscard]] static Result<TfBuffer> read(Bag& bag);

  void add(const messages::TransformStamped& transform, bool is_static);
  /// Sorts samples that came out of order. Call it after the last add().
  void sort();

  [[nodiscard]] bool knows(std::string_view frame) const;
  /// Returns the last ancestor of a frame; the frame itself where it has none.
  [[nodiscard]] std::string root(std::string_view frame) const;
  /// Tell whether the tree connects the frames, and whether a transform between them moves.
  [[nodiscard]] bool connects(std::string_view to, std::string_view from) const;
  [[nodiscard]] bool moves(std::string_view to, std::string_view from) const;
  /// Returns T_to_from; nullopt where the frames are not connected, or a transform between them has no sample before or
  /// after. Interpolates positions linearly, rotations on the shorter arc.
  [[nodiscard]] std::optional<Pose> look_up(std::string_view to, std::string_view from, std::int64_t at_ns) const;
  /// Returns the sample times of a frame, or of its nearest moving ancestor.
  [[nodiscard]] std::vector<std::int64_t> times_ns(std::string_view frame) const;

 private:
  struct Sample {
    std::int64_t time_ns{0};
    Eigen::Vector3d t{Eigen::Vector3d::Zero()};
    Eigen::Quaterniond q{Eigen::Quaterniond::Identity()};
  };
  struct Link {
    std::string parent;
    bool is_static{false};
    std::vector<Sample> samples;
  };
  [[nodiscard]] const Link* link(std::string_view frame) const;
  [[nodiscard]] std::vector<std::string> ancestors(std::string_view frame) const;
  [[nodiscard]] static std::optional<Pose> at(const Link& link, std::int64_t at_ns);
  /// Returns T_ancestor_frame.
  [[nodiscard]] std::optional<Pose> climb(std::string_view frame, std::string_view ancestor, std::int64_t at_ns) const;
  [[nodiscard]] std::optional<std::string> common_ancestor(std::string_view a, std::string_view b) const;

  std::map<std::string, Link, std::less<>> links_;  ///< by the child's name
};

}  // namespace saccade::internal::io_bags
