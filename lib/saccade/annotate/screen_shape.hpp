// SPDX-License-Identifier: Apache-2.0
#pragma once
// ScreenShape: what a selection tool draws on a picture; ScreenMask: the pixels in it. Thesis §4.2.2.

#include <Eigen/Core>
#include <cstdint>
#include <variant>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Image coordinates as in SelectionView. May lie outside the picture, up to a million pixels away.
using ScreenPoint = Eigen::Vector2d;

/// Between two opposite corners, whichever: contains what is ≥ the lesser and < the greater coordinates.
struct ScreenRectangle {
  ScreenPoint corner;
  ScreenPoint opposite;
};

/// Closed, by the even-odd rule: a lasso, or the polyline through clicked corners that the thesis' users asked for
/// (§4.2.3). Of its border, the left and upper parts belong to it, as with a rectangle.
struct ScreenPolygon {
  std::vector<ScreenPoint> corners;  ///< 3 to 10,000
};

/// Whatever lies within the radius of an open line, border included: a brush, or a line of some width.
struct ScreenStroke {
  std::vector<ScreenPoint> line;  ///< 1 to 10,000 points
  double radius_px{10.0};         ///< positive, up to 10,000
};

using ScreenShape = std::variant<ScreenRectangle, ScreenPolygon, ScreenStroke>;

/// invalid_argument for coordinates, numbers of points and radii that are not as said above.
[[nodiscard]] Status validate(const ScreenShape& shape);

/// Pixels [left, right) × [top, bottom).
struct PixelWindow {
  int left{0};
  int top{0};
  int right{0};
  int bottom{0};
  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return bottom - top; }
  [[nodiscard]] bool empty() const { return left >= right || top >= bottom; }
  [[nodiscard]] bool contains(int u, int v) const { return u >= left && u < right && v >= top && v < bottom; }
};

/// The pixels of a picture whose centres a shape contains. O(pixels around the shape + rows of its lines).
class ScreenMask {
 public:
  /// Expects a valid shape and a picture of positive size.
  ScreenMask(const ScreenShape& shape, int width, int height);

  /// Pixels outside of it are not in the shape.
  [[nodiscard]] const PixelWindow& window() const { return window_; }
  /// Of any pixel.
  [[nodiscard]] bool contains(int u, int v) const { return window_.contains(u, v) && pixels_[offset(u, v)] != 0; }

 private:
  void draw(const ScreenRectangle& rectangle);
  void draw(const ScreenPolygon& polygon);
  void draw(const ScreenStroke& stroke);
  void draw_segment(const ScreenPoint& a, const ScreenPoint& b, double radius_px);
  [[nodiscard]] std::size_t offset(int u, int v) const {
    return static_cast<std::size_t>(v - window_.top) * static_cast<std::size_t>(window_.width()) +
           static_cast<std::size_t>(u - window_.left);
  }
  void fill(int v, int first, int end);

  PixelWindow window_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace saccade
