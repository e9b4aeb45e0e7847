// SPDX-License-Identifier: Apache-2.0
#pragma once
// Moves images from one pinhole camera to another. Used by rgbd_folder.cpp.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// Returns the nearest pixel of n, or −1 outside of the image.
[[nodiscard]] inline int nearest_pixel(double position, int n) {
  return position >= -0.5 && position < n - 0.5 ? static_cast<int>(std::floor(position + 0.5)) : -1;
}

/// Returns an image as a camera in the same place with other intrinsics sees it: the nearest pixel of the same ray, or
/// T{} where there is none. Depth along z keeps its value. Focal lengths may be negative.
template <class T>
[[nodiscard]] Image<T> seen_with(const Image<T>& image, const Intrinsics& from, const Intrinsics& to, int width,
                                 int height) {
  std::vector<int> column(static_cast<std::size_t>(width));
  for (int u = 0; u < width; ++u) {
    column[static_cast<std::size_t>(u)] = nearest_pixel(from.fx * ((u - to.cx) / to.fx) + from.cx, image.width());
  }
  Image<T> seen{width, height};
  for (int v = 0; v < height; ++v) {
    const int source_v = nearest_pixel(from.fy * ((v - to.cy) / to.fy) + from.cy, image.height());
    if (source_v < 0) continue;
    for (int u = 0; u < width; ++u) {
      const int source_u = column[static_cast<std::size_t>(u)];
      if (source_u >= 0) seen(u, v) = image(source_u, source_v);
    }
  }
  return seen;
}

/// Returns the colour of each depth pixel, from a colour camera in another place whose lens may bend rays; black
/// without depth or outside of the colour image. Depths are those of an ideal lens. What hides a point from the colour
/// camera is not looked for.
[[nodiscard]] ColorImage seen_from_depth(const ColorImage& color, const Intrinsics& of_color, const DepthImage& depth,
                                         const Intrinsics& of_depth, const Pose& T_color_depth);

/// Returns an image with its columns, its rows or both in reverse order.
template <class T>
[[nodiscard]] Image<T> mirrored(Image<T> image, bool along_u, bool along_v) {
  for (int v = 0; along_u && v < image.height(); ++v) std::reverse(image.row(v), image.row(v) + image.width());
  for (int v = 0; along_v && v < image.height() / 2; ++v) {
    std::swap_ranges(image.row(v), image.row(v) + image.width(), image.row(image.height() - 1 - v));
  }
  return image;
}

/// Tells whether two cameras have the same rays within a hundredth of a pixel.
[[nodiscard]] inline bool has_same_rays(const Intrinsics& a, const Intrinsics& b) {
  constexpr double kTolerance_px{0.01};
  return std::abs(a.fx - b.fx) < kTolerance_px && std::abs(a.fy - b.fy) < kTolerance_px &&
         std::abs(a.cx - b.cx) < kTolerance_px && std::abs(a.cy - b.cy) < kTolerance_px;
}

/// Returns intrinsics of the same view at another size in pixels; distortion and scale stay.
[[nodiscard]] inline Intrinsics scaled(Intrinsics intrinsics, double across, double down) {
  intrinsics.fx *= across;
  intrinsics.fy *= down;
  intrinsics.cx = (intrinsics.cx + 0.5) * across - 0.5;
  intrinsics.cy = (intrinsics.cy + 0.5) * down - 0.5;
  return intrinsics;
}

[[nodiscard]] inline std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// Rays of the images of a folder before their correction.
struct ImageRays {
  int width{0};
  int height{0};
  Intrinsics depth;
  int color_width{0};
  int color_height{0};
  std::optional<Intrinsics> color{};  ///< where colours have other rays than depths
  std::optional<Pose> T_color_depth{};
  bool are_color{false};  ///< intrinsics of single images are those of their colours
  bool is_bent{false};    ///< colours have other rays than depths, and one of the two has a lens to undo

  /// Returns the intrinsics of one depth image by those in its own file. Answers size_mismatch where they are for
  /// another size.
  [[nodiscard]] Result<Intrinsics> of_depth(Intrinsics own) const {
    const bool is_other_size = own.width.value_or(width) != width || own.height.value_or(height) != height;
    if (!is_other_size) return own;
    if (!are_color || !own.width || !own.height || !is_same_shape(*own.width, *own.height, width, height)) {
      return Error{Errc::size_mismatch,
                   "they are for images of " + size_text(own.width.value_or(width), own.height.value_or(height)) +
                       ", the depth images are " + size_text(width, height),
                   "camera intrinsics"};
    }
    own = scaled(own, static_cast<double>(width) / *own.width, static_cast<double>(height) / *own.height);
    own.width = width;
    own.height = height;
    return own;
  }

  /// Returns the intrinsics of colours that show what depth images with `own` do.
  [[nodiscard]] Intrinsics at_color_size(const Intrinsics& own) const {
    return scaled(own, static_cast<double>(color_width) / width, static_cast<double>(color_height) / height);
  }

  /// Tells whether two sizes are of one shape, to a hundredth.
  [[nodiscard]] static bool is_same_shape(int width_a, int height_a, int width_b, int height_b) {
    constexpr double kTolerance{0.01};
    const double a = static_cast<double>(width_a) / height_a;
    const double b = static_cast<double>(width_b) / height_b;
    return std::abs(a - b) <= kTolerance * b;
  }
};

}  // namespace saccade
