// SPDX-License-Identifier: Apache-2.0
#pragma once
// Light, lamp_of and shaded: how surfaces are lit in pictures.

#include <Eigen/Core>
#include <algorithm>

#include "saccade/report/internal/blend.hpp"
#include "saccade/report/viewpoint.hpp"

namespace saccade {

/// Colour of surfaces that have none of their own.
constexpr Rgb8 kClay{198, 196, 190};

/// Shares of the light that comes from everywhere, from the eye, and from the lamp.
struct Light {
  double ambient;
  double eye;
  double lamp;
};
constexpr Light kClayLight{0.40, 0.30, 0.42};
/// Fused colours carry their own light: shade them less.
constexpr Light kColorLight{0.66, 0.16, 0.24};

/// Direction, in the world, towards a lamp above the left shoulder of who looks.
[[nodiscard]] inline Eigen::Vector3d lamp_of(const Viewpoint& view) {
  return view.T_world_camera.linear() * Eigen::Vector3d{-0.45, -0.70, -0.55}.normalized();
}

/// A surface's colour; normal points outwards (a unit vector or zero), direction from the eye to the surface.
[[nodiscard]] inline Rgb8 shaded(const Rgb8& color, const Eigen::Vector3d& normal, const Eigen::Vector3d& direction,
                                 const Eigen::Vector3d& lamp, const Light& light) {
  const double towards_eye = -normal.dot(direction.normalized());
  const Eigen::Vector3d seen = towards_eye < 0.0 ? Eigen::Vector3d{-normal} : normal;  // from behind, as from the front
  return scaled(color, light.ambient + light.eye * std::abs(towards_eye) + light.lamp * std::max(0.0, seen.dot(lamp)));
}

}  // namespace saccade
