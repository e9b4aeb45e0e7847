// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/internal/image_mapping.hpp"

namespace saccade {

ColorImage seen_from_depth(const ColorImage& color, const Intrinsics& of_color, const DepthImage& depth,
                           const Intrinsics& of_depth, const Pose& T_color_depth) {
  const Distortion lens = of_color.distortion.value_or(Distortion{});
  const bool is_bent = !lens.is_zero();
  const double radius = is_bent ? lens.regular_radius() : 0.0;
  ColorImage seen{depth.width(), depth.height()};
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      const double z = depth(u, v);
      if (!(z > 0.0)) continue;
      const Eigen::Vector3d p_depth{(u - of_depth.cx) / of_depth.fx * z, (v - of_depth.cy) / of_depth.fy * z, z};
      const Eigen::Vector3d p_color = T_color_depth * p_depth;
      if (!(p_color.z() > 0.0)) continue;
      Eigen::Vector2d ray = p_color.head<2>() / p_color.z();
      if (is_bent) {
        if (ray.norm() > radius) continue;
        ray = lens.distort(ray);
      }
      const int at_u = nearest_pixel(of_color.fx * ray.x() + of_color.cx, color.width());
      const int at_v = nearest_pixel(of_color.fy * ray.y() + of_color.cy, color.height());
      if (at_u >= 0 && at_v >= 0) seen(u, v) = color(at_u, at_v);
    }
  }
  return seen;
}

}  // namespace saccade
