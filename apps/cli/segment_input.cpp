// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "segment.hpp"

namespace saccade::cli {
namespace {

std::vector<float> coordinates(const std::vector<Eigen::Vector3f>& vectors, int axis) {
  std::vector<float> values(vectors.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = vectors[i][axis];
  return values;
}

void add_vectors(ColumnTable& fields, const std::vector<Eigen::Vector3f>& vectors,
                 const std::array<const char*, 3>& names) {
  for (int axis = 0; axis < 3; ++axis) {
    fields.add<float>(names[static_cast<std::size_t>(axis)], std::span<const float>{coordinates(vectors, axis)});
  }
}

ColumnTable fields_of(const TriangleMesh& mesh) {
  ColumnTable fields;
  add_vectors(fields, mesh.vertices, {"x", "y", "z"});
  if (!mesh.normals.empty()) add_vectors(fields, mesh.normals, {"normal_x", "normal_y", "normal_z"});
  if (mesh.colors.empty()) return fields;
  std::vector<std::uint32_t> packed;
  for (const Rgb8& c : mesh.colors) packed.push_back(std::uint32_t{c[0]} << 16U | std::uint32_t{c[1]} << 8U | c[2]);
  fields.add<std::uint32_t>("rgba", packed);
  return fields;
}

Result<SegmentInput> read_map_surface(const std::filesystem::path& path, const Executor& executor) {
  SACCADE_TRY(const TsdfSnapshot map, load_map(path, executor));
  TriangleMesh mesh = extract_mesh(map, executor);
  SegmentInput input;
  PcdFile file;
  file.table = fields_of(mesh);
  file.width = file.table.rows;
  input.file.file = std::move(file);
  input.map_voxel_size_m = map.config.voxel_size_m;
  input.triangles = std::move(mesh.triangles);
  return input;
}

}  // namespace

bool is_map(const std::filesystem::path& input) { return input.extension() == ".sacmap"; }

Result<SegmentInput> read_segment_input(const std::filesystem::path& path, const Executor& executor) {
  SegmentInput input;
  if (is_map(path)) {
    SACCADE_TRY(input, read_map_surface(path, executor));
  } else {
    SACCADE_TRY(input.file, read_cloud(path));
  }
  auto cloud = cloud_from_fields(input.file.fields());
  if (!cloud) return in_file(cloud.error(), path);
  input.cloud = std::move(*cloud);
  if (const auto* pcd = std::get_if<PcdFile>(&input.file.file)) {
    input.viewpoint_m = {pcd->viewpoint[0], pcd->viewpoint[1], pcd->viewpoint[2]};
  }
  return input;
}

}  // namespace saccade::cli
