// SPDX-License-Identifier: Apache-2.0
#pragma once
// SampleImage: samples of an image in PGM, PPM, TIFF, NPY or EXR. Used by depth_io.cpp and image_io.cpp.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

enum class SampleKind { whole8, whole16, whole32, real };

struct SampleImage {
  int width{0};
  int height{0};
  int channels{1};
  SampleKind kind{SampleKind::whole16};
  std::vector<float> values;  ///< row-major, channels interleaved; whole numbers beyond 2²⁴ are rounded
};

// Tell formats by their first bytes.
[[nodiscard]] bool is_pnm(std::span<const std::byte> file);
[[nodiscard]] bool is_tiff(std::span<const std::byte> file);
[[nodiscard]] bool is_npy(std::span<const std::byte> file);
[[nodiscard]] bool is_exr(std::span<const std::byte> file);

/// Decode one image. corrupt_data for damage, a byte too few or too many included; unsupported for other kinds of
/// pixels and for more than kMaxImageEdge pixels a side.
[[nodiscard]] Result<SampleImage> decode_pnm(std::span<const std::byte> file);
[[nodiscard]] Result<SampleImage> decode_tiff(std::span<const std::byte> file);
[[nodiscard]] Result<SampleImage> decode_npy_image(std::span<const std::byte> file);
/// Decodes depth alone: one channel, which may be of half floats.
[[nodiscard]] Result<SampleImage> decode_exr(std::span<const std::byte> file);

/// Fails unless both edges are within 1 and kMaxImageEdge.
[[nodiscard]] Status check_edges(std::size_t width, std::size_t height);

}  // namespace saccade
