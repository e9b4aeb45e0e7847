// SPDX-License-Identifier: Apache-2.0
#pragma once
// DepthRaster: depth buffer of triangles in a camera's image, optionally enlarged by a margin.

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Enlargement of a triangle's image: margin_m in space, plus border_px in the image; together at most most_px.
struct RasterGrowth {
  double margin_m{0.0};
  double border_px{0.0};
  double most_px{0.0};
};

/// Raster that collects triangles in the camera's frame, then draws them. Anything nearer than kNearest_m along z is
/// clipped.
class DepthRaster {
 public:
  static constexpr double kNearest_m{0.001};

  DepthRaster(const PinholeCamera& camera, const RasterGrowth& growth) : camera_{camera}, growth_{growth} {}

  using Triangle = std::array<Eigen::Vector3d, 3>;
  /// @param at_rim  the triangle has an edge without a neighbour, so its image grows sideways too; others only come
  /// nearer, by the margin along their normal.
  void add(const Triangle& p_camera, bool at_rim);
  [[nodiscard]] bool empty() const { return triangles_.empty(); }

  /// Draws rows [begin, end) of an image: raises inverse_depth (1/m, 0: nothing), which starts with row `begin`, to
  /// that of the nearest triangle that covers the pixel's centre. The order of triangles does not matter. O(triangles +
  /// covered pixels).
  void draw_rows(int begin, int end, float* inverse_depth) const;

 private:
  /// Linear function a·u + b·v + c.
  struct Linear {
    double a{0.0}, b{0.0}, c{0.0};
    [[nodiscard]] double at(int u, int v) const { return a * u + b * v + c; }
  };
  struct Projected {
    std::array<Linear, 3> edges;  ///< distance in pixels, positive inside
    Linear inverse_depth;
    double farthest, nearest;  ///< bounds of the inverse depth
    double grown_px;           ///< upper limit
    double left, right, top, bottom;
  };
  /// Pixels of a row, both ends included; none by default.
  struct Span {
    int first{0};
    int last{-1};
  };
  struct Plane {
    Linear inverse_depth;
    double offset_m;  ///< by which the margin brings it nearer
  };

  void add_clipped(const Triangle& p_camera, const Plane& plane, bool at_rim);
  void draw_row(const Projected& t, int v, float* row) const;
  [[nodiscard]] static Span span(const Projected& t, int v, double beside_px);
  static void draw_inside(const Projected& t, int v, const Span& span, float* row);
  void draw_grown(const Projected& t, int v, const Span& span, float* row) const;

  PinholeCamera camera_;
  RasterGrowth growth_;
  std::vector<Projected> triangles_;
};

}  // namespace saccade
