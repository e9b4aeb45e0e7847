// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene_yaml.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/scene/internal/tabletop.hpp"
#include "saccade/scene/mesh_parts.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return extension;
}

/// Returns the vertex in axes whose z points up.
Eigen::Vector3f upright_vertex(const Eigen::Vector3f& vertex, char up) {
  if (up == 'y') return {vertex.x(), -vertex.z(), vertex.y()};
  if (up == 'x') return {-vertex.z(), vertex.y(), vertex.x()};
  return vertex;
}

/// Tells whether an object of this size fits on the table.
bool fits(const Eigen::Vector3d& size_m) {
  return size_m.x() <= kMostMeshLength_m && size_m.y() <= kMostMeshWidth_m && size_m.z() <= kMostMeshHeight_m &&
         size_m.maxCoeff() >= kLeastMeshSize_m;
}

std::string size_text(const Eigen::Vector3d& size_m) {
  std::ostringstream text;
  text.precision(3);
  text << size_m.x() << " x " << size_m.y() << " x " << size_m.z() << " m";
  return text.str();
}

Eigen::AlignedBox3d bounds_of_vertices(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3f& vertex : mesh.vertices) bounds.extend(vertex.cast<double>());
  return bounds;
}

/// Answers invalid_argument where the mesh is small beside the steps of float at its place. One that shrank to a point
/// counts only far away: near the origin it is a point.
Status check_steps(const Eigen::AlignedBox3d& bounds, const fs::path& path) {
  constexpr double kMostStep{1e-3};  // share of the largest extent
  constexpr double kFar{1e3};
  const double extent = bounds.sizes().maxCoeff();
  const auto farthest =
      static_cast<float>(std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff()));
  const double step = static_cast<double>(std::nextafter(farthest, std::numeric_limits<float>::max()) - farthest);
  if (step <= kMostStep * extent || (extent == 0.0 && farthest < kFar)) return {};
  std::ostringstream text;
  text.precision(2);
  text << "the mesh lies so far from the origin (" << farthest << ") that its coordinates are rounded to " << step
       << " units of its " << extent << "; move it to the origin";
  return Error{Errc::invalid_argument, text.str(), path.string()};
}

/// Returns a hint with the likely unit of the file; empty where none would fit.
std::string scale_hint(const Eigen::Vector3d& size_units) {
  struct Unit {
    double scale;
    const char* text;
  };
  for (const Unit& unit : {Unit{1.0, "1 (metres)"}, Unit{0.001, "0.001 (millimetres)"},
                           Unit{0.01, "0.01 (centimetres)"}, Unit{0.0254, "0.0254 (inches)"}}) {
    if (fits(unit.scale * size_units)) return unit.text;
  }
  return {};
}

}  // namespace

bool is_mesh_file(const fs::path& path) {
  constexpr std::array<std::string_view, 7> kExtensions{".ply", ".stl", ".obj", ".glb", ".gltf", ".off", ".dae"};
  return std::find(kExtensions.begin(), kExtensions.end(), extension_of(path)) != kExtensions.end();
}

Status MeshSceneConfig::validate() const {
  if (std::isfinite(scale) && scale > 0.0) return {};
  return Error{Errc::invalid_argument, "the scale of a mesh must be positive", "mesh scene"};
}

Result<TriangleMesh> read_upright_mesh(const fs::path& path, std::optional<UpAxis> up) {
  SACCADE_TRY(TriangleMesh mesh, read_any_mesh(path));
  if (mesh.triangles.empty()) return Error{Errc::corrupt_data, "the file has no triangles", path.string()};
  const char axis = up ? (*up == UpAxis::y ? 'y' : 'z') : stated_up_axis(path).value_or('z');
  bool finite{true};
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = upright_vertex(vertex, axis);
    finite = finite && vertex.allFinite();
  }
  if (!finite) return Error{Errc::corrupt_data, "a coordinate of the mesh is not finite", path.string()};
  mesh.normals.clear();
  SACCADE_CHECK(check_steps(bounds_of_vertices(mesh), path));
  turn_outside_out(mesh);
  return mesh;
}

Status check_object_size(const Eigen::Vector3d& size, double scale, const fs::path& file) {
  const Eigen::Vector3d size_m = scale * size;
  if (fits(size_m)) return {};
  const std::string hint = scale_hint(size);
  return Error{Errc::invalid_argument,
               "the object measures " + size_text(size_m) + "; on the table there is room for " +
                   size_text({kMostMeshLength_m, kMostMeshWidth_m, kMostMeshHeight_m}) + ", and " +
                   std::to_string(std::lround(100.0 * kLeastMeshSize_m)) + " cm are the least" +
                   (hint.empty() ? "; scale it" : "; a scale of " + hint + " would do: --mesh-scale"),
               file.string()};
}

Result<Scene> mesh_scene(const fs::path& path, const MeshSceneConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(TriangleMesh mesh, read_upright_mesh(path, config.up));
  const Eigen::AlignedBox3d bounds = bounds_of_vertices(mesh);
  SACCADE_CHECK(check_object_size(bounds.sizes(), config.scale, path));
  const Eigen::Vector3d foot{bounds.center().x(), bounds.center().y(), bounds.min().z()};
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = (config.scale * (vertex.cast<double>() - foot)).cast<float>();
  }
  Scene scene = empty_tabletop(path.filename().string());
  SceneObject object;
  object.name = "object";
  object.shape = MeshShape{std::move(mesh)};
  object.color = {198, 140, 82};
  object.texture = {Texture::Kind::checker, 0.025, 0.6};
  scene.objects.push_back(std::move(object));
  return scene;
}

Result<std::vector<fs::path>> mesh_files(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry{folder, code}, end; !code && entry != end; entry.increment(code)) {
    if (is_mesh_file(entry->path()) && !entry->is_directory()) files.push_back(entry->path());
  }
  if (code) return Error{Errc::io_failure, "the folder cannot be read: " + code.message(), folder.string()};
  if (files.empty()) {
    return Error{Errc::invalid_argument, "the folder holds no mesh (PLY, STL, OBJ, GLB, glTF, OFF, DAE)",
                 folder.string()};
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace saccade
