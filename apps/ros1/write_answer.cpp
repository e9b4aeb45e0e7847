// SPDX-License-Identifier: Apache-2.0
#include "kinfu_map.hpp"
#include "saccade/io/clouds/pcd_io.hpp"
#include "saccade/io/clouds/ply_io.hpp"

namespace saccade::ros1 {

std::string write_answer(const std::string& path, const MapAnswer& answer) {
  const PlainCloud& cloud = answer.cloud;
  const std::size_t step = cloud.fields.size();
  const auto text_of = [](const Status& status) { return status ? std::string{} : status.error().to_string(); };
  if (!answer.triangles.empty()) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i + step <= cloud.values.size(); i += step) {
      const float* p = &cloud.values[i];
      mesh.vertices.emplace_back(p[0], p[1], p[2]);
      mesh.normals.emplace_back(p[3], p[4], p[5]);
    }
    mesh.triangles = answer.triangles;
    return text_of(write_mesh(path, mesh));
  }
  PcdFile file;
  file.width = cloud.width;
  file.height = cloud.height;
  file.table.rows = step == 0 ? 0 : cloud.values.size() / step;
  for (std::size_t field = 0; field < step; ++field) {
    std::vector<float> values(file.table.rows);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = cloud.values[i * step + field];
    file.table.add(cloud.fields[field], std::span<const float>{values});
  }
  return text_of(write_pcd(path, file));
}

}  // namespace saccade::ros1
