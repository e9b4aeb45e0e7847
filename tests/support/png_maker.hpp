// SPDX-License-Identifier: Apache-2.0
#pragma once
// Builds PNG files byte by byte, right or wrong, without the library under test: stored deflate blocks, true checksums.

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace saccade::test {

inline std::uint32_t png_crc(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0U ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

inline std::string big_endian(std::uint32_t value) {
  std::string text;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) text.push_back(static_cast<char>((value >> shift) & 0xFFU));
  return text;
}

inline std::string png_chunk(std::string_view type, std::string_view data) {
  std::string body{type};
  body.append(data);
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(png_crc(body));
}

/// zlib stream of stored blocks.
inline std::string stored_zlib(std::string_view raw) {
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : raw) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521U;
    b = (b + a) % 65521U;
  }
  std::string out{"\x78\x01"};
  do {
    constexpr std::size_t kBlock{65535};
    const std::string_view block = raw.substr(0, kBlock);
    raw.remove_prefix(block.size());
    out.push_back(raw.empty() ? '\1' : '\0');
    for (const std::size_t value : {block.size(), ~block.size()}) {
      out.push_back(static_cast<char>(value & 0xFFU));
      out.push_back(static_cast<char>((value >> 8U) & 0xFFU));
    }
    out.append(block);
  } while (!raw.empty());
  return out + big_endian((b << 16U) | a);
}

struct PngSpec {
  std::uint32_t width{1};
  std::uint32_t height{1};
  std::uint8_t bit_depth{8};
  std::uint8_t color_type{0};  ///< 0 grey, 2 RGB, 3 palette, 4 grey + alpha, 6 RGBA
  bool interlaced{false};
  std::string palette{};
  std::string rows{};  ///< each row: filter byte, then packed samples
};

inline std::string png_header(const PngSpec& spec) {
  std::string header = big_endian(spec.width) + big_endian(spec.height);
  for (const int value : {int{spec.bit_depth}, int{spec.color_type}, 0, 0, spec.interlaced ? 1 : 0}) {
    header.push_back(static_cast<char>(value));
  }
  return std::string{"\x89PNG\r\n\x1a\n"} + png_chunk("IHDR", header);
}

inline std::string make_png(const PngSpec& spec) {
  std::string file = png_header(spec);
  if (!spec.palette.empty()) file += png_chunk("PLTE", spec.palette);
  return file + png_chunk("IDAT", stored_zlib(spec.rows)) + png_chunk("IEND", "");
}

}  // namespace saccade::test
