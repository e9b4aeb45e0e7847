// SPDX-License-Identifier: Apache-2.0
#pragma once
// TfBuffer: the tree of frames that /tf and /tf_static tell of, and where one is in another at a time.

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

/// "/camera" and "camera" are one frame.
[[nodiscard]] std::string_view frame_name(std::string_view name);
[[nodiscard]] std::int64_t time_ns(const messages::Time& time);
/// nullopt for NaN, and for what is no rotation.
[[nodiscard]] std::optional<Pose> finite_pose(const messages::Pose& pose);

class TfBuffer {
 public:
  /// All of /tf and /tf_static. Messages that cannot be read are left out.
  [[nodiscard]] static Result<TfBuffer> read(Bag& bag);

  void add(const messages::TransformStamped& transform, bool is_static);
  /// To be called after the last add(): puts what came out of order into order.
  void sort();

  [[nodiscard]] bool knows(std::string_view frame) const;
  /// Last ancestor of a frame; the frame itself where nothing is known of it.
  [[nodiscard]] std::string root(std::string_view frame) const;
  /// Whether the tree connects the frames, and whether something between them moves.
  [[nodiscard]] bool connects(std::string_view to, std::string_view from) const;
  [[nodiscard]] bool moves(std::string_view to, std::string_view from) const;
  /// T_to_from; nullopt where they are not connected, or a transform between them has no sample before or after.
  /// Positions are interpolated linearly, rotations on the shorter arc.
  [[nodiscard]] std::optional<Pose> look_up(std::string_view to, std::string_view from, std::int64_t at_ns) const;
  /// Times at which a frame, or the nearest of its ancestors that moves, was told of.
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
  /// T_ancestor_frame.
  [[nodiscard]] std::optional<Pose> climb(std::string_view frame, std::string_view ancestor, std::int64_t at_ns) const;
  [[nodiscard]] std::optional<std::string> common_ancestor(std::string_view a, std::string_view b) const;

  std::map<std::string, Link, std::less<>> links_;  ///< by the child's name
};

}  // namespace saccade::internal::io_bags
