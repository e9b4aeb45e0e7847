// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/surfel_array.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "saccade/io/files/npy_io.hpp"

namespace saccade {
namespace {

constexpr std::size_t kColumns{12};
using Row = std::array<float, kColumns>;
constexpr std::array<std::size_t, 3> kNotNegative{3, 7, 11};  ///< radius and weights

static_assert(sizeof(SurfelDisc) + sizeof(SurfelColor) == sizeof(Row));

}  // namespace

std::vector<std::byte> encode_surfels(const SurfelMap& map) {
  const std::array<std::size_t, 2> shape{map.size(), kColumns};
  const std::string header = npy_header("<f4", shape);
  std::vector<std::byte> file(header.size() + map.size() * sizeof(Row));
  std::memcpy(file.data(), header.data(), header.size());
  std::byte* to = file.data() + header.size();
  for (std::size_t i = 0; i < map.size(); ++i, to += sizeof(Row)) {
    std::memcpy(to, &map.discs[i], sizeof(SurfelDisc));
    std::memcpy(to + sizeof(SurfelDisc), &map.colors[i], sizeof(SurfelColor));
  }
  return file;
}

Result<SurfelMap> decode_surfels(std::span<const std::byte> file) {
  SACCADE_TRY(const NpyArray array, parse_npy_array(file));
  const auto corrupt = [](const std::string& what) { return Error{Errc::corrupt_data, "surfels: " + what, {}}; };
  if (array.type != "<f4" || array.is_fortran || array.shape.size() != 2 || array.shape[1] != kColumns) {
    return corrupt("not an array of " + std::to_string(kColumns) + " columns of 32-bit floats");
  }
  const std::size_t count = array.shape[0];
  if (count >= kNoSurfel || array.bytes.size() != count * sizeof(Row)) {
    return corrupt("the file does not hold as many rows as it says");
  }
  SurfelMap map;
  map.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Row row;
    std::memcpy(row.data(), array.bytes.data() + i * sizeof(Row), sizeof(Row));
    const bool finite = std::all_of(row.begin(), row.end(), [](float value) { return std::isfinite(value); });
    const bool signs =
        std::all_of(kNotNegative.begin(), kNotNegative.end(), [&](std::size_t k) { return row[k] >= 0.0F; });
    if (!finite || !signs) return corrupt("row " + std::to_string(i) + " is no surfel");
    std::memcpy(static_cast<void*>(&map.discs[i]), row.data(), sizeof(SurfelDisc));
    std::memcpy(static_cast<void*>(&map.colors[i]), row.data() + sizeof(SurfelDisc) / sizeof(float),
                sizeof(SurfelColor));
  }
  return map;
}

}  // namespace saccade
