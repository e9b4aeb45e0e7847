// SPDX-License-Identifier: Apache-2.0
#pragma once
// SelectionView and ScreenProjection: the image in which points are selected. ScreenShape and ScreenMask: the shape
// that a tool draws on it. select_points, select_around: the points in that shape. Thesis §4.2.2.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Image coordinates as in SelectionView. They may lie up to a million pixels outside the image.
using ScreenPoint = Eigen::Vector2d;

/// Rectangle between two opposite corners: contains coordinates ≥ the lesser and < the greater ones.
struct ScreenRectangle {
  ScreenPoint corner;
  ScreenPoint opposite;
};

/// Closed polygon by the even-odd rule: a lasso, or the polyline through clicked corners that the thesis' users asked
/// for (§4.2.3). Its left and upper borders belong to it, as with a rectangle.
struct ScreenPolygon {
  std::vector<ScreenPoint> corners;  ///< 3 to 10,000
};

/// Everything within the radius of an open line, border included: a brush, or a line of some width.
struct ScreenStroke {
  std::vector<ScreenPoint> line;  ///< 1 to 10,000 points
  double radius_px{10.0};         ///< positive, up to 10,000
};

using ScreenShape = std::variant<ScreenRectangle, ScreenPolygon, ScreenStroke>;

/// Answers invalid_argument for coordinates, numbers of points and radii outside the limits above.
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

/// Pixels of an image whose centres a shape contains. O(pixels around the shape + rows of its lines).
class ScreenMask {
 public:
  /// Draws the mask. Expects a valid shape and an image of positive size.
  ScreenMask(const ScreenShape& shape, int width, int height);

  /// Returns a window that contains all pixels of the shape.
  [[nodiscard]] const PixelWindow& window() const { return window_; }
  /// Tells whether the shape contains a pixel, inside or outside the window.
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

/// Image of points as OpenGL draws it. Image coordinates (u, v) are pixels from the upper left corner, v down; pixel
/// (i, j) covers [i, i + 1) × [j, j + 1), and its centre is (i + ½, j + ½).
struct SelectionView {
  /// Maps (x, y, z, 1) of a point in metres to clip coordinates, perspective or orthographic. A point is in view if w >
  /// 0, −w ≤ x < w, −w < y ≤ w and −w ≤ z ≤ w; x / w = −1 is the left border, y / w = 1 the upper one. Farther points
  /// have a larger w, or with an orthographic view a larger z.
  Eigen::Matrix4d clip_world{Eigen::Matrix4d::Identity()};
  int width{1280};       ///< px, 1 to 8192
  int height{720};       ///< px, 1 to 8192
  int point_size_px{3};  ///< edge of the square as which a point is drawn, 1 to 64
  /// Clip planes (a, b, c, d), up to 16: points with a x + b y + c z + d < 0 for one of them are not in view.
  std::vector<Eigen::Vector4d> planes{};

  /// Answers invalid_argument for sizes out of range, and for a matrix that is not finite or does not map space to a
  /// view.
  [[nodiscard]] Status validate() const;
  /// Tells whether no clip plane takes a point out of the view.
  [[nodiscard]] bool is_inside(const Eigen::Vector3f& p_world) const {
    return std::all_of(planes.begin(), planes.end(), [&](const Eigen::Vector4d& plane) {
      return plane.head<3>().dot(p_world.cast<double>()) + plane.w() >= 0.0;
    });
  }
};

/// Position of a point on the screen; NaN in every member where it is not in view.
struct ScreenPosition {
  double u_px;
  double v_px;
  float depth_m;  ///< along the viewing direction, from the camera; in an orthographic view from an arbitrary origin
  [[nodiscard]] bool in_view() const { return !std::isnan(depth_m); }
};

/// Arithmetic of a view.
class ScreenProjection {
 public:
  /// Expects a valid view.
  explicit ScreenProjection(const SelectionView& view);

  /// Projects a point. Points that are not finite are not in view.
  [[nodiscard]] ScreenPosition operator()(const Eigen::Vector3f& p_world) const {
    const double x{p_world.x()}, y{p_world.y()}, z{p_world.z()};
    const auto row = [&](int i) {
      return clip_world_(i, 0) * x + clip_world_(i, 1) * y + (clip_world_(i, 2) * z + clip_world_(i, 3));
    };
    const double clip_z = row(2);
    const double w = row(3);
    const double u_px = (row(0) / w + 1.0) * half_width_;
    const double v_px = (1.0 - row(1) / w) * half_height_;
    const bool in_view = view_.is_inside(p_world) && w > 0.0 && clip_z >= -w && clip_z <= w && u_px >= 0.0 &&
                         u_px < 2.0 * half_width_ && v_px >= 0.0 && v_px < 2.0 * half_height_;
    if (!in_view) return {kNone, kNone, static_cast<float>(kNone)};
    return {u_px, v_px, static_cast<float>((perspective_ ? w : clip_z) * m_per_clip_)};
  }
  /// Returns the place that projects to (u_px, v_px) at that depth.
  [[nodiscard]] Eigen::Vector3d place(double u_px, double v_px, double depth_m) const;
  /// Returns the width of a pixel at that depth, in metres; the greater of width and height where they differ.
  [[nodiscard]] float pixel_m(float depth_m) const { return pixel_m_ + pixel_per_m_ * depth_m; }

 private:
  static constexpr double kNone{std::numeric_limits<double>::quiet_NaN()};

  SelectionView view_;
  Eigen::Matrix4d clip_world_;
  Eigen::Matrix3d world_clip_;  ///< from x, y and the row of the depth
  double half_width_;
  double half_height_;
  bool perspective_;
  double m_per_clip_;        ///< depth per w or, in an orthographic view, per z
  float pixel_m_{0.0F};      ///< in an orthographic view
  float pixel_per_m_{0.0F};  ///< per depth, in a perspective view
};

/// Depth behind the visible surface within which points are selected. kOnSurface_m: only the surface that is seen (the
/// thesis' Surface rect); kAnyDepth_m: all (its Deep rect). Values between include points slightly below the surface,
/// as its users asked for (§4.2.3).
inline constexpr double kOnSurface_m{0.0};
inline constexpr double kAnyDepth_m{std::numeric_limits<double>::infinity()};

/// Rule that tells which points belong to the surface that is seen.
enum class SurfaceRule {
  seen,       ///< all points of the surface, also those whose neighbours' squares cover their centre
  as_printed  ///< points that are nearest at their own pixel (thesis §4.2.2)
};

/// Thickness of a seen surface, in widths of a pixel at its depth, for a point size. Squares that overlap hide points
/// of their own surface; what is hidden lies behind by about their size, at a pixel's edge by the surface's slope more.
[[nodiscard]] constexpr int seen_thickness_px(int point_size_px) { return point_size_px + 3; }
/// Depth behind what a pixel shows, in widths of a pixel there, beyond which no point belongs to the seen surface.
[[nodiscard]] constexpr int seen_depth_px(int point_size_px) { return 8 * (point_size_px + 1); }

/// Selects the points in view whose pixel is in the shape, and which belong to the surface shown there or lie at most
/// `below_m` behind what this pixel shows (see SplatDepth; depth is compared in single precision). By SurfaceRule::seen
/// a point belongs to the surface if its depth exceeds the greatest one shown within half a square of its pixel by at
/// most seen_thickness_px, and the one shown by its pixel by at most seen_depth_px. Points that are not in view or not
/// finite are neither selected nor hide others.
/// @param positions_m  at most 2³² − 1 points, in the frame that the view maps from.
/// @return indices in ascending order; invalid_argument for a bad view or shape, or below_m that is negative or NaN.
/// O(points + pixels). The thread count never changes the result.
[[nodiscard]] Result<std::vector<std::uint32_t>> select_points(std::span<const Eigen::Vector3f> positions_m,
                                                               const SelectionView& view, const ScreenShape& shape,
                                                               double below_m, const Executor& executor,
                                                               SurfaceRule rule = SurfaceRule::seen);

/// Selects the points in view, hidden or not, at most `radius_m` from the visible surface under a line: a ball moved
/// along it. The surface is sampled where rays through the centres of the pixels within ¾ pixel of the line meet it.
/// @param line  as in a ScreenStroke.
/// @return as select_points; invalid_argument also for a radius that is not finite and positive.
/// O(points + pixels + balls near each point). The thread count never changes the result.
[[nodiscard]] Result<std::vector<std::uint32_t>> select_around(std::span<const Eigen::Vector3f> positions_m,
                                                               const SelectionView& view,
                                                               std::span<const ScreenPoint> line, double radius_m,
                                                               const Executor& executor);

}  // namespace saccade
