// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/surfel_cloud.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "saccade/io/clouds/pcd_io.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/surfel/surfel_points.hpp"

namespace saccade {
namespace {

void add_vectors(ColumnTable& table, const std::array<const char*, 3>& names,
                 const std::vector<Eigen::Vector3f>& vectors) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::vector<float> values;
    values.reserve(vectors.size());
    for (const Eigen::Vector3f& vector : vectors) values.push_back(vector[static_cast<Eigen::Index>(k)]);
    table.add<float>(names[k], values);
  }
}

void add_colors(ColumnTable& table, const std::vector<Eigen::Vector3f>& colors, bool ply) {
  std::array<std::vector<std::uint8_t>, 3> channels;
  std::vector<float> packed;
  for (const Eigen::Vector3f& color : colors) {
    const Rgb8 bytes = byte_color(color);
    for (std::size_t k = 0; k < bytes.size(); ++k) channels[k].push_back(bytes[k]);
    packed.push_back(
        std::bit_cast<float>((std::uint32_t{bytes[0]} << 16U) | (std::uint32_t{bytes[1]} << 8U) | bytes[2]));
  }
  if (!ply) return table.add<float>("rgb", packed);
  table.add<std::uint8_t>("red", channels[0]);
  table.add<std::uint8_t>("green", channels[1]);
  table.add<std::uint8_t>("blue", channels[2]);
}

}  // namespace

Status write_surfel_cloud(const std::filesystem::path& path, const SurfelMap& map, std::span<const SurfelMode> modes,
                          double min_weight) {
  if (!modes.empty() && modes.size() != map.size()) {
    return Error{Errc::size_mismatch, "there are not as many modes as surfels", path.string()};
  }
  const SurfelPoints points = surfel_points(map, modes, min_weight);
  const bool ply = path.extension() == ".ply";
  ColumnTable table;
  add_vectors(table, {"x", "y", "z"}, points.positions_m);
  if (ply) {
    add_vectors(table, {"nx", "ny", "nz"}, points.normals);
  } else {
    add_vectors(table, {"normal_x", "normal_y", "normal_z"}, points.normals);
  }
  if (points.has_color) add_colors(table, points.colors, ply);
  table.add<float>("radius", points.radii_m);
  table.add<float>("confidence", points.weights);
  return ply ? write_ply(path, table) : write_pcd(path, table);
}

}  // namespace saccade
