// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/drawn_surfels.hpp"

#include <cmath>

namespace saccade {
namespace {

constexpr float kShadow{0.5F};  // brightness of a disc that faces away from the light

Rgb8 shaded(const Eigen::Vector3f& color, const Eigen::Vector3f& normal) {
  static const Eigen::Vector3f towards_light = Eigen::Vector3f{-0.35F, -0.5F, 0.8F}.normalized();
  return byte_color(color * (kShadow + 0.5F * (1.0F - kShadow) * (1.0F + normal.dot(towards_light))));
}

}  // namespace

DrawnSurfels drawn_surfels(const SurfelMap& seen, double min_weight, std::span<const SurfelDisc> unknown,
                           const Box& box) {
  constexpr float kGrey{0.72F};
  DrawnSurfels drawn;
  const auto add = [&](const SurfelDisc& disc, const Eigen::Vector3f& color) {
    if (!contains(box, disc.position_m.cast<double>())) return;
    drawn.positions_m.push_back(disc.position_m);
    drawn.normals.push_back(disc.normal);
    drawn.radii_m.push_back(disc.radius_m);
    drawn.colors.push_back(shaded(color, disc.normal));
  };
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!(static_cast<double>(seen.discs[i].weight) >= min_weight)) continue;
    add(seen.discs[i], seen.colors[i].weight > 0.0F ? seen.colors[i].color : Eigen::Vector3f::Constant(kGrey));
  }
  for (const SurfelDisc& disc : unknown) {
    add(disc, Eigen::Vector3f{kUnknownColor[0], kUnknownColor[1], kUnknownColor[2]} / 255.0F);
  }
  return drawn;
}

}  // namespace saccade
