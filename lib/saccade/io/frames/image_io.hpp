// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images in files: 16-bit PNG, 8-bit colour PNG and JPEG, masks; read from files or memory, written as PNG;
// DepthEncoding: what the samples of a depth image mean, and how they become metres.

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

/// Size from what precedes the pixels. corrupt_data, or unsupported beyond kMaxImageEdge.
[[nodiscard]] Result<PngSize> png_size(std::span<const std::byte> file);

/// Decodes a whole PNG with libpng. Whatever libpng complains of, and a byte too few or too many, is corrupt_data with
/// the offset reached; unsupported beyond kMaxImageEdge. Transparent colours (tRNS) and ancillary chunks do not count.
/// Memory is bounded by what the file can expand to. Safe to call concurrently; nothing is printed.
[[nodiscard]] Result<PngPixels> decode_png(std::span<const std::byte> file);

/// PNG file of the given pixels; the same bytes every time (with the same libpng and zlib). Expects sizes that agree;
/// unsupported when libpng refuses the image.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const PngPixels& pixels);

/// Raw 16-bit samples of a single-channel PNG; what they mean says DepthEncoding.
using Image16 = Image<std::uint16_t>;

/// A damaged or cut file is corrupt_data, never half an image; unsupported: other kinds of pixels, CMYK JPEG,
/// more than kMaxImageEdge pixels a side. Nothing is printed. Safe to call concurrently.
[[nodiscard]] Result<Image16> decode_png16(std::span<const std::byte> file);
/// PNG or JPEG, told apart by their first bytes; RGB order, grey is spread over the channels, alpha is dropped.
[[nodiscard]] Result<ColorImage> decode_color(std::span<const std::byte> file);
/// Grey or colour PNG: 0 where all channels are 0, else 255.
[[nodiscard]] Result<MaskImage> decode_mask(std::span<const std::byte> file);

/// The same from files; the error's context starts with the path.
[[nodiscard]] Result<Image16> read_png16(const std::filesystem::path& path);
[[nodiscard]] Result<ColorImage> read_color(const std::filesystem::path& path);
[[nodiscard]] Result<MaskImage> read_mask(const std::filesystem::path& path);
/// Size of a PNG; its pixels are not looked at.
[[nodiscard]] Result<PngSize> read_png_size(const std::filesystem::path& path);

/// Written atomically; the same bytes for the same image. io_failure naming the path; invalid_argument when empty.
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
/// Bit-rotated: the sample was rotated left by three bits before it was stored; it is (v >> 3) | (v << 13).
struct DepthEncoding {
  double units_per_m{1000.0};
  bool bit_rotated{false};

  [[nodiscard]] Status validate() const {
    if (std::isfinite(units_per_m) && units_per_m > 0.0) return {};
    return Error{Errc::invalid_argument, "the depth scale (units per metre) must be positive", {}};
  }
  [[nodiscard]] bool operator==(const DepthEncoding&) const = default;
};

/// Metres along z; 0 where the sample is none. Expects a valid encoding. O(pixels).
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

/// The inverse, rounded to the nearest sample; no return, free claims and depths that do not fit become 0.
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
