// SPDX-License-Identifier: Apache-2.0
#pragma once
// Image<T>: a row-major H×W array; DepthImage, ColorImage, MaskImage.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Row-major image that owns its pixels. (u, v) = (column, row).
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T fill = T{})
      : width_{width}, height_{height}, pixels_(checked_size(width, height), fill) {}
  Image(int width, int height, std::vector<T> pixels) : width_{width}, height_{height}, pixels_{std::move(pixels)} {
    SACCADE_EXPECTS(pixels_.size() == checked_size(width, height));
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }

  [[nodiscard]] T& operator()(int u, int v) { return pixels_[index(u, v)]; }
  [[nodiscard]] const T& operator()(int u, int v) const { return pixels_[index(u, v)]; }
  [[nodiscard]] T* row(int v) { return pixels_.data() + index(0, v); }
  [[nodiscard]] const T* row(int v) const { return pixels_.data() + index(0, v); }
  [[nodiscard]] T* data() { return pixels_.data(); }
  [[nodiscard]] const T* data() const { return pixels_.data(); }
  [[nodiscard]] const std::vector<T>& pixels() const { return pixels_; }

  [[nodiscard]] bool operator==(const Image&) const = default;

 private:
  static std::size_t checked_size(int width, int height) {
    SACCADE_EXPECTS(width >= 0 && height >= 0);
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  }

  int width_{0};
  int height_{0};
  std::vector<T> pixels_;
};

/// Metres along camera +z, float32. 0 or NaN: no return. d < 0: seen free up to |d|, nothing hit.
using DepthImage = Image<float>;
/// 8-bit sRGB.
using Rgb8 = std::array<std::uint8_t, 3>;
using ColorImage = Image<Rgb8>;
/// 0: ignore this pixel (for example the camera's own robot); anything else: use it.
using MaskImage = Image<std::uint8_t>;

}  // namespace saccade
