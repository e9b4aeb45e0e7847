// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images in files: 16-bit PNG, 8-bit colour PNG and JPEG, masks; read from files or memory, written as PNG.

#include <cstddef>
#include <filesystem>
#include <span>

#include "saccade/core/result.hpp"
#include "saccade/io/frames/png.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

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

}  // namespace saccade
