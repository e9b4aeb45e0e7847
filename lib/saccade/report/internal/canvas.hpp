// SPDX-License-Identifier: Apache-2.0
#pragma once
// Canvas: a colour and depth buffer seen from a viewpoint; lines, points, frusta, axes and regions are drawn into it.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "saccade/report/viewpoint.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

struct LineStyle {
  Rgb8 color{40, 44, 52};
  double width_px{1.5};
  double hidden_opacity{0.0};  ///< opacity of the parts behind what is already drawn
};

/// Drawn at `samples`² points per pixel and averaged by finish(), so edges are smooth. Depth is along the camera's z.
/// Drawing order matters only between things at the same depth. One thread.
class Canvas {
 public:
  static constexpr float kFar{1e9F};
  Canvas(const Viewpoint& view, const Rgb8& background, int samples = 2);

  [[nodiscard]] const Viewpoint& view() const { return view_; }
  /// The camera of the sample lattice: `samples` times the picture's size.
  [[nodiscard]] const PinholeCamera& sample_camera() const { return sample_camera_; }
  [[nodiscard]] ColorImage& samples() { return color_; }
  [[nodiscard]] Image<float>& sample_depth() { return depth_; }
  [[nodiscard]] const Image<float>& sample_depth() const { return depth_; }

  /// Sets a sample if it is nearer than what is there; outside the picture nothing happens.
  void plot(int u, int v, float depth, const Rgb8& color);

  void line(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world, const LineStyle& style);
  /// Disc that faces the camera.
  void point(const Eigen::Vector3d& p_world, double diameter_px, const Rgb8& color, double hidden_opacity = 0.0);
  /// The pyramid of a camera's view up to depth_m, with a mark at the image's upper edge.
  void frustum(const PinholeCamera& camera, const Pose& T_world_camera, double depth_m, const LineStyle& style);
  /// x red, y green, z blue.
  void axes(const Pose& T_world_frame, double length_m, double width_px = 2.0);
  /// Outline: three great circles of a sphere, edges of a box, rims of a cylinder.
  void outline(const Region& region, const LineStyle& style);
  /// Text beside a point in space; drawn over everything when the canvas is finished.
  void label(const Eigen::Vector3d& p_world, std::string text, const Rgb8& color, double size_px = 11.0);

  /// Where a point falls in the finished picture; nullopt behind the camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_world) const;

  /// The picture.
  [[nodiscard]] ColorImage finish() const;

 private:
  struct Label {
    Eigen::Vector2d at;
    std::string text;
    Rgb8 color;
    double size_px;
  };
  /// A line in samples: from a to b, of which the part from s = first to last can be seen.
  struct ScreenLine {
    Eigen::Vector2d a, b;
    double inv_z_a, inv_z_b;
    double first, last;
  };
  [[nodiscard]] std::optional<ScreenLine> on_screen(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world,
                                                    double margin) const;
  /// A disc; samples of it that lie behind something go to `hidden`.
  void blot(const Eigen::Vector2d& at, double inv_z, double radius, const Rgb8& color,
            std::vector<std::size_t>& hidden);
  void circle(const Eigen::Vector3d& center, const Eigen::Vector3d& x, const Eigen::Vector3d& y,
              const LineStyle& style);

  Viewpoint view_;
  Pose T_camera_world_;
  int samples_;
  PinholeCamera sample_camera_;
  ColorImage color_;
  Image<float> depth_;
  std::vector<Label> labels_;
};

}  // namespace saccade
