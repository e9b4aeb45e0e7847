// SPDX-License-Identifier: Apache-2.0
#pragma once
// PNG in memory: png_size, decode_png and encode_png.

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

/// Size from what precedes the pixels. corrupt_data, or unsupported beyond kMaxImageEdge.
[[nodiscard]] Result<PngSize> png_size(std::span<const std::byte> file);

/// Decodes a whole PNG with libpng. Whatever libpng complains of, and a byte too few or too many, is corrupt_data with
/// the offset reached; unsupported beyond kMaxImageEdge. Transparent colours (tRNS) and ancillary chunks do not count.
/// Memory is bounded by what the file can expand to. Safe to call concurrently; nothing is printed.
[[nodiscard]] Result<PngPixels> decode_png(std::span<const std::byte> file);

/// PNG file of the given pixels; the same bytes every time (with the same libpng and zlib). Expects sizes that agree;
/// unsupported when libpng refuses the image.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const PngPixels& pixels);

}  // namespace saccade
