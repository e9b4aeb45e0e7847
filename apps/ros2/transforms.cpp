// SPDX-License-Identifier: Apache-2.0
#include "transforms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace saccade::ros2 {
namespace {

constexpr double kKept_s{10.0};
constexpr double kUnitTolerance{0.01};

/// Removes the leading slash that ROS 1 had.
std::string frame_name(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

}  // namespace

std::string Transforms::add(const messages::TFMessage& message, bool fixed) {
  std::string refused;
  for (const messages::TransformStamped& transform : message.transforms) {
    const std::string parent = frame_name(transform.header.frame_id);
    const std::string child = frame_name(transform.child_frame_id);
    const auto& p = transform.transform.position;
    const auto& o = transform.transform.orientation;
    const Sample sample{transform.header.stamp.seconds(), {p.x, p.y, p.z}, {o.w, o.x, o.y, o.z}};
    const auto refuse = [&](const char* why) { refused = "the transform from " + child + " to " + parent + " " + why; };
    if (!sample.position.allFinite() || !sample.rotation.coeffs().allFinite()) {
      refuse("is not finite");
    } else if (std::abs(sample.rotation.norm() - 1.0) > kUnitTolerance) {
      refuse("has a quaternion that is not a rotation");
    } else if (child.empty() || parent.empty() || child == parent) {
      refuse("lacks a frame");
    } else {
      Edge& edge = edges_[child];
      std::vector<Sample>& samples = edge.samples;
      const bool another = edge.parent != parent || edge.fixed != fixed;
      const bool restarted = !samples.empty() && sample.time_s < samples.back().time_s - kKept_s;
      if (another || fixed || restarted) samples.clear();
      edge.parent = parent;
      edge.fixed = fixed;
      const auto earlier = [](double time_s, const Sample& other) { return time_s < other.time_s; };
      samples.insert(std::upper_bound(samples.begin(), samples.end(), sample.time_s, earlier), sample);
      const double oldest_s = samples.back().time_s - kKept_s;
      std::erase_if(samples, [&](const Sample& other) { return other.time_s < oldest_s; });
    }
  }
  return refused;
}

std::optional<Eigen::Isometry3d> Transforms::Edge::at(double time_s) const {
  if (samples.empty() || (!fixed && time_s < samples.front().time_s)) return std::nullopt;
  const auto later = fixed ? samples.begin() + 1
                           : std::upper_bound(samples.begin(), samples.end(), time_s,
                                              [](double t_s, const Sample& s) { return t_s < s.time_s; });
  const Sample& a = *(later - 1);
  Eigen::Isometry3d T = Eigen::Translation3d{a.position} * a.rotation.normalized();
  if (later != samples.end()) {
    const double share = (time_s - a.time_s) / (later->time_s - a.time_s);
    T = Eigen::Translation3d{a.position + share * (later->position - a.position)} *
        a.rotation.normalized().slerp(share, later->rotation.normalized());
  }
  return T;
}

std::optional<std::vector<const std::string*>> Transforms::to_root(const std::string& frame) const {
  std::vector<const std::string*> path;
  for (auto edge = edges_.find(frame); edge != edges_.end(); edge = edges_.find(edge->second.parent)) {
    if (path.size() == edges_.size()) return std::nullopt;
    path.push_back(&edge->first);
  }
  return path;
}

std::optional<Located> Transforms::find(const std::string& reference, const std::string& frame) const {
  auto up = to_root(frame_name(frame));
  auto down = to_root(frame_name(reference));
  if (!up || !down) return std::nullopt;
  const auto root = [&](const std::vector<const std::string*>& path, const std::string& start) {
    return path.empty() ? frame_name(start) : edges_.at(*path.back()).parent;
  };
  if (root(*up, frame) != root(*down, reference)) return std::nullopt;
  while (!up->empty() && !down->empty() && up->back() == down->back()) {  // drops the common part of both
    up->pop_back();
    down->pop_back();
  }
  double time_s = std::numeric_limits<double>::infinity();
  for (const auto* path : {&*up, &*down}) {
    for (const std::string* name : *path) {
      const Edge& edge = edges_.at(*name);
      if (!edge.fixed) time_s = std::min(time_s, edge.samples.back().time_s);
    }
  }
  const auto along = [&](const std::vector<const std::string*>& path) {
    std::optional<Eigen::Isometry3d> T = Eigen::Isometry3d::Identity();
    for (const std::string* name : path) {
      const auto step = edges_.at(*name).at(time_s);
      T = T && step ? std::optional<Eigen::Isometry3d>{*step * *T} : std::nullopt;
    }
    return T;
  };
  const auto T_common_frame = along(*up);
  const auto T_common_reference = along(*down);
  if (!T_common_frame || !T_common_reference) return std::nullopt;
  return Located{T_common_reference->inverse() * *T_common_frame,
                 std::isfinite(time_s) ? std::optional{time_s} : std::nullopt};
}

std::string Transforms::frames() const {
  std::set<std::string> names;
  for (const auto& [child, edge] : edges_) names.insert({child, edge.parent});
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace saccade::ros2
