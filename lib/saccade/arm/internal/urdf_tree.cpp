// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/urdf_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

namespace saccade {
namespace {

using JointPtr = urdf::JointSharedPtr;

/// Returns the number of letters to change, insert or delete to turn one text into the other (Levenshtein). O(a · b).
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t replaced = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({replaced, row[k] + 1, row[k + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string in_small_letters(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

UrdfTree::UrdfTree(const urdf::ModelInterface& model) : model_{model} {
  for (const auto& [name, joint] : model.joints_) {
    above_[joint->child_link_name] = joint;
    below_[joint->parent_link_name].push_back(joint);
  }
}

std::vector<std::string> UrdfTree::links() const {
  std::vector<std::string> names;
  for (const auto& [name, link] : model_.links_) names.push_back(name);
  return names;
}

const std::vector<JointPtr>& UrdfTree::below(const std::string& link) const {
  static const std::vector<JointPtr> none;
  const auto found = below_.find(link);
  return found == below_.end() ? none : found->second;
}

std::optional<std::vector<JointPtr>> UrdfTree::path(const std::string& base, const std::string& link) const {
  std::vector<JointPtr> joints;
  for (std::string at = link; at != base; at = joints.back()->parent_link_name) {
    const auto joint = above_.find(at);
    if (joint == above_.end()) return std::nullopt;
    joints.push_back(joint->second);
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

std::string UrdfTree::last_moving(const std::string& base, const std::string& link) const {
  std::string last = base;
  for (const JointPtr& joint : path(base, link).value_or(std::vector<JointPtr>{})) {
    if (moves(*joint)) last = joint->child_link_name;
  }
  return last;
}

urdf::JointConstSharedPtr UrdfTree::followed(const urdf::Joint& joint) const {
  const auto found = model_.joints_.find(joint.mimic->joint_name);
  return found == model_.joints_.end() ? nullptr : found->second;
}

urdf::JointConstSharedPtr UrdfTree::master(const urdf::Joint& joint) const {
  std::set<std::string> seen{joint.name};
  urdf::JointConstSharedPtr at = joint.mimic == nullptr ? nullptr : followed(joint);
  while (at != nullptr && at->mimic != nullptr) {
    if (!seen.insert(at->name).second) return nullptr;
    at = followed(*at);
  }
  return at;
}

double UrdfTree::standing_value(const urdf::Joint& joint) const {
  if (joint.mimic != nullptr && master(joint) != nullptr) {
    const double q = joint.mimic->multiplier * standing_value(*followed(joint)) + joint.mimic->offset;
    return std::isfinite(q) ? q : 0.0;
  }
  const bool limited =
      joint.limits != nullptr && joint.type != urdf::Joint::CONTINUOUS && joint.limits->lower <= joint.limits->upper;
  return limited ? std::clamp(0.0, joint.limits->lower, joint.limits->upper) : 0.0;
}

std::vector<std::string> UrdfTree::nearest(const std::string& name) const {
  constexpr std::size_t kMost{3};
  constexpr std::size_t kLetters{64};  // names in a file may be of any length
  const std::string wanted = in_small_letters(name.substr(0, kLetters));
  std::vector<std::pair<std::size_t, std::string>> like;
  for (const auto& [link_name, link] : model_.links_) {
    const std::string text = in_small_letters(link_name.substr(0, kLetters));
    const bool within = text.find(wanted) != std::string::npos || wanted.find(text) != std::string::npos;
    const std::size_t edits = edits_between(wanted, text);
    if (within || 2 * edits <= std::max(wanted.size(), text.size())) like.emplace_back(edits, link_name);
  }
  std::sort(like.begin(), like.end());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(kMost, like.size()); ++i) names.push_back(like[i].second);
  return names;
}

}  // namespace saccade
