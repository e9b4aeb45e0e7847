// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lower bound of the distance between two covered bodies.

#include <vector>

#include "saccade/arm/internal/sphere_tree.hpp"
#include "saccade/core/pose.hpp"

namespace saccade {

/// Box around a body, in the frame of its link.
struct BodyBox {
  Pose T_link_box;
  Eigen::Vector3d half_m;
};

/// Bodies of an arm, link by link.
struct CoveredBodies {
  std::vector<std::vector<SphereTree>> covers;
  std::vector<std::vector<BodyBox>> boxes;  ///< boxes of these bodies
};

/// Body placed in the world.
struct PlacedBody {
  const SphereTree& cover;
  const BodyBox& box;
  const Pose& T_world_link;
};

/// Returns a lower bound of the distance between two bodies. Balls are refined until it exceeds `enough_m` or they are
/// of the finest level. At or below 0 the bodies touch.
[[nodiscard]] double separation_m(const PlacedBody& a, const PlacedBody& b, double enough_m);

}  // namespace saccade
