// SPDX-License-Identifier: Apache-2.0
#pragma once
// PNG in memory: inspect_png checks a file whole, decode_png and encode_png.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Largest width and height of images that are read.
constexpr int kMaxImageEdge{1 << 14};

/// Pixels of a PNG: row-major, channels interleaved; 16-bit samples take two bytes in the machine's order.
struct PngPixels {
  int width{0};
  int height{0};
  int channels{1};     ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA; palettes are expanded to RGB
  int sample_bits{8};  ///< 8 or 16; fewer bits are expanded to 8
  std::vector<std::uint8_t> bytes;
};

struct PngSize {
  int width{0};
  int height{0};
};

/// Size from the header alone (signature, IHDR and its checksum). corrupt_data, or unsupported beyond kMaxImageEdge.
[[nodiscard]] Result<PngSize> png_size(std::span<const std::byte> file);

/// Decodes a whole PNG. Everything is checked: signature, chunk lengths and CRCs, IEND, exact length and Adler-32 of
/// the pixels; a file that lacks one byte is corrupt_data with the byte offset. unsupported: interlaced files and sizes
/// beyond kMaxImageEdge. Memory is bounded by what the compressed data can expand to.
[[nodiscard]] Result<PngPixels> decode_png(std::span<const std::byte> file);

/// PNG file of the given pixels; the same bytes every time. Expects sizes that agree.
[[nodiscard]] std::vector<std::byte> encode_png(const PngPixels& pixels);

}  // namespace saccade
