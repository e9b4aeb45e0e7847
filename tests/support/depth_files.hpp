// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth images as bytes: plain TIFF, PGM and NPY, made without the library's own writers.

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace saccade::test {

template <class T>
std::string bytes_of_values(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Makes a little-endian TIFF of one strip without compression. `format`: 1 unsigned, 2 signed, 3 float.
inline std::string make_tiff(std::uint32_t width, std::uint32_t height, std::uint16_t bits, std::uint16_t format,
                             const std::string& pixels, std::uint16_t channels = 1, std::uint16_t compression = 1) {
  struct Entry {
    std::uint16_t tag;
    std::uint16_t type;  // 3: 16 bits, 4: 32 bits
    std::uint32_t value;
  };
  constexpr std::uint32_t kHeader{8};
  const std::vector<Entry> entries{{256, 4, width},
                                   {257, 4, height},
                                   {258, 3, bits},
                                   {259, 3, compression},
                                   {262, 3, channels == 3 ? 2U : 1U},
                                   {273, 4, kHeader},
                                   {277, 3, channels},
                                   {278, 4, height},
                                   {279, 4, static_cast<std::uint32_t>(pixels.size())},
                                   {339, 3, format}};
  std::string file{"II*\0", 4};
  const auto add = [&file](auto value) { file += bytes_of_values(std::vector{value}); };
  add(static_cast<std::uint32_t>(kHeader + pixels.size()));
  file += pixels;
  add(static_cast<std::uint16_t>(entries.size()));
  for (const Entry& entry : entries) {
    add(entry.tag);
    add(entry.type);
    add(std::uint32_t{1});
    add(entry.value);
  }
  add(std::uint32_t{0});
  return file;
}

/// Makes a NumPy file, format 1.0.
inline std::string make_npy(std::string_view type, std::string_view shape, const std::string& numbers,
                            bool is_fortran = false) {
  std::string dict = "{'descr': '" + std::string{type} + "', 'fortran_order': " + (is_fortran ? "True" : "False") +
                     ", 'shape': " + std::string{shape} + ", }\n";
  std::string file{"\x93NUMPY\x01\x00", 8};
  file += static_cast<char>(dict.size() & 0xFFU);
  file += static_cast<char>(dict.size() >> 8U);
  return file + dict + numbers;
}

}  // namespace saccade::test
