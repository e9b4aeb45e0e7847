// SPDX-License-Identifier: Apache-2.0
#pragma once
// SelectionView: the picture in which points are selected; ScreenProjection: where in it a point is.

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "saccade/core/result.hpp"

namespace saccade {

/// A picture of points as OpenGL draws it. Image coordinates (u, v) are pixels from the upper left corner, v down;
/// pixel (i, j) covers [i, i + 1) × [j, j + 1), and its centre is (i + ½, j + ½).
struct SelectionView {
  /// Maps (x, y, z, 1) of a point in metres to clip coordinates, perspective or orthographic. In view is what has
  /// w > 0, −w ≤ x < w, −w < y ≤ w and −w ≤ z ≤ w; x / w = −1 is the left border, y / w = 1 the upper one. What is
  /// farther has the larger w, or with an orthographic view the larger z.
  Eigen::Matrix4d clip_world{Eigen::Matrix4d::Identity()};
  int width{1280};       ///< px, 1 to 8192
  int height{720};       ///< px, 1 to 8192
  int point_size_px{3};  ///< edge of the square as which a point is drawn, 1 to 64

  /// invalid_argument for sizes out of range, and for a matrix that is not finite or no view of space.
  [[nodiscard]] Status validate() const;
};

/// Where a point is seen. Not in view: every member is NaN.
struct ScreenPosition {
  double u_px;
  double v_px;
  float depth_m;  ///< along the viewing direction, from the camera or, in an orthographic view, from anywhere
  [[nodiscard]] bool in_view() const { return !std::isnan(depth_m); }
};

/// The arithmetic of a view.
class ScreenProjection {
 public:
  /// Expects a valid view.
  explicit ScreenProjection(const SelectionView& view);

  /// Points that are not finite are not in view.
  [[nodiscard]] ScreenPosition operator()(const Eigen::Vector3f& p_world) const {
    const double x{p_world.x()}, y{p_world.y()}, z{p_world.z()};
    const auto row = [&](int i) {
      return clip_world_(i, 0) * x + clip_world_(i, 1) * y + (clip_world_(i, 2) * z + clip_world_(i, 3));
    };
    const double clip_z = row(2);
    const double w = row(3);
    const double u_px = (row(0) / w + 1.0) * half_width_;
    const double v_px = (1.0 - row(1) / w) * half_height_;
    const bool in_view = w > 0.0 && clip_z >= -w && clip_z <= w && u_px >= 0.0 && u_px < 2.0 * half_width_ &&
                         v_px >= 0.0 && v_px < 2.0 * half_height_;
    if (!in_view) return {kNone, kNone, static_cast<float>(kNone)};
    return {u_px, v_px, static_cast<float>((perspective_ ? w : clip_z) * m_per_clip_)};
  }
  /// The place that projects to (u_px, v_px) at that depth.
  [[nodiscard]] Eigen::Vector3d place(double u_px, double v_px, double depth_m) const;

 private:
  static constexpr double kNone{std::numeric_limits<double>::quiet_NaN()};

  Eigen::Matrix4d clip_world_;
  Eigen::Matrix3d world_clip_;  ///< from x, y and what depth is taken from
  double half_width_;
  double half_height_;
  bool perspective_;
  double m_per_clip_;  ///< depth per w or, in an orthographic view, per z
};

}  // namespace saccade
