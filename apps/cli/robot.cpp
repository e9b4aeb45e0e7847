// SPDX-License-Identifier: Apache-2.0
// saccade robot check: what a URDF says about an arm, as it is understood here, and what is wrong with it.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>
#include <vector>

#include "context.hpp"
#include "robot_options.hpp"
#include "robot_reach.hpp"
#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/io/files/json_io.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// null for what is infinite.
json number_json(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json joint_json(const ArmJoint& joint) {
  const JointLimits& limits = joint.limits;
  return {{"name", joint.name},
          {"kind", to_string(joint.kind)},
          {"axis", {joint.axis_joint.x(), joint.axis_joint.y(), joint.axis_joint.z()}},
          {"T_parent_joint", pose_to_json(joint.T_parent_joint)},
          {"lower", number_json(limits.lower)},
          {"upper", number_json(limits.upper)},
          {"speed", limits.speed},
          {"acceleration", limits.acceleration}};
}

json link_json(const ArmLink& link) {
  json bodies = json::array();
  for (const CollisionBody& body : link.bodies) {
    json entry{{"link", body.name}, {"kind", kind_of(body)}, {"T_link_body", pose_to_json(body.T_link_body)}};
    if (const auto* mesh = std::get_if<MeshBody>(&body.shape)) entry["triangles"] = mesh->mesh.triangles.size();
    bodies.push_back(std::move(entry));
  }
  return {{"name", link.name}, {"bodies", std::move(bodies)}};
}

json robot_json(const UrdfArm& read, const InverseKinematics& ik) {
  const ArmModel& arm = read.arm;
  json joints = json::array();
  json links = json::array();
  for (const ArmJoint& joint : arm.joints()) joints.push_back(joint_json(joint));
  for (const ArmLink& link : arm.links()) links.push_back(link_json(link));
  json result{{"robot", arm.name()},
              {"base", arm.links().front().name},
              {"flange", arm.description().flange_name},
              {"camera", arm.description().camera_name},
              {"T_flange_camera", pose_to_json(arm.description().T_flange_camera)},
              {"joints", std::move(joints)},
              {"links", std::move(links)},
              {"inverse_kinematics", to_string(ik.method())},
              {"left_open", to_string(ik.redundancy())},
              {"refined", ik.refines()},
              {"reach_bound_m", reach_bound_m(arm)},
              {"notes", read.notes}};
  if (!ik.why_numeric().empty()) result["why_numeric"] = ik.why_numeric();
  return result;
}

std::string limits_text(const ArmJoint& joint) {
  const JointLimits& limits = joint.limits;
  const bool slides = joint.kind == JointKind::prismatic;
  const double unit = slides ? 1.0 : to_deg(1.0);
  const std::string name = slides ? " m" : "°";
  const int decimals = slides ? 3 : 1;
  const std::string range = joint.kind == JointKind::continuous ? "without end"
                                                                : fixed(unit * limits.lower, decimals) + " to " +
                                                                      fixed(unit * limits.upper, decimals) + name;
  return std::string{to_string(joint.kind)} + ", " + range + ", " + fixed(unit * limits.speed, decimals) + name +
         "/s, " + fixed(unit * limits.acceleration, decimals) + name + "/s²";
}

std::string bodies_text(const ArmLink& link) {
  if (link.bodies.empty()) return "no collision body";
  std::string text;
  for (const CollisionBody& body : link.bodies) {
    text += (text.empty() ? "" : ", ") + std::string{kind_of(body)};
    if (const auto* mesh = std::get_if<MeshBody>(&body.shape))
      text += " of " + std::to_string(mesh->mesh.triangles.size()) + " triangles";
    if (body.name != link.name) text += " (" + body.name + ")";
  }
  return text;
}

std::string camera_text(const ArmModel& arm) {
  const Eigen::Vector3d p = arm.description().T_flange_camera.translation();
  return arm.description().camera_name + ", at (" + fixed(p.x(), 3) + ", " + fixed(p.y(), 3) + ", " + fixed(p.z(), 3) +
         ") m from the flange " + arm.description().flange_name;
}

/// Names the freedom that a pose leaves to the joints.
std::string left_open_text(const InverseKinematics& ik) {
  if (ik.redundancy() == IkRedundancy::swivel) return "the swivel of the elbow about the line from shoulder to wrist";
  const bool first = ik.redundancy() == IkRedundancy::first_joint;
  return "joint " + (first ? ik.arm().joints().front() : ik.arm().joints().back()).name;
}

std::string inverse_text(const InverseKinematics& ik) {
  std::string text{to_string(ik.method())};
  if (!ik.why_numeric().empty()) text += "; " + ik.why_numeric();
  if (ik.redundancy() != IkRedundancy::none) {
    text += "; a pose leaves one value open, which is sampled: " + left_open_text(ik);
  }
  if (ik.refines()) text += "; refined, as its axes meet, or are parallel, but for rounding";
  return text;
}

std::string robot_text(const UrdfArm& read, const InverseKinematics& ik) {
  const ArmModel& arm = read.arm;
  std::vector<std::pair<std::string, std::string>> lines;
  lines.emplace_back("robot", arm.name() + ", " + std::to_string(arm.dof()) + " joints");
  for (const ArmJoint& joint : arm.joints()) lines.emplace_back(joint.name, limits_text(joint));
  for (const ArmLink& link : arm.links()) lines.emplace_back(link.name, bodies_text(link));
  lines.emplace_back("camera", camera_text(arm));
  lines.emplace_back("reach", fixed(reach_bound_m(arm), 3) + " m at most, from the first joint to the camera");
  lines.emplace_back("inverse", inverse_text(ik));
  for (const std::string& note : read.notes) lines.emplace_back("note", note);
  std::size_t width{0};
  for (const auto& [name, text] : lines) width = std::max(width, name.size() + 2);
  std::ostringstream out;
  for (const auto& [name, text] : lines) {
    out << std::left << std::setw(static_cast<int>(width)) << name << text << '\n';
  }
  return out.str();
}

class RobotCheck final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "check",
            .description = "reads an arm from a URDF, and names the problems of the file",
            .result_name = "robot"};
  }
  void declare(Options& options) override { add_arm_options(options.group(), arm_)->required(); }
  void check(const GlobalOptions& /*global*/) override { check_arm_options(arm_); }
  [[nodiscard]] Result<Outcome> run(Context& /*context*/) override {
    SACCADE_TRY(const UrdfArm read, find_robot(arm_.robot, arm_.urdf));
    SACCADE_TRY(const InverseKinematics ik, InverseKinematics::create(read.arm));
    return Outcome{.result = robot_json(read, ik), .text = robot_text(read, ik)};
  }

 private:
  ArmOptions arm_;
};

class Robot final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"robot", "checks descriptions of arms, and draws what they reach"};
  }
  [[nodiscard]] std::vector<std::unique_ptr<Command>> parts() const override {
    std::vector<std::unique_ptr<Command>> parts;
    parts.push_back(std::make_unique<RobotCheck>());
    parts.push_back(make_robot_reach());
    return parts;
  }
};

}  // namespace

void add_robot(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Robot>(program, global, action);
}

}  // namespace saccade::cli
