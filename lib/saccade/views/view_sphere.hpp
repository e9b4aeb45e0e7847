// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewSphereConfig, ViewCandidate and view_sphere: candidate view poses on a sphere around a point of interest.

#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/pose.hpp"

namespace saccade {

/// Sampling of the view sphere. Thesis §2.2.3, Fig. 2.5: longitude φ and roll ψ go around once, half-open; latitude θ
/// includes both ends. The defaults give 12 · 10 · 8 = 960 poses.
struct ViewSphereConfig {
  std::vector<double> radii_m{0.8};
  double longitude_step_rad{30_deg};
  double latitude_step_rad{10_deg};
  double roll_step_rad{45_deg};
  double latitude_min_rad{0.0};
  double latitude_max_rad{90_deg};  ///< straight above; keeps all its longitudes

  /// Answers invalid_argument for radii or steps that are not positive, latitudes outside ±90° or more than 10⁷ poses.
  [[nodiscard]] Status validate() const;
};

/// Candidate view pose and its coordinates on the sphere.
struct ViewCandidate {
  Pose T_world_camera{Pose::Identity()};
  double radius_m{0.0};
  double longitude_rad{0.0};
  double latitude_rad{0.0};
  double roll_rad{0.0};
};

/// Returns poses around `center` that look at it, world z up. At roll 0 the camera's x axis is horizontal and points
/// towards growing longitude, so that the image's up is the world's, also in the limit at latitude 90°. Roll turns the
/// camera about its optical axis. Thesis §2.2.3, GenerateViewpointsAround of Algorithm 2.
/// Index order: ((radius · latitudes + latitude) · longitudes + longitude) · rolls + roll.
/// @return invalid_argument for a bad configuration or a centre that is not finite.
[[nodiscard]] Result<std::vector<ViewCandidate>> view_sphere(const Eigen::Vector3d& center,
                                                             const ViewSphereConfig& config = {});

/// Returns only the poses, in their order.
[[nodiscard]] std::vector<Pose> poses_of(const std::vector<ViewCandidate>& candidates);

}  // namespace saccade
