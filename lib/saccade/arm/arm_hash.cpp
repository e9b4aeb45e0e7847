// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_model.hpp"

#include "saccade/core/fnv1a.hpp"

namespace saccade {
namespace {

void add(Fnv1a& hash, const BoxBody& box) { hash.add_all(box.size_m); }

void add(Fnv1a& hash, const SphereBody& sphere) { hash.add(sphere.radius_m); }

void add(Fnv1a& hash, const CylinderBody& cylinder) {
  hash.add(cylinder.radius_m);
  hash.add(cylinder.length_m);
}

void add(Fnv1a& hash, const MeshBody& body) {
  hash.add(std::uint64_t{body.mesh.vertices.size()});
  for (const Eigen::Vector3f& vertex : body.mesh.vertices) hash.add_all(vertex);
  for (const auto& triangle : body.mesh.triangles) {
    for (const std::uint32_t corner : triangle) hash.add(std::uint64_t{corner});
  }
}

}  // namespace

std::string arm_hash(const ArmModel& arm) {
  Fnv1a hash;
  hash.add_all(arm.T_world_base().matrix());
  for (const ArmJoint& joint : arm.joints()) {
    hash.add(static_cast<std::uint64_t>(joint.kind));
    hash.add_all(joint.T_parent_joint.matrix());
    hash.add_all(joint.axis_joint);
    for (const double limit : {joint.limits.lower, joint.limits.upper, joint.limits.speed, joint.limits.acceleration}) {
      hash.add(limit);
    }
  }
  for (const ArmLink& link : arm.links()) {
    hash.add(std::uint64_t{link.bodies.size()});
    for (const CollisionBody& body : link.bodies) {
      hash.add(std::uint64_t{body.shape.index()});
      hash.add_all(body.T_link_body.matrix());
      std::visit([&hash](const auto& shape) { add(hash, shape); }, body.shape);
    }
  }
  hash.add_all(arm.T_link_camera().matrix());
  return hash.text();
}

}  // namespace saccade
