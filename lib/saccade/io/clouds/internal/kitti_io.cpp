// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/kitti_io.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace saccade {
namespace {

static_assert(std::endian::native == std::endian::little, "KITTI's files are read in the byte order of x86 and ARM");

constexpr std::array<const char*, 4> kFields{"x", "y", "z", "intensity"};
constexpr std::size_t kPointBytes{kFields.size() * sizeof(float)};

Error wrong_size(std::size_t bytes, const char* what) {
  return {Errc::corrupt_data, std::string{what} + ", but the file has " + std::to_string(bytes), {}};
}

}  // namespace

Result<ColumnTable> parse_kitti_scan(std::span<const std::byte> file) {
  if (file.empty() || file.size() % kPointBytes != 0) {
    return wrong_size(file.size(), "a scan of KITTI has 16 bytes per point (x, y, z, intensity)");
  }
  ColumnTable table;
  table.rows = file.size() / kPointBytes;
  for (std::size_t k = 0; k < kFields.size(); ++k) {
    Column column{kFields[k], ColumnType::f32, 1, std::vector<std::byte>(table.rows * sizeof(float))};
    for (std::size_t i = 0; i < table.rows; ++i) {
      std::memcpy(&column.bytes[i * sizeof(float)], &file[i * kPointBytes + k * sizeof(float)], sizeof(float));
    }
    table.columns.push_back(std::move(column));
  }
  return table;
}

Result<std::vector<std::uint32_t>> parse_kitti_labels(std::span<const std::byte> file) {
  if (file.size() % sizeof(std::uint32_t) != 0) return wrong_size(file.size(), "labels of KITTI have 4 bytes each");
  std::vector<std::uint32_t> labels(file.size() / sizeof(std::uint32_t));
  if (!labels.empty()) std::memcpy(labels.data(), file.data(), file.size());
  return labels;
}

}  // namespace saccade
