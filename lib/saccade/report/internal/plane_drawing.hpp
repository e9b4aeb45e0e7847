// SPDX-License-Identifier: Apache-2.0
#pragma once
// Smooth lines and convex polygons in the plane of an image.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "saccade/sensor/image.hpp"

namespace saccade {

struct StrokeStyle {
  Rgb8 color{40, 44, 52};
  double width_px{1.5};
  double dash_px{0.0};  ///< length of dashes and of the gaps between them; 0: unbroken
};

// Pixels; the middle of pixel (u, v) lies at (u, v). What falls outside the image is cut.

/// A line between two points with round ends.
void draw_stroke(ColorImage& image, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const StrokeStyle& style);
/// The lines between the points, one after the other, and from the last to the first.
void draw_outline(ColorImage& image, std::span<const Eigen::Vector2d> corners, const StrokeStyle& style);
/// A convex polygon, whichever way around.
void fill_convex(ColorImage& image, std::span<const Eigen::Vector2d> corners, const Rgb8& color, double opacity = 1.0);

}  // namespace saccade
