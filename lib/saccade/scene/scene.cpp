// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "saccade/core/length_limit.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

// Keeps patterns from flickering on faces that lie on their lattice.
constexpr double kLatticeShift{0.37};

Error bad(const std::string& what, const std::string& where) { return Error{Errc::invalid_argument, what, where}; }

bool is_rigid(const Pose& T) { return pose_from_matrix(T.matrix()).ok(); }

Status check_object(const SceneObject& object) {
  const std::string where = "object " + object.name;
  if (const Status shape = validate(object.shape); !shape.ok()) return bad(shape.error().message, where);
  if (!is_rigid(object.T_world_object)) {
    return bad("its pose is not a rigid motion", where);
  }
  if (!(std::isfinite(object.texture.size_m) && object.texture.size_m > 0.0)) {
    return bad("the size of a texture must be positive", where);
  }
  for (const Patch& patch : object.patches) {
    if (const Status good = validate(patch); !good.ok()) return bad(good.error().message, where);
  }
  if (!(object.texture.darkening >= 0.0 && object.texture.darkening <= 1.0)) {
    return bad("the darkening of a texture is a share, within 0 and 1", where);
  }
  return {};
}

bool boxes_meet(const Box& a, const Box& b) {
  return (a.min.array() < b.max.array()).all() && (b.min.array() < a.max.array()).all();
}

std::array<long long, 3> cell_of(const Vector3d& p_object, double size_m) {
  const Vector3d scaled = p_object / size_m + Vector3d::Constant(kLatticeShift);
  return {std::llround(std::floor(scaled.x())), std::llround(std::floor(scaled.y())),
          std::llround(std::floor(scaled.z()))};
}

bool dark(const Texture& texture, const Vector3d& p_object) {
  if (texture.kind == Texture::Kind::plain) return false;
  const auto [x, y, z] = cell_of(p_object, texture.size_m);
  switch (texture.kind) {
    case Texture::Kind::checker: return ((x + y + z) & 1) != 0;
    case Texture::Kind::stripes: return (z & 1) != 0;
    default: break;
  }
  // Speckle: one cell in three, by a hash of its coordinates.
  std::uint64_t key = static_cast<std::uint64_t>(x) * 73856093U ^ static_cast<std::uint64_t>(y) * 19349663U ^
                      static_cast<std::uint64_t>(z) * 83492791U;
  key = (key ^ (key >> 31U)) * 0x7FB5D329728EA185ULL;
  return (key >> 33U) % 3U == 0;
}

bool is_near(const Box& box) {
  return std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()) <= kMaxLength_m;
}

Status check_workspace(const Box& workspace, const std::string& where) {
  if (!workspace.min.allFinite() || !workspace.max.allFinite()) return bad("the workspace is not finite", where);
  if (!is_near(workspace)) return bad("the workspace reaches farther than a kilometre from the origin", where);
  constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    if (workspace.min[axis] < workspace.max[axis]) continue;
    return bad(std::string{"the workspace is empty: its min is not below its max along "} +
                   kAxisNames[static_cast<std::size_t>(axis)],
               where);
  }
  return {};
}

}  // namespace

Status Scene::validate() const {
  const std::string where = "scene " + name;
  std::set<std::string> names;
  for (const SceneObject& object : objects) {
    if (object.name.empty()) return bad("every object needs a name", where);
    if (!names.insert(object.name).second) return bad("there are two objects of this name", "object " + object.name);
    SACCADE_CHECK(check_object(object));
  }
  SACCADE_CHECK(check_workspace(workspace, where));
  for (const Region& region : regions) {
    if (const Status good = saccade::validate(region); !good.ok())
      return bad(good.error().message, where + ", regions");
    if (!is_near(bounds(region))) return bad("a region reaches farther than a kilometre from the origin", where);
    if (!boxes_meet(bounds(region), workspace)) return bad("a region lies outside the workspace", where);
  }
  for (const Pose& T_world_camera : scan) {
    if (!is_rigid(T_world_camera)) {
      return bad("a pose of the initial scan is not a rigid motion", where);
    }
    if (T_world_camera.translation().cwiseAbs().maxCoeff() > kMaxLength_m) {
      return bad("a pose of the initial scan is farther than a kilometre from the origin", where);
    }
  }
  if (!(std::isfinite(max_deviation_m) && max_deviation_m > 0.0)) return bad("the deviation must be positive", where);
  return {};
}

Result<std::vector<ObjectMesh>> true_meshes(const Scene& scene) {
  SACCADE_CHECK(scene.validate());
  if (scene.objects.empty()) return bad("there are no objects to see", "scene " + scene.name);
  std::vector<ObjectMesh> meshes;
  for (const SceneObject& object : scene.objects) {
    SACCADE_TRY(TriangleMesh mesh, tessellate(object.shape, scene.max_deviation_m));
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = (object.T_world_object * vertex.cast<double>()).cast<float>();
    const auto near = [](const Eigen::Vector3f& vertex) { return vertex.allFinite() && vertex.norm() <= kMaxLength_m; };
    if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), near)) {
      return bad("it reaches farther than a kilometre from the origin", "object " + object.name);
    }
    for (Eigen::Vector3f& normal : mesh.normals) normal = object.T_world_object.linear().cast<float>() * normal;
    meshes.push_back({object.name, std::move(mesh), object.support});
  }
  return meshes;
}

Rgb8 surface_color(const SceneObject& object, const Vector3d& p_object) {
  if (!dark(object.texture, p_object)) return object.color;
  Rgb8 color = object.color;
  for (std::uint8_t& channel : color)
    channel = static_cast<std::uint8_t>(std::lround(channel * object.texture.darkening));
  return color;
}

}  // namespace saccade
