// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_mesh.hpp"

namespace saccade {
namespace {

constexpr std::array<Rgb8, 2> kGreys{{{104, 112, 124}, {158, 166, 178}}};

/// Adds the part, transformed.
void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& T_world_part, const Rgb8& color) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : part.vertices) {
    mesh.vertices.push_back((T_world_part * vertex.cast<double>()).cast<float>());
  }
  for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  mesh.colors.resize(mesh.vertices.size(), color);
}

}  // namespace

TriangleMesh arm_mesh(const ArmModel& arm, const Configuration& q, const Rgb8& hand) {
  const ArmPoses poses = forward_kinematics(arm, q);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < arm.links().size(); ++i) {
    const Rgb8& color = i + 1 < arm.links().size() ? kGreys[i % kGreys.size()] : hand;
    for (const CollisionBody& body : arm.links()[i].bodies) {
      append(mesh, body_surface(body), poses.T_world_link[i], color);
    }
  }
  return mesh;
}

}  // namespace saccade
