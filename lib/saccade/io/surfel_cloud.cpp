// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/surfel_cloud.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "saccade/io/pcd_io.hpp"
#include "saccade/io/ply_io.hpp"

namespace saccade {
namespace {

std::array<std::uint8_t, 3> bytes_of_color(const Eigen::Vector3f& color) {
  const auto level = [](float value) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  };
  return {level(color.x()), level(color.y()), level(color.z())};
}

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
    const std::array<std::uint8_t, 3> bytes = bytes_of_color(color);
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

Status write_surfel_cloud(const std::filesystem::path& path, const SurfelMap& map, std::span<const SurfelMode> modes) {
  if (!modes.empty() && modes.size() != map.size()) {
    return Error{Errc::size_mismatch, "there are not as many modes as surfels", path.string()};
  }
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> colors;
  std::vector<float> radii_m;
  std::vector<float> weights;
  bool has_color{false};
  for (SurfelId id = 0; id < map.size(); ++id) {
    const Surfel surfel = map.surfel(id);
    const bool has_mode = !modes.empty() && modes[id].weight > 0.0F;
    positions_m.push_back(has_mode ? modes[id].position_m : surfel.disc.position_m);
    colors.push_back(has_mode ? modes[id].color : surfel.color.color);
    normals.push_back(surfel.disc.normal);
    radii_m.push_back(surfel.disc.radius_m);
    weights.push_back(surfel.disc.weight);
    has_color = has_color || surfel.color.weight > 0.0F;
  }
  const bool ply = path.extension() == ".ply";
  ColumnTable table;
  add_vectors(table, {"x", "y", "z"}, positions_m);
  if (ply) {
    add_vectors(table, {"nx", "ny", "nz"}, normals);
  } else {
    add_vectors(table, {"normal_x", "normal_y", "normal_z"}, normals);
  }
  if (has_color) add_colors(table, colors, ply);
  table.add<float>("radius", radii_m);
  table.add<float>("confidence", weights);
  return ply ? write_ply(path, table) : write_pcd(path, table);
}

}  // namespace saccade
