// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/urdf.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "saccade/arm/internal/arm_chain.hpp"
#include "saccade/arm/internal/urdf_document.hpp"
#include "saccade/arm/internal/urdf_tree.hpp"
#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using JointPtr = urdf::JointSharedPtr;

Error wrong(Errc code, const std::string& what, const std::string& where) { return {code, what, where}; }

Eigen::Vector3d to_eigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

constexpr std::size_t kMessageBytes{1000};

/// Makes the description, walking down the tree.
class ArmBuilder {
 public:
  ArmBuilder(const UrdfDocument& document, const fs::path& folder, const UrdfConfig& config)
      : document_{document}, tree_{*document.model}, folder_{folder}, config_{config} {}

  Result<UrdfArm> build() {
    SACCADE_TRY(chain_, find_arm_chain(tree_, config_));
    notes_ = chain_.choices;
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
    auto arm = ArmModel::create(std::move(arm_));
    // Limits and axes came from the file.
    if (!arm) return Error{Errc::corrupt_data, arm.error().message, arm.error().context};
    return UrdfArm{*std::move(arm), std::move(notes_), std::move(chain_.choices)};
  }

 private:
  struct Place {
    std::size_t link;  ///< of the arm
    Pose T_link_frame;
    bool rigid;  ///< no joint stands still between
  };

  /// Whether a joint of the chain is one of the arm's. A gripper's that follows another stands still with that one.
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
      return wrong(Errc::unsupported,
                   "follows joint " + joint.mimic->joint_name +
                       ", as in a parallel linkage; that is handled behind the arm and beside it, not on its chain",
                   where);
    made.axis_joint = to_eigen(joint.axis);
    if (joint.limits != nullptr) {
      made.limits = {joint.limits->lower, joint.limits->upper, joint.limits->velocity, 0.0};
    } else if (made.kind != JointKind::continuous) {
      return wrong(Errc::corrupt_data, "has no limits", where);
    }
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

  /// Bodies of a link and of everything below it.
  Status walk(const std::string& name, std::size_t link, const Pose& T_link_frame, bool rigid) {
    places_[name] = {link, T_link_frame, rigid};
    SACCADE_CHECK(add_bodies(*tree_.link(name), link, T_link_frame));
    for (const JointPtr& joint : tree_.below(name)) {
      SACCADE_TRY(const Pose T_parent_joint, pose_of(joint->parent_to_joint_origin_transform, "joint " + joint->name));
      const Pose T_link_joint = T_link_frame * T_parent_joint;
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

  /// A joint that the arm does not move.
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

  Status add_bodies(const urdf::Link& link, std::size_t at, const Pose& T_link_frame) {
    std::vector<urdf::CollisionSharedPtr> bodies = link.collision_array;
    if (bodies.empty() && link.collision != nullptr) bodies.push_back(link.collision);
    if (bodies.empty() && (link.visual != nullptr || !link.visual_array.empty()))
      notes_.push_back("link " + link.name + " can be seen but has no collision body");
    for (const urdf::CollisionSharedPtr& collision : bodies) {
      const std::string where = "link " + link.name;
      if (collision == nullptr || collision->geometry == nullptr)
        return wrong(Errc::corrupt_data, "has a collision body without geometry", where);
      SACCADE_TRY(const Pose T_frame_body, pose_of(collision->origin, where));
      CollisionBody body{link.name, T_link_frame * T_frame_body, {}};
      SACCADE_CHECK(shape_of(*collision->geometry, where, body));
      arm_.links[at].bodies.push_back(std::move(body));
    }
    return {};
  }

  Status shape_of(const urdf::Geometry& geometry, const std::string& where, CollisionBody& body) const {
    switch (geometry.type) {
      case urdf::Geometry::SPHERE:
        body.shape = SphereBody{static_cast<const urdf::Sphere&>(geometry).radius};
        return {};
      case urdf::Geometry::BOX: body.shape = BoxBody{to_eigen(static_cast<const urdf::Box&>(geometry).dim)}; return {};
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        body.shape = CylinderBody{cylinder.radius, cylinder.length};
        return {};
      }
      case urdf::Geometry::MESH: return mesh_of(static_cast<const urdf::Mesh&>(geometry), where, body);
    }
    return wrong(Errc::unsupported, "has a collision body of an unknown kind", where);
  }

  Status mesh_of(const urdf::Mesh& mesh, const std::string& where, CollisionBody& body) const {
    const auto at_link = [&where](const Error& e) { return Error{e.code, e.message, where + ", " + e.context}; };
    const Eigen::Vector3f scale = to_eigen(mesh.scale).cast<float>();
    if (!scale.allFinite() || scale.cwiseAbs().minCoeff() == 0.0F)
      return wrong(Errc::corrupt_data, "its mesh is scaled by zero or what is not finite", where);
    const auto path = resolve_mesh(mesh.filename, folder_, config_.packages);
    if (!path) return at_link(path.error());
    auto triangles = read_any_mesh(*path);
    if (!triangles) return at_link(triangles.error());
    for (Eigen::Vector3f& vertex : triangles->vertices) vertex = vertex.cwiseProduct(scale);
    if (scale.prod() < 0.0F) {  // mirrored
      for (auto& [a, b, c] : triangles->triangles) std::swap(b, c);
    }
    triangles->normals.clear();
    body.shape = MeshBody{*std::move(triangles)};
    return {};
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

  [[nodiscard]] static std::string short_number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }

  const UrdfDocument& document_;
  UrdfTree tree_;
  fs::path folder_;
  const UrdfConfig& config_;
  ArmChain chain_;
  std::set<std::string> on_chain_;
  std::map<std::string, Place> places_;
  int without_acceleration_{0};
  ArmDescription arm_;
  std::vector<std::string> notes_;
};

}  // namespace

Result<UrdfArm> parse_urdf(const std::string& urdf, const fs::path& folder, const UrdfConfig& config) {
  if (!(config.default_speed > 0.0) || !(config.acceleration_time_s > 0.0))
    return Error{Errc::invalid_argument, "the default speed and the time to reach a speed must be positive", ""};
  const auto document = parse_urdf_document(urdf);
  auto arm = document ? ArmBuilder{*document, folder, config}.build() : Result<UrdfArm>{document.error()};
  if (arm) return arm;
  // Names in the file may be anything.
  return Error{arm.error().code, readable(arm.error().message, kMessageBytes),
               readable(arm.error().context, kMessageBytes)};
}

Result<UrdfArm> read_urdf(const fs::path& path, const UrdfConfig& config) {
  SACCADE_TRY(const std::string urdf, read_text_file(path));
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
  if (fs::exists(name_or_path)) return read_urdf(name_or_path, config);
  return Error{Errc::not_found, "no such robot; there are " + known + "and URDF files", name_or_path};
}

}  // namespace saccade
