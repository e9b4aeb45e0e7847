// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/urdf_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "saccade/arm/internal/convex_cover.hpp"
#include "saccade/arm/internal/urdf_document.hpp"
#include "saccade/core/length_limit.hpp"
#include "saccade/core/names.hpp"
#include "saccade/io/clouds/any_mesh.hpp"

namespace saccade {
namespace {

constexpr double kLargestBody_m{20.0};
constexpr double kSmallestBody_m{1e-3};
constexpr double kMillimetre_m{1e-3};
constexpr std::size_t kMostNamed{6};

Eigen::Vector3d vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

/// Largest extent along an axis of the body's frame; infinite where a number is not finite.
struct ExtentOf {
  double operator()(const BoxBody& box) const { return box.size_m.cwiseAbs().maxCoeff(); }
  double operator()(const SphereBody& sphere) const { return 2.0 * sphere.radius_m; }
  double operator()(const CylinderBody& cylinder) const { return std::max(2.0 * cylinder.radius_m, cylinder.length_m); }
  double operator()(const MeshBody& body) const {
    Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array3f high = -low;
    for (const Eigen::Vector3f& vertex : body.mesh.vertices) {
      if (!vertex.allFinite()) return std::numeric_limits<double>::infinity();
      low = low.min(vertex.array());
      high = high.max(vertex.array());
    }
    return static_cast<double>((high - low).maxCoeff());
  }
};

/// Tells whether a body is a primitive without volume.
bool is_flat(const CollisionBody& body) {
  if (const auto* box = std::get_if<BoxBody>(&body.shape)) return !(box->size_m.minCoeff() > 0.0);
  if (const auto* sphere = std::get_if<SphereBody>(&body.shape)) return !(sphere->radius_m > 0.0);
  const auto* cylinder = std::get_if<CylinderBody>(&body.shape);
  return cylinder != nullptr && !(cylinder->radius_m > 0.0 && cylinder->length_m > 0.0);
}

/// Returns a length with six digits at most: "0.4", "1e+30".
std::string length_text(double length) {
  std::ostringstream text;
  text << length;
  return text.str();
}

std::string some_of(const std::vector<std::string>& names) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(names.size(), kMostNamed));
  return joined(std::vector<std::string>(names.begin(), names.begin() + count)) +
         (names.size() > kMostNamed ? " and " + std::to_string(names.size() - kMostNamed) + " more" : "");
}

}  // namespace

std::string short_number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

Status UrdfBodies::add(const urdf::Link& link, const Pose& T_link_frame, std::vector<CollisionBody>& bodies) {
  std::vector<urdf::CollisionSharedPtr> collisions = link.collision_array;
  if (collisions.empty() && link.collision != nullptr) collisions.push_back(link.collision);
  if (collisions.empty()) return add_visuals(link, T_link_frame, bodies);
  for (const urdf::CollisionSharedPtr& collision : collisions) {
    if (collision == nullptr)
      return Error{Errc::corrupt_data, "has a collision body without geometry", "link " + link.name};
    SACCADE_TRY(CollisionBody body, body_of(collision->geometry.get(), collision->origin, link.name));
    body.T_link_body = T_link_frame * body.T_link_body;
    bodies.push_back(std::move(body));
    ++bodies_;
  }
  return {};
}

Status UrdfBodies::add_visuals(const urdf::Link& link, const Pose& T_link_frame, std::vector<CollisionBody>& bodies) {
  std::vector<urdf::VisualSharedPtr> visuals = link.visual_array;
  if (visuals.empty() && link.visual != nullptr) visuals.push_back(link.visual);
  bool taken{false};
  for (const urdf::VisualSharedPtr& visual : visuals) {
    if (visual == nullptr || visual->geometry == nullptr) continue;
    auto body = body_of(visual->geometry.get(), visual->origin, link.name);
    if (!body) {
      lost_.push_back(body.error().to_string());
      continue;
    }
    if (is_flat(*body)) {
      lost_.push_back("link " + link.name + ": its " + std::string{kind_of(*body)} + " has no volume");
      continue;
    }
    if (auto* mesh = std::get_if<MeshBody>(&body->shape)) mesh->mesh = convex_cover(mesh->mesh.vertices);
    body->T_link_body = T_link_frame * body->T_link_body;
    bodies.push_back(*std::move(body));
    taken = true;
    ++bodies_;
  }
  if (taken) stand_ins_.push_back(link.name);
  return {};
}

Result<CollisionBody> UrdfBodies::body_of(const urdf::Geometry* geometry, const urdf::Pose& origin,
                                          const std::string& link) {
  const std::string where = "link " + link;
  if (geometry == nullptr) return Error{Errc::corrupt_data, "has a collision body without geometry", where};
  SACCADE_TRY(const Pose T_link_body, pose_of(origin, where));
  CollisionBody body{link, T_link_body, {}};
  bool scaled{false};
  switch (geometry->type) {
    case urdf::Geometry::SPHERE: body.shape = SphereBody{static_cast<const urdf::Sphere&>(*geometry).radius}; break;
    case urdf::Geometry::BOX: body.shape = BoxBody{vector_of(static_cast<const urdf::Box&>(*geometry).dim)}; break;
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(*geometry);
      body.shape = CylinderBody{cylinder.radius, cylinder.length};
      break;
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(*geometry);
      SACCADE_TRY(TriangleMesh triangles, mesh_of(mesh, where));
      body.shape = MeshBody{std::move(triangles)};
      scaled = mesh.scale.x != 1.0;
      break;
    }
    default: return Error{Errc::unsupported, "has a collision body of an unknown kind", where};
  }
  SACCADE_CHECK(check_size(body, scaled, where));
  return body;
}

Result<TriangleMesh> UrdfBodies::mesh_of(const urdf::Mesh& mesh, const std::string& where) {
  const auto at_link = [&where](const Error& e) { return Error{e.code, e.message, where + ", " + e.context}; };
  const Eigen::Vector3f scale = vector_of(mesh.scale).cast<float>();
  if (!scale.allFinite() || scale.cwiseAbs().minCoeff() == 0.0F)
    return Error{Errc::corrupt_data, "its mesh is scaled by zero or what is not finite", where};
  const auto path = packages_.file(mesh.filename);
  if (!path) return at_link(path.error());
  auto triangles = read_any_mesh(*path);
  if (!triangles) return at_link(triangles.error());
  for (Eigen::Vector3f& vertex : triangles->vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() < 0.0F) {  // mirrored
    for (auto& [a, b, c] : triangles->triangles) std::swap(b, c);
  }
  triangles->normals.clear();
  if (triangles->vertices.empty()) return Error{Errc::corrupt_data, "its mesh has no triangles", where};
  return triangles;
}

Status UrdfBodies::check_size(const CollisionBody& body, bool scaled, const std::string& where) {
  const bool mesh = std::holds_alternative<MeshBody>(body.shape);
  const std::string kind{kind_of(body)};
  const double extent_m = std::visit(ExtentOf{}, body.shape);
  const std::string size = "its " + kind + " is " + length_text(extent_m) + " m across";
  if (!std::isfinite(extent_m))
    return Error{Errc::corrupt_data, "its " + kind + " has a size that is not finite", where};
  if (extent_m > (mesh ? kLargestBody_m : kMaxLength_m)) {
    const bool millimetres = extent_m * kMillimetre_m <= kLargestBody_m;
    const std::string advice =
        !millimetres ? ""
                     : (mesh && !scaled ? "; if the file is in millimetres, give its mesh scale=\"0.001 0.001 0.001\""
                                        : "; are these millimetres?");
    return Error{Errc::corrupt_data, size + ", and URDFs are in metres" + advice, where};
  }
  if (extent_m > kLargestBody_m) sizes_.push_back(where + ": " + size + "; are these millimetres?");
  if (extent_m < kSmallestBody_m && extent_m > 0.0) {
    const std::string thousandths = length_text(extent_m / kMillimetre_m) + " mm across";
    sizes_.push_back(where + ": its " + kind + " is " + thousandths +
                     (scaled ? "; is its file in metres already, and its scale too much?" : ""));
  }
  return {};
}

std::vector<std::string> UrdfBodies::remarks() const {
  std::vector<std::string> all;
  if (!stand_ins_.empty()) {
    all.push_back("links without a collision body take their visual one, of meshes the convex hull: " +
                  some_of(stand_ins_));
  }
  if (!lost_.empty()) {
    all.push_back("links without a collision body have a visual one that cannot be read, so nothing stands for them: " +
                  some_of(lost_));
  }
  if (bodies_ == 0) all.emplace_back("no link has a collision or a visual body: contacts of the arm go unnoticed");
  if (!sizes_.empty()) all.push_back("lengths in a URDF are in metres: " + some_of(sizes_));
  return all;
}

}  // namespace saccade
