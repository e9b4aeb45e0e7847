// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_model.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "saccade/core/length_limit.hpp"

namespace saccade {
namespace {

constexpr double kShortestAxis{1e-6};
constexpr double kInfinity{std::numeric_limits<double>::infinity()};

Error wrong(const std::string& what, const std::string& where) { return {Errc::invalid_argument, what, where}; }

/// Tells whether T is rigid and plausible for an arm: unbounded lengths could add up to infinity.
bool rigid(const Pose& T) {
  return T.matrix().allFinite() && T.translation().cwiseAbs().maxCoeff() <= kMaxLength_m &&
         (T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm() <= 1e-9 &&
         T.linear().determinant() > 0.0;
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

Status check_limits(const ArmJoint& joint, const std::string& where) {
  const JointLimits& limits = joint.limits;
  if (!positive(limits.speed)) return wrong("its speed limit must be positive and finite", where);
  if (!positive(limits.acceleration)) return wrong("its acceleration limit must be positive and finite", where);
  if (joint.kind == JointKind::continuous) return {};
  if (!std::isfinite(limits.lower) || !std::isfinite(limits.upper))
    return wrong("its position limits must be finite", where);
  if (limits.lower >= limits.upper) return wrong("its lower limit must lie below the upper one", where);
  return {};
}

Status check_joint(ArmJoint& joint) {
  const std::string where = "joint " + joint.name;
  const double length = joint.axis_joint.norm();
  if (!std::isfinite(length) || length < kShortestAxis) return wrong("its axis has no length", where);
  joint.axis_joint /= length;
  if (!rigid(joint.T_parent_joint)) return wrong("its origin is not a rigid transform, or is longer than 1 km", where);
  SACCADE_CHECK(check_limits(joint, where));
  if (joint.kind == JointKind::continuous) {
    joint.limits.lower = -kInfinity;
    joint.limits.upper = kInfinity;
  }
  return {};
}

Status check_shape(const BoxBody& box, const std::string& where) {
  if (box.size_m.allFinite() && box.size_m.minCoeff() > 0.0) return {};
  return wrong("the sides of a collision box must be positive", where);
}

Status check_shape(const SphereBody& sphere, const std::string& where) {
  if (positive(sphere.radius_m)) return {};
  return wrong("the radius of a collision sphere must be positive", where);
}

Status check_shape(const CylinderBody& cylinder, const std::string& where) {
  if (positive(cylinder.radius_m) && positive(cylinder.length_m)) return {};
  return wrong("radius and length of a collision cylinder must be positive", where);
}

Status check_shape(const MeshBody& body, const std::string& where) {
  if (body.mesh.triangles.empty()) return wrong("a collision mesh has no triangles", where);
  for (const Eigen::Vector3f& vertex : body.mesh.vertices) {
    if (!vertex.allFinite()) return wrong("a collision mesh has a vertex that is not finite", where);
  }
  for (const auto& triangle : body.mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= body.mesh.vertices.size()) return wrong("a collision mesh names a vertex it does not have", where);
    }
  }
  return {};
}

Status check_link(const ArmLink& link) {
  for (const CollisionBody& body : link.bodies) {
    const std::string where = "link " + (body.name.empty() ? link.name : body.name);
    if (!rigid(body.T_link_body))
      return wrong("the origin of a collision body is not a rigid transform, or is longer than 1 km", where);
    SACCADE_CHECK(std::visit([&where](const auto& shape) { return check_shape(shape, where); }, body.shape));
  }
  return {};
}

}  // namespace

std::string_view kind_of(const CollisionBody& body) {
  constexpr std::string_view kNames[]{"box", "sphere", "cylinder", "mesh"};
  return kNames[body.shape.index()];
}

Result<ArmModel> ArmModel::create(ArmDescription description) {
  const std::string where = description.name.empty() ? "the arm" : "arm " + description.name;
  if (description.joints.empty()) return wrong("has no joint that moves", where);
  if (description.joints.size() > static_cast<std::size_t>(kMaxJoints)) {
    return wrong("has " + std::to_string(description.joints.size()) + " joints; " + std::to_string(kMaxJoints) +
                     " at most are handled",
                 where);
  }
  if (description.links.size() != description.joints.size() + 1) return wrong("needs one link more than joints", where);
  for (ArmJoint& joint : description.joints) SACCADE_CHECK(check_joint(joint));
  for (const ArmLink& link : description.links) SACCADE_CHECK(check_link(link));
  if (!rigid(description.T_world_base))
    return wrong("the pose of its base is not a rigid transform, or is longer than 1 km", where);
  if (!rigid(description.T_link_flange))
    return wrong("the pose of its flange is not a rigid transform, or is longer than 1 km", where);
  if (!rigid(description.T_flange_camera))
    return wrong("its hand-eye transform is not a rigid transform, or is longer than 1 km", where);
  return ArmModel{std::move(description)};
}

ArmModel::ArmModel(ArmDescription description)
    : description_{std::move(description)},
      T_link_camera_{description_.T_link_flange * description_.T_flange_camera},
      middle_{Configuration::Zero(dof())} {
  for (int i = 0; i < dof(); ++i) {
    const JointLimits& limits = joint(i).limits;
    if (std::isfinite(limits.lower)) middle_[i] = 0.5 * (limits.lower + limits.upper);
  }
}

bool ArmModel::within_limits(const Configuration& q, double tolerance) const {
  SACCADE_EXPECTS(q.size() == dof());
  for (int i = 0; i < dof(); ++i) {
    const JointLimits& limits = joint(i).limits;
    if (!(q[i] >= limits.lower - tolerance && q[i] <= limits.upper + tolerance)) return false;
  }
  return true;
}

ArmModel slowed(const ArmModel& arm, double share) {
  SACCADE_EXPECTS(share > 0.0 && share <= 1.0);
  ArmDescription description = arm.description();
  for (ArmJoint& joint : description.joints) {
    joint.limits.speed *= share;
    joint.limits.acceleration *= share * share;
  }
  return ArmModel::create(std::move(description)).value();
}

Configuration sample_configuration(const ArmModel& arm, SeededRandom& random) {
  Configuration q{arm.dof()};
  for (int i = 0; i < arm.dof(); ++i) {
    const bool endless = arm.joint(i).kind == JointKind::continuous;
    q[i] = random.uniform(endless ? -std::numbers::pi : arm.joint(i).limits.lower,
                          endless ? std::numbers::pi : arm.joint(i).limits.upper);
  }
  return q;
}

}  // namespace saccade
