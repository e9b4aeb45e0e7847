// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/gripper_joints.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace saccade {
namespace {

using JointPtr = urdf::JointSharedPtr;

constexpr int kLeastArm{3};  // fewest joints before a gripper that is recognised by <mimic> or short strokes
constexpr int kWholeArm{6};  // fewest joints before a hand that is recognised by its branches alone
constexpr double kStroke_m{0.15};
constexpr const char* kFingers[]{"finger", "thumb", "knuckle", "jaw", "claw"};

bool is_finger(const urdf::Joint& joint) {
  const std::string names = in_small_letters(joint.name + "\n" + joint.child_link_name);
  return std::any_of(std::begin(kFingers), std::end(kFingers),
                     [&names](const char* word) { return names.find(word) != std::string::npos; });
}

bool slides(const urdf::Joint& joint) { return joint.type == urdf::Joint::PRISMATIC; }

double motion_bound_of(const urdf::Joint& joint) {
  return joint.limits == nullptr ? 0.0 : joint.limits->upper - joint.limits->lower;
}

/// Moving joint on the rigid body that it hangs on. Joints that follow others do not count.
struct Branch {
  JointPtr joint;
  std::string body;  ///< its first link
  int before;        ///< joints from the base to the body
  int length{0};     ///< consecutive joints from this one on, including it
};

class GripperSearch {
 public:
  GripperSearch(const UrdfTree& tree, const std::string& base) : tree_{tree}, base_{base} { visit(base, base, 0); }

  std::set<std::string> run() {
    for (const Branch& branch : branches_) {
      if (branch.joint->mimic != nullptr) {
        take_follower(branch);
      } else if (branch.before > 0 && is_finger(*branch.joint)) {
        take(branch);
      }
    }
    for (const auto& [body, branches] : by_body_) take_hand(body, branches);
    return found_;
  }

 private:
  /// Returns the number of consecutive joints below the link.
  int visit(const std::string& link, const std::string& body, int before) {
    int most{0};
    for (const JointPtr& joint : tree_.below(link)) {
      if (!moves(*joint)) {
        most = std::max(most, visit(joint->child_link_name, body, before));
        continue;
      }
      const int own = joint->mimic == nullptr ? 1 : 0;
      const std::size_t index = branches_.size();
      branches_.push_back({joint, body, before});
      by_body_[body].push_back(index);
      branches_[index].length = own + visit(joint->child_link_name, joint->child_link_name, before + own);
      most = std::max(most, branches_[index].length);
    }
    return most;
  }

  void take(const Branch& branch) {
    found_.insert(branch.joint->name);
    hands_.insert(branch.body);
  }

  [[nodiscard]] bool is_free(const Branch& branch) const {
    return branch.joint->mimic == nullptr && found_.count(branch.joint->name) == 0;
  }

  void take_follower(const Branch& follower) {
    if (follower.length > 0) return;
    const urdf::JointConstSharedPtr master = tree_.master(*follower.joint);
    const auto way = tree_.path(base_, follower.joint->child_link_name);
    const auto is_master = [&master](const auto& joint) { return master != nullptr && joint->name == master->name; };
    if (std::any_of(way->begin(), way->end(), is_master)) return;
    found_.insert(follower.joint->name);
    const auto leader = std::find_if(branches_.begin(), branches_.end(),
                                     [&is_master](const Branch& branch) { return is_master(branch.joint); });
    if (leader == branches_.end() || leader->length > 1 || leader->before < kLeastArm) return;
    if (tree_.path(leader->body, follower.body)) take(*leader);
  }

  /// Examines all joints that move on one body.
  void take_hand(const std::string& body, const std::vector<std::size_t>& indices) {
    std::vector<Branch> branches;
    for (const std::size_t i : indices) {
      if (is_free(branches_[i])) branches.push_back(branches_[i]);
    }
    if (branches.empty()) return;
    const int before = branches.front().before;
    const auto short_stroke = [](const Branch& branch) {
      return branch.length == 1 && slides(*branch.joint) && motion_bound_of(*branch.joint) <= kStroke_m;
    };
    if (before >= kLeastArm && std::count_if(branches.begin(), branches.end(), short_stroke) > 1) hands_.insert(body);
    if (before >= kWholeArm && are_fingers(branches)) hands_.insert(body);
    if (hands_.count(body) == 0) return;
    for (const Branch& branch : branches) {
      const int longest = before >= kWholeArm ? before - 1 : before >= kLeastArm ? 1 : 0;
      if (branch.length <= longest) take(branch);
    }
  }

  [[nodiscard]] static bool are_fingers(const std::vector<Branch>& branches) {
    const Branch& first = branches.front();
    const auto alike = [&](const Branch& branch) {
      return branch.length < first.before && slides(*branch.joint) == slides(*first.joint);
    };
    if (branches.size() < 2 || !std::all_of(branches.begin(), branches.end(), alike)) return false;
    return branches.size() > 2 ||
           (branches[1].length == first.length &&
            std::abs(motion_bound_of(*branches[1].joint) - motion_bound_of(*first.joint)) < 1e-6);
  }

  const UrdfTree& tree_;
  std::string base_;
  std::vector<Branch> branches_;
  std::map<std::string, std::vector<std::size_t>> by_body_;
  std::set<std::string> found_;
  std::set<std::string> hands_;  ///< bodies that carry a gripper's joints
};

}  // namespace

std::set<std::string> gripper_joints(const UrdfTree& tree, const std::string& base) {
  return GripperSearch{tree, base}.run();
}

}  // namespace saccade
