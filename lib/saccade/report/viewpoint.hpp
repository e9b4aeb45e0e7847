// SPDX-License-Identifier: Apache-2.0
#pragma once
// Viewpoint: the camera a picture is drawn from; overview_of chooses one that shows all of a scene.

#include <span>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Range limits of the camera play no part in pictures.
struct Viewpoint {
  PinholeCamera camera;
  Pose T_world_camera{Pose::Identity()};
};

/// Where an overview is taken from.
struct OverviewConfig {
  int width{960};
  int height{720};
  double azimuth_rad{-2.2};       ///< direction of the camera from the scene, from world +x towards +y
  double elevation_rad{0.55};     ///< above the horizontal plane
  double field_of_view_rad{0.7};  ///< across the smaller side of the picture
  Eigen::Vector3d up{Eigen::Vector3d::UnitZ()};
};

/// The azimuth of an overview whose camera stands on the side of this direction.
[[nodiscard]] double azimuth_towards(const Eigen::Vector3d& towards_viewer, const Eigen::Vector3d& up);

/// The nearest viewpoint in the given direction from which all points (at least one) are in the picture.
[[nodiscard]] Viewpoint overview_of(std::span<const Eigen::Vector3d> points_world, const OverviewConfig& config = {});
[[nodiscard]] std::vector<Eigen::Vector3d> corners_of(const Box& box);
/// As overview_of above, for a whole box.
[[nodiscard]] Viewpoint overview_of(const Box& box, const OverviewConfig& config = {});

}  // namespace saccade
