// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/benchmark_objects.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include "saccade/core/names.hpp"
#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/scene/mesh_parts.hpp"
#include "saccade/trial/internal/md5.hpp"
#include "saccade/trial/internal/stand_ins.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

std::string files_of(const Benchmark& benchmark) {
  return joined(benchmark.meshes, "; ", [](const BenchmarkMesh& mesh) { return mesh.file + " (" + mesh.from + ")"; });
}

Status check(const BenchmarkMesh& mesh, const fs::path& path) {
  SACCADE_TRY(const std::vector<std::byte> bytes, read_file(path));
  const std::string found = md5_of(bytes);
  if (found == mesh.md5) return {};
  return Error{Errc::invalid_argument,
               "this is another file than the protocol's: its MD5 is " + found + ", not " + mesh.md5 +
                   "; the right one: " + mesh.from,
               path.string()};
}

/// What is at a path. io_failure for a path that cannot be looked at, which is not one where nothing is.
Result<fs::file_status> status_of(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() != fs::file_type::none) return status;
  return Error{Errc::io_failure, "cannot be read: " + code.message(), path.string()};
}

Error takes_no_meshes(const Benchmark& benchmark, const fs::path& given) {
  return {Errc::invalid_argument, "the protocol " + benchmark.name + " has scenes of its own, and takes no meshes",
          given.string()};
}

/// Returns the names of a file's folders, the nearest first.
std::vector<std::string> folders_of(const fs::path& file) {
  std::error_code ignored;
  const fs::path whole = fs::absolute(file, ignored).lexically_normal();
  std::vector<std::string> folders;
  for (const fs::path& part : whole.relative_path().parent_path()) folders.insert(folders.begin(), part.string());
  return folders;
}

/// Returns names of the files that tell them apart from one another, and from those that are taken: with the nearest
/// folder above them that does, or else with all folders up to one. None where the files lie in one folder.
std::optional<std::vector<std::string>> names_by_folder(const std::vector<fs::path>& files,
                                                        const std::set<std::string>& taken) {
  std::vector<std::vector<std::string>> folders;
  for (const fs::path& file : files) folders.push_back(folders_of(file));
  const auto most = std::max_element(folders.begin(), folders.end(),
                                     [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<std::string> up_to(files.size());
  for (std::size_t level = 0; most != folders.end() && level < most->size(); ++level) {
    std::vector<std::string> single;
    std::vector<std::string> whole;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const std::string stem = files[i].stem().string();
      const std::string folder = level < folders[i].size() ? folders[i][level] + "-" : "";
      up_to[i] = folder + up_to[i];
      single.push_back(folder + stem);
      whole.push_back(up_to[i] + stem);
    }
    for (std::vector<std::string>& names : {std::ref(single), std::ref(whole)}) {
      std::set<std::string> all = taken;
      all.insert(names.begin(), names.end());
      if (all.size() == taken.size() + names.size()) return std::move(names);
    }
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<BenchmarkObject>> stand_ins_of(const Benchmark& benchmark) {
  std::vector<BenchmarkObject> objects;
  for (const std::string& name : benchmark.stand_ins) {
    SACCADE_TRY(std::vector<TriangleMesh> bodies, stand_in(name));
    objects.push_back({name, std::move(bodies)});
  }
  return objects;
}

Result<std::vector<BenchmarkObject>> read_objects(const Benchmark& benchmark, const fs::path& folder) {
  std::vector<BenchmarkObject> objects;
  std::set<std::string> found;
  SACCADE_TRY(const fs::file_status status, status_of(folder));
  if (!fs::exists(status)) return Error{Errc::not_found, "there is no such folder of meshes", folder.string()};
  if (!fs::is_directory(status)) {
    return Error{Errc::invalid_argument, "is a file; the meshes are read from a folder", folder.string()};
  }
  for (const BenchmarkMesh& named : benchmark.meshes) {
    if (found.count(named.object) > 0) continue;
    const fs::path path = folder / named.file;
    SACCADE_TRY(const fs::file_status mesh_status, status_of(path));
    if (!fs::exists(mesh_status)) continue;
    if (!fs::is_regular_file(mesh_status)) {  // a pipe would be waited for
      return Error{Errc::invalid_argument, "is not an ordinary file", path.string()};
    }
    SACCADE_CHECK(check(named, path));
    SACCADE_TRY(TriangleMesh mesh, read_any_mesh(path));
    if (mesh.triangles.empty()) return Error{Errc::corrupt_data, "the file has no triangles", path.string()};
    if (named.up == UpAxis::y) {
      for (Eigen::Vector3f& p : mesh.vertices) p = {p.x(), -p.z(), p.y()};
    }
    mesh.normals.clear();
    found.insert(named.object);
    objects.push_back({path.stem().string(), {std::move(mesh)}});
  }
  if (!objects.empty()) return objects;
  if (benchmark.meshes.empty()) return takes_no_meshes(benchmark, folder);
  return Error{Errc::not_found, "none of the meshes of " + benchmark.name + " is there: " + files_of(benchmark),
               folder.string()};
}

Result<std::vector<std::string>> own_object_names(std::span<const fs::path> files) {
  std::map<std::string, std::vector<std::size_t>> by_stem;
  for (std::size_t i = 0; i < files.size(); ++i) by_stem[files[i].stem().string()].push_back(i);
  std::vector<std::string> names(files.size());
  std::set<std::string> taken;
  for (const auto& [stem, members] : by_stem) {
    taken.insert(stem);
    for (const std::size_t i : members) names[i] = stem;
  }
  for (const auto& [stem, members] : by_stem) {
    if (members.size() == 1) continue;
    std::vector<fs::path> clashing;
    for (const std::size_t i : members) clashing.push_back(files[i]);
    const auto apart = names_by_folder(clashing, taken);
    if (!apart) {
      return Error{Errc::invalid_argument,
                   "the object of " + clashing[0].string() + " is called " + stem + ", too; rename one of the files",
                   clashing[1].string()};
    }
    for (std::size_t k = 0; k < members.size(); ++k) names[members[k]] = (*apart)[k];
    taken.insert(apart->begin(), apart->end());
  }
  return names;
}

Result<std::vector<BenchmarkObject>> read_own_objects(const Benchmark& benchmark, std::span<const fs::path> files,
                                                      const MeshSceneConfig& config) {
  SACCADE_CHECK(config.validate());
  if (files.empty()) return Error{Errc::invalid_argument, "there is no mesh", "benchmark " + benchmark.name};
  if (benchmark.has_own_scenes()) return takes_no_meshes(benchmark, files.front());
  SACCADE_TRY(const std::vector<std::string> names, own_object_names(files));
  std::vector<BenchmarkObject> objects;
  for (const fs::path& file : files) {
    SACCADE_TRY(TriangleMesh mesh, read_upright_mesh(file, config.up));
    Eigen::AlignedBox3f bounds;
    for (const Eigen::Vector3f& vertex : mesh.vertices) bounds.extend(vertex);
    const Eigen::Vector3d size = bounds.sizes().cast<double>();
    if (benchmark.true_size) SACCADE_CHECK(check_object_size(size, config.scale, file));
    if (!(size.maxCoeff() > 0.0)) return Error{Errc::corrupt_data, "the mesh is a single point", file.string()};
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= static_cast<float>(config.scale);
    objects.push_back({names[objects.size()], bodies_of(std::move(mesh))});
  }
  return objects;
}

}  // namespace saccade
