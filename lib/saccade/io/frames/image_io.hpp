// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images in files: 16-bit PNG, colour in PNG, JPEG, PPM and TIFF, masks; read from files or memory, written as PNG.
// DepthEncoding: conversion of depth samples to metres.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

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

/// Reads the size from the bytes before the pixels. Answers corrupt_data, or unsupported beyond kMaxImageEdge.
[[nodiscard]] Result<PngSize> png_size(std::span<const std::byte> file);

/// Decodes a whole PNG with libpng. Anything that libpng complains of, and a byte too few or too many, is corrupt_data
/// with the offset reached; unsupported beyond kMaxImageEdge. Transparent colours (tRNS) and ancillary chunks are
/// ignored. Memory is bounded by the size that the file can expand to. Safe to call concurrently; prints nothing.
[[nodiscard]] Result<PngPixels> decode_png(std::span<const std::byte> file);

/// Encodes a PNG file; deterministic for one version of libpng and zlib. Expects consistent sizes; unsupported when
/// libpng rejects the image.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const PngPixels& pixels);

/// Raw 16-bit samples of a single-channel PNG; DepthEncoding converts them.
using Image16 = Image<std::uint16_t>;

/// Decodes images. A damaged or truncated file is corrupt_data, never half an image; unsupported: other kinds of
/// pixels, CMYK JPEG, more than kMaxImageEdge pixels a side. Prints nothing. Safe to call concurrently.
[[nodiscard]] Result<Image16> decode_png16(std::span<const std::byte> file);
/// Decodes PNG, JPEG, PPM, PGM or TIFF, recognised by the first bytes; RGB order, grey is copied to all channels, alpha
/// is dropped.
[[nodiscard]] Result<ColorImage> decode_color(std::span<const std::byte> file);
/// Decodes a grey or colour PNG: 0 where all channels are 0, otherwise 255.
[[nodiscard]] Result<MaskImage> decode_mask(std::span<const std::byte> file);

/// Read images from files; the error's context starts with the path.
[[nodiscard]] Result<Image16> read_png16(const std::filesystem::path& path);
[[nodiscard]] Result<ColorImage> read_color(const std::filesystem::path& path);
[[nodiscard]] Result<MaskImage> read_mask(const std::filesystem::path& path);
/// Reads the size of a PNG without its pixels.
[[nodiscard]] Result<PngSize> read_png_size(const std::filesystem::path& path);

/// Write images atomically and deterministically. Answer io_failure naming the path; invalid_argument when empty.
[[nodiscard]] Status write_png16(const std::filesystem::path& path, const Image16& image);
[[nodiscard]] Status write_png(const std::filesystem::path& path, const ColorImage& image);
[[nodiscard]] Status write_png(const std::filesystem::path& path, const MaskImage& image);

/// depth = sample / units_per_m. Samples 0 and 65535 are "no return" in every encoding in use.
///
/// | data                                   | units_per_m | bit_rotated |
/// |----------------------------------------|-------------|-------------|
/// | Kinect, RealSense, 7-Scenes (mm)       | 1000        | no          |
/// | TUM RGB-D                              | 5000        | no          |
/// | Princeton APC / RGB-D SLAM of 0.1 mm   | 10000       | yes         |
///
/// Bit-rotated: the sample was rotated left by three bits before it was stored; the original is (v >> 3) | (v << 13).
struct DepthEncoding {
  double units_per_m{1000.0};
  bool bit_rotated{false};

  [[nodiscard]] Status validate() const {
    if (std::isfinite(units_per_m) && units_per_m > 0.0) return {};
    return Error{Errc::invalid_argument, "the depth scale (units per metre) must be positive", {}};
  }
  [[nodiscard]] bool operator==(const DepthEncoding&) const = default;
};

/// Converts to metres along z; 0 for invalid samples. Expects a valid encoding. O(pixels).
[[nodiscard]] inline DepthImage decode_depth(const Image16& samples, const DepthEncoding& encoding) {
  SACCADE_EXPECTS(encoding.validate().ok());
  constexpr std::uint16_t kSaturated{65535};
  const auto units_per_m = static_cast<float>(encoding.units_per_m);
  DepthImage depth{samples.width(), samples.height()};
  const std::uint16_t* in = samples.data();
  float* out = depth.data();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const unsigned stored = in[i];
    const auto sample = static_cast<std::uint16_t>(encoding.bit_rotated ? (stored >> 3U) | (stored << 13U) : stored);
    out[i] = sample == kSaturated ? 0.0F : static_cast<float>(sample) / units_per_m;
  }
  return depth;
}

/// Encodes depths, rounded to the nearest sample; no return, free claims and depths that do not fit become 0.
[[nodiscard]] inline Image16 encode_depth(const DepthImage& depth, const DepthEncoding& encoding) {
  SACCADE_EXPECTS(encoding.validate().ok());
  Image16 samples{depth.width(), depth.height()};
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double value = std::round(static_cast<double>(depth.data()[i]) * encoding.units_per_m);
    const unsigned sample = value >= 1.0 && value < 65535.0 ? static_cast<unsigned>(value) : 0U;
    samples.data()[i] = static_cast<std::uint16_t>(encoding.bit_rotated ? (sample << 3U) | (sample >> 13U) : sample);
  }
  return samples;
}

}  // namespace saccade
