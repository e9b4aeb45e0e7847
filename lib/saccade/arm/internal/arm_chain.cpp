// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/arm_chain.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "saccade/arm/internal/gripper_joints.hpp"
#include "saccade/core/names.hpp"

namespace saccade {
namespace {

using JointPtr = urdf::JointSharedPtr;
using Links = std::vector<std::string>;

/// Usual names of the frame that tools are mounted on, likeliest first.
constexpr std::string_view kFlanges[]{"tool0",        "link8",      "link_8", "flange", "ee_link", "end_effector_link",
                                      "end_effector", "tool_frame", "tcp"};
/// Further names of links at the end of an arm, which serve only for proposals.
constexpr std::string_view kEnds[]{"eef", "ee"};
constexpr std::string_view kOpticalFrame{"optical_frame"};
constexpr std::size_t kMostProposed{8};

Error unclear(const std::string& what, const std::string& where = "") { return {Errc::invalid_argument, what, where}; }

/// Links that are fixed to each other, without links that a gripper moves.
struct RigidBody {
  int joints;   ///< moving joints between the base and it
  Links links;  ///< first the link behind the last of these joints
};

/// Tells whether the name is the word, or ends with it after a separator: "left_tool0", not "mytool0".
bool ends_with_word(const std::string& name, std::string_view word) {
  const std::string small = in_small_letters(name);
  if (!small.ends_with(word)) return false;
  if (small.size() == word.size()) return true;
  const char before = small[small.size() - word.size() - 1];
  return before == '_' || before == '-' || before == '/' || before == '.' || before == ':';
}

std::string options_text(const std::string& option, const Links& names) {
  const std::size_t count = std::min(names.size(), kMostProposed);
  const auto proposal = [&option](const std::string& name) { return option + " " + name; };
  return joined(Links(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count)), ", ", proposal) +
         (count < names.size() ? ", …" : "");
}

class ChainFinder {
 public:
  ChainFinder(const UrdfTree& tree, const UrdfConfig& config) : tree_{tree}, config_{config} {}

  Result<ArmChain> run() {
    chain_.base = config_.base.empty() ? tree_.root() : config_.base;
    SACCADE_CHECK(known(chain_.base, "base"));
    chain_.gripper = gripper_joints(tree_, chain_.base);
    chain_.camera = config_.camera;
    if (chain_.camera.empty() && tree_.has(std::string{kCameraFrame})) chain_.camera = kCameraFrame;
    if (!chain_.camera.empty()) SACCADE_CHECK(known(chain_.camera, "camera's frame"));
    chain_.tip = config_.tip;
    if (!chain_.tip.empty()) SACCADE_CHECK(known(chain_.tip, "tip"));
    if (chain_.tip.empty() && !chain_.camera.empty()) chain_.tip = tree_.last_moving(chain_.base, chain_.camera);
    if (chain_.tip.empty()) {
      SACCADE_CHECK(choose_tip());
    }
    auto joints = tree_.path(chain_.base, chain_.tip);
    if (!joints) return unclear("does not come behind the base " + chain_.base, "link " + chain_.tip);
    if (chain_.camera.empty()) {
      SACCADE_CHECK(choose_camera());
      joints = tree_.path(chain_.base, chain_.tip);
    }
    chain_.joints = *std::move(joints);
    if (!gripper_.empty())
      chain_.choices.push_back("the arm ends at " + chain_.tip + ": a gripper's joints are none of it (" +
                               joined(gripper_) + ")");
    return std::move(chain_);
  }

 private:
  [[nodiscard]] Status known(const std::string& link, const char* what) const {
    if (tree_.has(link)) return {};
    const Links near = tree_.nearest(link);
    return unclear(std::string{"there is no such link to be the "} + what +
                       (near.empty() ? "" : "; names like it: " + joined(near)),
                   link);
  }

  void add_body(const std::string& link, RigidBody& body, std::vector<RigidBody>& all) const {
    body.links.push_back(link);
    for (const JointPtr& joint : tree_.below(link)) {
      if (!moves(*joint)) {
        add_body(joint->child_link_name, body, all);
      } else if (chain_.gripper.count(joint->name) == 0) {
        RigidBody behind{body.joints + 1, {}};
        add_body(joint->child_link_name, behind, all);
        all.push_back(std::move(behind));
      }
    }
  }

  /// Returns all bodies that a joint moves.
  [[nodiscard]] std::vector<RigidBody> moved_bodies() const {
    std::vector<RigidBody> all;
    RigidBody base{0, {}};
    add_body(chain_.base, base, all);
    return all;
  }

  /// Keeps the bodies that end the chains with the most joints.
  [[nodiscard]] Result<std::vector<RigidBody>> ends(std::vector<RigidBody> all) const {
    int most{0};
    for (const RigidBody& body : all) most = std::max(most, body.joints);
    if (most == 0) return Error{Errc::corrupt_data, "no joint moves behind " + chain_.base, ""};
    std::erase_if(all, [most](const RigidBody& body) { return body.joints < most; });
    return all;
  }

  [[nodiscard]] static Links optical_frames(const Links& links) {
    Links frames;
    std::copy_if(links.begin(), links.end(), std::back_inserter(frames),
                 [](const std::string& link) { return in_small_letters(link).ends_with(kOpticalFrame); });
    return frames;
  }

  Status choose_tip() {
    const std::vector<RigidBody> all = moved_bodies();
    SACCADE_TRY(std::vector<RigidBody> arms, ends(all));
    if (arms.size() > 1) {
      const auto with_camera = [](const RigidBody& arm) { return !optical_frames(arm.links).empty(); };
      const auto seeing = std::find_if(arms.begin(), arms.end(), with_camera);
      if (std::count_if(arms.begin(), arms.end(), with_camera) != 1) return several(arms);
      const RigidBody arm = *seeing;
      chain_.choices.push_back("of " + std::to_string(arms.size()) + " chains of " + std::to_string(arm.joints) +
                               " joints the one that carries " + optical_frames(arm.links).front() + " is taken");
      arms = {arm};
    }
    chain_.tip = tip_of(arms.front());
    say_flange_elsewhere(all, arms.front());
    gripper_ = gripper_on(arms.front());
    return {};
  }

  [[nodiscard]] Error several(const std::vector<RigidBody>& arms) const {
    Links tips;
    for (const RigidBody& arm : arms)
      tips.push_back(tip_of(arm) + " (" + std::to_string(arm.joints) + (arm.joints == 1 ? " joint)" : " joints)"));
    std::sort(tips.begin(), tips.end());
    const std::string likeliest = likeliest_of(arms);
    return unclear("several chains are equally long; name a tip: " + options_text("--tip", tips) +
                   (likeliest.empty() ? "" : "; --tip " + likeliest + " is the likeliest, by its name"));
  }

  /// Returns the tip of the only arm with the likeliest name of a flange, or with a camera; empty where several have
  /// it.
  [[nodiscard]] std::string likeliest_of(const std::vector<RigidBody>& arms) const {
    const auto only = [&](const auto& fits) {
      const auto has = [&fits](const RigidBody& arm) { return std::any_of(arm.links.begin(), arm.links.end(), fits); };
      const auto found = std::find_if(arms.begin(), arms.end(), has);
      const auto count = std::count_if(arms.begin(), arms.end(), has);
      return std::pair{count, count == 1 ? tip_of(*found) : std::string{}};
    };
    std::vector<std::string_view> words(std::begin(kFlanges), std::end(kFlanges));
    words.insert(words.end(), std::begin(kEnds), std::end(kEnds));
    for (const std::string_view word : words) {
      const auto [count, tip] = only([word](const std::string& link) { return ends_with_word(link, word); });
      if (count > 0) return tip;
    }
    return only([](const std::string& link) { return in_small_letters(link).find("camera") != std::string::npos; })
        .second;
  }

  /// Says where a flange is, if its name is on a chain that is not taken.
  void say_flange_elsewhere(const std::vector<RigidBody>& all, const RigidBody& arm) {
    if (flange_by_name(arm)) return;
    for (const RigidBody& body : all) {
      const auto flange = body.joints > 1 && body.joints < arm.joints ? flange_by_name(body) : std::nullopt;
      if (!flange) continue;
      chain_.choices.push_back("the longest chain is taken, to " + tip_of(arm) +
                               "; a flange by its name is elsewhere: --tip " + *flange + " (" +
                               std::to_string(body.joints) + " joints)");
      return;
    }
  }

  /// Returns the joints of a gripper that hang on a body.
  [[nodiscard]] Links gripper_on(const RigidBody& body) const {
    Links names;
    for (const std::string& link : body.links) {
      for (const JointPtr& joint : tree_.below(link)) {
        if (moves(*joint)) names.push_back(joint->name);
      }
    }
    return names;
  }

  /// Returns the flange by its name, otherwise the last link before a gripper, the only end, or the first link.
  [[nodiscard]] std::string tip_of(const RigidBody& body) const {
    if (const auto flange = flange_by_name(body)) return *flange;
    if (!gripper_on(body).empty()) return before_gripper(body);
    Links leaves;
    std::copy_if(body.links.begin(), body.links.end(), std::back_inserter(leaves),
                 [this](const std::string& link) { return tree_.below(link).empty(); });
    return leaves.size() == 1 ? leaves.front() : body.links.front();
  }

  /// Among links with one word returns the one with the fewest joints before it; nullopt at a tie.
  [[nodiscard]] std::optional<std::string> flange_by_name(const RigidBody& body) const {
    for (const std::string_view word : kFlanges) {
      std::optional<std::string> flange;
      std::size_t least{0};
      bool alone{true};
      for (const std::string& link : body.links) {
        if (!ends_with_word(link, word)) continue;
        const std::size_t depth = tree_.path(body.links.front(), link)->size();
        if (depth == 0 && word.starts_with("link")) continue;  // joint 8 moves it, so it is no flange
        if (flange && depth >= least) {
          alone = alone && depth > least;
          continue;
        }
        flange = link;
        least = depth;
        alone = true;
      }
      if (flange && alone) return flange;
    }
    return std::nullopt;
  }

  /// Returns the last link that precedes all joints of the gripper.
  [[nodiscard]] std::string before_gripper(const RigidBody& body) const {
    std::optional<std::vector<JointPtr>> shared;
    for (const std::string& link : body.links) {
      const auto& below = tree_.below(link);
      if (std::none_of(below.begin(), below.end(), [](const JointPtr& joint) { return moves(*joint); })) continue;
      auto way = tree_.path(body.links.front(), link);
      if (shared) {
        const auto [end, ignored] = std::mismatch(shared->begin(), shared->end(), way->begin(), way->end());
        way->resize(static_cast<std::size_t>(end - shared->begin()));
      }
      shared = std::move(way);
    }
    return shared && !shared->empty() ? shared->back()->child_link_name : body.links.front();
  }

  /// Chooses an optical frame that is fixed to the tip. A tip that was not named moves as if that frame had been named:
  /// to the link behind the last joint.
  Status choose_camera() {
    const std::string first = tree_.last_moving(chain_.base, chain_.tip);
    RigidBody body{0, {}};
    std::vector<RigidBody> ignored;
    add_body(first, body, ignored);
    const Links frames = optical_frames(body.links);
    Links deep;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(deep),
                 [](const std::string& link) { return in_small_letters(link).find("depth") != std::string::npos; });
    if (frames.empty()) {
      take_tip_as_camera();
      return {};
    }
    const bool measured = config_.T_flange_camera.has_value();
    if (frames.size() > 1 && deep.size() != 1 && !measured)
      return unclear("several optical frames are fixed to " + first +
                     "; name the camera's: " + options_text("--camera-frame", frames));
    if (config_.tip.empty()) chain_.tip = first;
    if (frames.size() > 1 && deep.size() != 1) {
      chain_.camera = chain_.tip;
      return {};
    }
    chain_.camera = frames.size() == 1 ? frames.front() : deep.front();
    if (!measured) say_which_camera(frames);
    return {};
  }

  void say_which_camera(const Links& frames) {
    Links others;
    std::remove_copy(frames.begin(), frames.end(), std::back_inserter(others), chain_.camera);
    chain_.choices.push_back(chain_.camera + " is taken for the camera's optical frame" +
                             (others.empty() ? "" : "; others there: " + options_text("--camera-frame", others)));
  }

  void take_tip_as_camera() {
    chain_.camera = chain_.tip;
    if (config_.T_flange_camera) return;
    const Links elsewhere = optical_frames(tree_.links());
    chain_.choices.push_back(
        "no camera is mounted: its frame is taken to be that of " + chain_.tip + ", z forward" +
        (elsewhere.empty() ? "" : "; not fixed to it: " + options_text("--camera-frame", elsewhere)));
  }

  const UrdfTree& tree_;
  const UrdfConfig& config_;
  ArmChain chain_;
  Links gripper_;  ///< joints behind a chosen tip
};

}  // namespace

Result<ArmChain> find_arm_chain(const UrdfTree& tree, const UrdfConfig& config) {
  return ChainFinder{tree, config}.run();
}

}  // namespace saccade
