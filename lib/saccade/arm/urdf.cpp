// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/urdf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "saccade/arm/internal/arm_chain.hpp"
#include "saccade/arm/internal/urdf_bodies.hpp"
#include "saccade/arm/internal/urdf_document.hpp"
#include "saccade/arm/internal/urdf_tree.hpp"
#include "saccade/arm/internal/xacro.hpp"
#include "saccade/core/length_limit.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using JointPtr = urdf::JointSharedPtr;

Error wrong(Errc code, const std::string& what, const std::string& where) { return {code, what, where}; }

Eigen::Vector3d to_eigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

constexpr std::size_t kMessageBytes{1000};
constexpr double kLongestPart_m{20.0};
constexpr double kShortestArm_m{0.01};
constexpr double kMostTurn_rad{1000.0};
constexpr double kUsualTurn_rad{8.0 * std::numbers::pi};  ///< four turns either way; less than 30°, taken for radians
constexpr double kLongestXacro_s{86400.0};

/// Builder of the description, which walks down the tree.
class ArmBuilder {
 public:
  ArmBuilder(const UrdfDocument& document, const fs::path& folder, const UrdfConfig& config)
      : document_{document}, tree_{*document.model}, bodies_{folder, config}, config_{config} {}

  Result<UrdfArm> build() {
    SACCADE_TRY(chain_, find_arm_chain(tree_, config_));
    for (const JointPtr& joint : chain_.joints) on_chain_.insert(joint->name);
    arm_.name = document_.model->name_;
    arm_.links.push_back({chain_.base, {}});
    for (const JointPtr& joint : chain_.joints) {
      if (drives(*joint)) {
        SACCADE_CHECK(add_joint(*joint));
      }
    }
    if (arm_.joints.empty())
      return wrong(Errc::invalid_argument, "no joint moves between " + chain_.base + " and " + chain_.tip, "");
    SACCADE_CHECK(walk(chain_.base, 0, Pose::Identity(), true));
    SACCADE_CHECK(place_mounts());
    collect_choices();
    auto arm = ArmModel::create(std::move(arm_));
    // Limits and axes came from the file.
    if (!arm) return Error{Errc::corrupt_data, arm.error().message, arm.error().context};
    return UrdfArm{*std::move(arm), all_notes(), std::move(chain_.choices)};
  }

 private:
  /// Adds what is to be said about lengths, limits and bodies to the choices.
  void collect_choices() {
    if (reach_m_ > 0.0 && reach_m_ < kShortestArm_m)
      doubts_.push_back("the joints lie within " + short_number(1e3 * reach_m_) + " mm; URDFs are in metres");
    chain_.choices.insert(chain_.choices.end(), doubts_.begin(), doubts_.end());
    const std::vector<std::string> remarks = bodies_.remarks();
    chain_.choices.insert(chain_.choices.end(), remarks.begin(), remarks.end());
  }

  [[nodiscard]] std::vector<std::string> all_notes() const {
    std::vector<std::string> all = chain_.choices;
    all.insert(all.end(), notes_.begin(), notes_.end());
    return all;
  }

  struct Place {
    std::size_t link;  ///< link of the arm
    Pose T_link_frame;
    bool rigid;  ///< no held joint between
  };

  /// Tells whether a joint of the chain belongs to the arm. A gripper's joint that follows another stands still with
  /// that one.
  [[nodiscard]] bool drives(const urdf::Joint& joint) const {
    return moves(joint) && (joint.mimic == nullptr || chain_.gripper.count(joint.name) == 0);
  }

  Status add_joint(const urdf::Joint& joint) {
    const std::string where = "joint " + joint.name;
    ArmJoint made;
    made.name = joint.name;
    switch (joint.type) {
      case urdf::Joint::REVOLUTE: made.kind = JointKind::revolute; break;
      case urdf::Joint::CONTINUOUS: made.kind = JointKind::continuous; break;
      case urdf::Joint::PRISMATIC: made.kind = JointKind::prismatic; break;
      default: return wrong(Errc::unsupported, "only revolute, continuous and prismatic joints are handled", where);
    }
    if (joint.mimic != nullptr)
      return wrong(
          Errc::unsupported,
          "follows joint " + joint.mimic->joint_name +
              ", as in a parallel linkage; that is handled behind the arm and beside it, not on its chain: --tip "
              "with a link before it leaves it out",
          where);
    made.axis_joint = to_eigen(joint.axis);
    if (joint.limits != nullptr) {
      made.limits = {joint.limits->lower, joint.limits->upper, joint.limits->velocity, 0.0};
    } else if (made.kind != JointKind::continuous) {
      return wrong(Errc::corrupt_data, "has no limits", where);
    }
    if (made.kind != JointKind::continuous) SACCADE_CHECK(check_range(made, where));
    if (made.kind == JointKind::continuous && made.limits.speed == 0.0) {
      made.limits.speed = config_.default_speed;
      notes_.push_back(where + " has no speed limit: " + short_number(config_.default_speed) + " rad/s is taken");
    }
    const auto stated = document_.accelerations.find(joint.name);
    made.limits.acceleration =
        stated != document_.accelerations.end() ? stated->second : made.limits.speed / config_.acceleration_time_s;
    without_acceleration_ += stated == document_.accelerations.end() ? 1 : 0;
    arm_.joints.push_back(std::move(made));
    arm_.links.push_back({joint.child_link_name, {}});
    return {};
  }

  /// Compares a joint's limits with those of arms.
  Status check_range(const ArmJoint& joint, const std::string& where) {
    const double most = std::max(std::abs(joint.limits.lower), std::abs(joint.limits.upper));
    const bool slides = joint.kind == JointKind::prismatic;
    if (!(most <= (slides ? kMaxLength_m : kMostTurn_rad)))
      return wrong(Errc::corrupt_data,
                   slides ? "its limits are beyond 1 km"
                          : "its limits are beyond 1000 rad; a joint that turns without end is of the type continuous",
                   where);
    const std::string limits = short_number(joint.limits.lower) + " to " + short_number(joint.limits.upper);
    if (!slides && most > kUsualTurn_rad)
      doubts_.push_back(where + " turns from " + limits + "; URDFs are in radians: are these degrees?");
    if (slides && most > kLongestPart_m)
      doubts_.push_back(where + " slides from " + limits + "; URDFs are in metres: are these millimetres?");
    return {};
  }

  /// Doubts origins between the arm's joints that are longer than an arm's; the first one may place the arm in a hall.
  void check_origin(const urdf::Joint& joint, std::size_t link, const Pose& T_parent_joint) {
    const double length_m = T_parent_joint.translation().norm();
    if (link == 0) return;
    reach_m_ += length_m;
    if (length_m > kLongestPart_m)
      doubts_.push_back("joint " + joint.name + " lies " + short_number(length_m) +
                        " m from the joint before it; URDFs are in metres: are these millimetres?");
  }

  /// Adds the bodies of a link and of everything below it.
  Status walk(const std::string& name, std::size_t link, const Pose& T_link_frame, bool rigid) {
    places_[name] = {link, T_link_frame, rigid};
    SACCADE_CHECK(bodies_.add(*tree_.link(name), T_link_frame, arm_.links[link].bodies));
    for (const JointPtr& joint : tree_.below(name)) {
      SACCADE_TRY(const Pose T_parent_joint, pose_of(joint->parent_to_joint_origin_transform, "joint " + joint->name));
      const Pose T_link_joint = T_link_frame * T_parent_joint;
      check_origin(*joint, link, T_parent_joint);
      const bool chain = on_chain_.count(joint->name) > 0;
      if (chain && drives(*joint)) {
        arm_.joints[link].T_parent_joint = T_link_joint;
        SACCADE_CHECK(walk(joint->child_link_name, link + 1, Pose::Identity(), true));
      } else if (chain || name != chain_.tip || config_.keep_beyond_tip || leads_to_camera(*joint)) {
        const Pose T_joint_child = standing_still(*joint);
        SACCADE_CHECK(
            walk(joint->child_link_name, link, T_link_joint * T_joint_child, chain || (rigid && !moves(*joint))));
      } else {
        notes_.push_back("link " + joint->child_link_name + " and what is behind it are left out, beyond the tip");
      }
    }
    return {};
  }

  [[nodiscard]] bool leads_to_camera(const urdf::Joint& joint) const {
    return tree_.path(joint.child_link_name, chain_.camera).has_value();
  }

  /// Returns the transform of a joint that the arm does not move.
  Pose standing_still(const urdf::Joint& joint) {
    Pose T = Pose::Identity();
    if (!moves(joint)) return T;
    const double q = tree_.standing_value(joint);
    notes_.push_back("joint " + joint.name + why_still(joint) + ": it stands still at " + short_number(q));
    const Eigen::Vector3d axis = to_eigen(joint.axis);
    if (!axis.allFinite() || axis.norm() == 0.0 || joint.type == urdf::Joint::PLANAR ||
        joint.type == urdf::Joint::FLOATING)
      return T;
    if (joint.type == urdf::Joint::PRISMATIC) {
      T.translation() = q * axis.normalized();
    } else {
      T.linear() = Eigen::AngleAxisd{q, axis.normalized()}.toRotationMatrix();
    }
    return T;
  }

  [[nodiscard]] std::string why_still(const urdf::Joint& joint) const {
    if (joint.mimic == nullptr) return " is not on the chain";
    const std::string follows = " follows joint " + joint.mimic->joint_name;
    const urdf::JointConstSharedPtr master = tree_.master(joint);
    if (master == nullptr) return follows + ", which leads nowhere";
    return on_chain_.count(master->name) > 0 ? follows + ", but is not moved with it here" : follows;
  }

  Status place_mounts() {
    const Place& flange = places_.at(chain_.tip);
    const auto camera = places_.find(chain_.camera);
    if (camera == places_.end() || camera->second.link != arm_.joints.size() || !camera->second.rigid)
      return wrong(Errc::invalid_argument, "the camera's frame is not fixed to the tip " + chain_.tip,
                   "link " + chain_.camera);
    arm_.flange_name = chain_.tip;
    arm_.T_link_flange = flange.T_link_frame;
    arm_.camera_name = chain_.camera;
    if (config_.T_world_base) arm_.T_world_base = *config_.T_world_base;
    arm_.T_flange_camera =
        config_.T_flange_camera.value_or(flange.T_link_frame.inverse() * camera->second.T_link_frame);
    if (without_acceleration_ > 0) {
      notes_.push_back(std::to_string(without_acceleration_) + " of " + std::to_string(arm_.joints.size()) +
                       " joints have no acceleration limit: they are taken to reach their speed in " +
                       short_number(config_.acceleration_time_s) + " s");
    }
    return {};
  }

  const UrdfDocument& document_;
  UrdfTree tree_;
  UrdfBodies bodies_;
  const UrdfConfig& config_;
  ArmChain chain_;
  std::set<std::string> on_chain_;
  std::map<std::string, Place> places_;
  int without_acceleration_{0};
  double reach_m_{0.0};  ///< length of all origins behind the first joint
  ArmDescription arm_;
  std::vector<std::string> notes_;
  std::vector<std::string> doubts_;  ///< about lengths and limits
};

}  // namespace

Result<UrdfArm> parse_urdf(const std::string& urdf, const fs::path& folder, const UrdfConfig& config) {
  if (!(config.default_speed > 0.0) || !(config.acceleration_time_s > 0.0))
    return Error{Errc::invalid_argument, "the default speed and the time to reach a speed must be positive", ""};
  if (has_xacro_elements(urdf))
    return Error{Errc::unsupported, "has elements of xacro, which expands it: run " + xacro_command({}), ""};
  const auto document = parse_urdf_document(urdf);
  auto arm = document ? ArmBuilder{*document, folder, config}.build() : Result<UrdfArm>{document.error()};
  if (arm) return arm;
  // Names in the file may hold any characters.
  return Error{arm.error().code, readable(arm.error().message, kMessageBytes),
               readable(arm.error().context, kMessageBytes)};
}

Result<UrdfArm> read_urdf(const fs::path& path, const UrdfConfig& config) {
  SACCADE_TRY(std::string urdf, read_text_file(path));
  if (in_small_letters(path.extension().string()) == ".xacro" || has_xacro_elements(urdf)) {
    if (!(config.xacro_timeout_s > 0.0 && config.xacro_timeout_s <= kLongestXacro_s))
      return Error{Errc::invalid_argument, "the time limit of xacro must be positive and at most a day", ""};
    auto expanded = run_xacro(path, config);
    if (!expanded) return in_file(expanded.error(), path);
    urdf = *std::move(expanded);
  }
  auto arm = parse_urdf(urdf, path.parent_path(), config);
  if (!arm) return in_file(arm.error(), path);
  return arm;
}

Result<UrdfArm> find_robot(const std::string& name_or_path, const UrdfConfig& config) {
  std::string known;
  for (const BuiltinRobot& builtin : builtin_robots()) {
    if (!name_or_path.empty() && builtin.name.starts_with(name_or_path)) {
      return parse_urdf(std::string{builtin.urdf}, {}, config);
    }
    known += std::string{builtin.name} + ", ";
  }
  const fs::path path{name_or_path};
  std::error_code ignored;
  if (fs::exists(path, ignored)) return read_urdf(path, config);
  const std::string suffix = in_small_letters(path.extension().string());
  if (path.has_parent_path() || suffix == ".urdf" || suffix == ".xacro")
    return Error{Errc::not_found, "there is no such file", name_or_path};
  return Error{Errc::not_found, "no such robot; there are " + known + "and URDF files", name_or_path};
}

}  // namespace saccade
