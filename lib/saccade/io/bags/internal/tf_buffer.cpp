// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/bags/internal/tf_buffer.hpp"

#include <algorithm>
#include <cmath>

namespace saccade::internal::io_bags {

std::string_view frame_name(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return name;
}

std::int64_t time_ns(const messages::Time& time) {
  return time.sec * 1'000'000'000 + static_cast<std::int64_t>(time.nanosec);
}

std::optional<Pose> finite_pose(const messages::Pose& pose) {
  constexpr double kNormTolerance{1e-2};
  const Eigen::Vector3d t{pose.position.x, pose.position.y, pose.position.z};
  const Eigen::Quaterniond q{pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z};
  if (!t.allFinite() || !(std::abs(q.norm() - 1.0) <= kNormTolerance)) return std::nullopt;
  Pose T = Pose::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = t;
  return T;
}

Result<TfBuffer> TfBuffer::read(Bag& bag) {
  TfBuffer buffer;
  std::vector<std::uint32_t> topics;
  for (std::uint32_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    const bool is_tf = topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage";
    if (is_tf && topic.wire) topics.push_back(i);
  }
  if (topics.empty()) return buffer;
  SACCADE_TRY(const auto entries, bag.entries(topics));
  for (const BagEntry& entry : entries) {
    const auto message = bag.read(entry);
    if (!message) continue;
    const auto tf = messages::read_message<messages::TFMessage>(*message->wire, message->bytes);
    if (!tf) continue;
    const bool is_static = message->topic.ends_with("tf_static");
    for (const messages::TransformStamped& transform : tf->transforms) buffer.add(transform, is_static);
  }
  buffer.sort();
  return buffer;
}

void TfBuffer::add(const messages::TransformStamped& transform, bool is_static) {
  const std::string_view child = frame_name(transform.child_frame_id);
  const std::string_view parent = frame_name(transform.header.frame_id);
  const auto pose = finite_pose(transform.transform);
  if (child.empty() || parent.empty() || child == parent || !pose) return;
  Link& link = links_[std::string{child}];
  // For a frame that changes its parent, or becomes fixed, the last message holds.
  if (link.parent != parent || link.is_static || is_static) link = {std::string{parent}, is_static, {}};
  const messages::Quaternion& q = transform.transform.orientation;
  link.samples.push_back(
      {time_ns(transform.header.stamp), pose->translation(), Eigen::Quaterniond{q.w, q.x, q.y, q.z}.normalized()});
}

void TfBuffer::sort() {
  for (auto& [child, link] : links_) {
    std::ranges::stable_sort(link.samples, {}, &Sample::time_ns);
  }
}

const TfBuffer::Link* TfBuffer::link(std::string_view frame) const {
  const auto found = links_.find(frame_name(frame));
  return found == links_.end() ? nullptr : &found->second;
}

std::vector<std::string> TfBuffer::ancestors(std::string_view frame) const {
  std::vector<std::string> names{std::string{frame_name(frame)}};
  for (const Link* up = link(frame); up != nullptr && names.size() <= links_.size(); up = link(up->parent)) {
    names.push_back(up->parent);
  }
  return names;
}

bool TfBuffer::knows(std::string_view frame) const {
  const auto is_parent = [&](const auto& entry) { return entry.second.parent == frame_name(frame); };
  return link(frame) != nullptr || std::ranges::any_of(links_, is_parent);
}

std::string TfBuffer::root(std::string_view frame) const { return ancestors(frame).back(); }

std::optional<std::string> TfBuffer::common_ancestor(std::string_view a, std::string_view b) const {
  const std::vector<std::string> others = ancestors(b);
  for (const std::string& name : ancestors(a)) {
    if (std::ranges::find(others, name) != others.end()) return name;
  }
  return std::nullopt;
}

bool TfBuffer::connects(std::string_view to, std::string_view from) const {
  return common_ancestor(to, from).has_value();
}

bool TfBuffer::moves(std::string_view to, std::string_view from) const {
  const auto ancestor = common_ancestor(to, from);
  if (!ancestor) return false;
  for (const std::string_view end : {to, from}) {
    for (const std::string& name : ancestors(end)) {
      if (name == *ancestor) break;
      if (!link(name)->is_static) return true;
    }
  }
  return false;
}

std::optional<Pose> TfBuffer::at(const Link& link, std::int64_t at_ns) {
  const auto pose = [](const Eigen::Vector3d& t, const Eigen::Quaterniond& q) {
    Pose T = Pose::Identity();
    T.linear() = q.toRotationMatrix();
    T.translation() = t;
    return T;
  };
  const std::vector<Sample>& samples = link.samples;
  if (link.is_static) return pose(samples.back().t, samples.back().q);
  const auto after = std::ranges::lower_bound(samples, at_ns, {}, &Sample::time_ns);
  if (after == samples.end()) return std::nullopt;
  if (after->time_ns == at_ns) return pose(after->t, after->q);
  if (after == samples.begin()) return std::nullopt;
  const Sample& before = *std::prev(after);
  const double share =
      static_cast<double>(at_ns - before.time_ns) / static_cast<double>(after->time_ns - before.time_ns);
  return pose(before.t + share * (after->t - before.t), before.q.slerp(share, after->q));
}

std::optional<Pose> TfBuffer::climb(std::string_view frame, std::string_view ancestor, std::int64_t at_ns) const {
  Pose T_up_frame = Pose::Identity();
  for (const std::string& name : ancestors(frame)) {
    if (name == ancestor) return T_up_frame;
    const auto T_parent_up = at(*link(name), at_ns);
    if (!T_parent_up) return std::nullopt;
    T_up_frame = *T_parent_up * T_up_frame;
  }
  return std::nullopt;
}

std::optional<Pose> TfBuffer::look_up(std::string_view to, std::string_view from, std::int64_t at_ns) const {
  const auto ancestor = common_ancestor(from, to);
  if (!ancestor) return std::nullopt;
  const auto T_ancestor_from = climb(from, *ancestor, at_ns);
  const auto T_ancestor_to = climb(to, *ancestor, at_ns);
  if (!T_ancestor_from || !T_ancestor_to) return std::nullopt;
  return T_ancestor_to->inverse() * *T_ancestor_from;
}

std::vector<std::int64_t> TfBuffer::times_ns(std::string_view frame) const {
  std::vector<std::int64_t> times;
  for (const std::string& name : ancestors(frame)) {
    const Link* up = link(name);
    if (up == nullptr) break;
    if (up->is_static) continue;
    for (const Sample& sample : up->samples) {
      if (times.empty() || sample.time_ns > times.back()) times.push_back(sample.time_ns);
    }
    break;
  }
  return times;
}

}  // namespace saccade::internal::io_bags
