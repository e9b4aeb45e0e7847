// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth images as bytes: plain TIFF, NPY and EXR, made without the library's own writers.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
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

/// Makes an OpenEXR image of floats without compression; every channel has the same pixels. Names in alphabetical
/// order.
inline std::string make_exr(std::int32_t width, std::int32_t height, const std::vector<std::string>& channels,
                            const std::vector<float>& pixels, std::int32_t crop = 0) {
  std::string file{"\x76\x2f\x31\x01\x02\0\0\0", 8};
  const auto add = [&file](auto value) { file += bytes_of_values(std::vector{value}); };
  const auto name = [&](const std::string& text) { file.append(text.c_str(), text.size() + 1); };
  const auto attribute = [&](const std::string& key, const std::string& type, std::size_t bytes) {
    name(key);
    name(type);
    add(static_cast<std::int32_t>(bytes));
  };
  constexpr std::size_t kChannelBytes{17};
  std::size_t list_bytes{1};
  for (const std::string& channel : channels) list_bytes += channel.size() + kChannelBytes;
  attribute("channels", "chlist", list_bytes);
  for (const std::string& channel : channels) {
    name(channel);
    for (const std::int32_t value : {2, 0, 1, 1}) add(value);  // floats, linear, not subsampled
  }
  file += '\0';
  attribute("compression", "compression", 1);
  file += '\0';
  for (const auto& [key, less] : {std::pair{"dataWindow", crop}, std::pair{"displayWindow", 0}}) {
    attribute(key, "box2i", 4 * sizeof(std::int32_t));
    for (const std::int32_t value : {0, 0, width - 1 - less, height - 1}) add(value);
  }
  attribute("lineOrder", "lineOrder", 1);
  file += '\0';
  attribute("pixelAspectRatio", "float", sizeof(float));
  add(1.0F);
  attribute("screenWindowCenter", "v2f", 2 * sizeof(float));
  add(0.0F);
  add(0.0F);
  attribute("screenWindowWidth", "float", sizeof(float));
  add(1.0F);
  file += '\0';
  const std::size_t row = static_cast<std::size_t>(width) * sizeof(float);
  const std::size_t line = 2 * sizeof(std::int32_t) + row * channels.size();
  const std::size_t begin = file.size() + static_cast<std::size_t>(height) * sizeof(std::uint64_t);
  for (std::int32_t v = 0; v < height; ++v) add(std::uint64_t{begin + static_cast<std::size_t>(v) * line});
  for (std::int32_t v = 0; v < height; ++v) {
    add(v);
    add(static_cast<std::int32_t>(row * channels.size()));
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const std::size_t at = static_cast<std::size_t>(v) * row;
      const std::string bytes = bytes_of_values(pixels);
      file += bytes.substr(std::min(at, bytes.size()), row);
    }
  }
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
