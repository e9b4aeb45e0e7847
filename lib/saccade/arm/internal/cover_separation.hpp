// SPDX-License-Identifier: Apache-2.0
#pragma once
// How far two covered bodies are apart at least.

#include <vector>

#include "saccade/arm/internal/sphere_tree.hpp"
#include "saccade/core/pose.hpp"

namespace saccade {

/// A box around a body, in the frame of its link.
struct BodyBox {
  Pose T_link_box;
  Eigen::Vector3d half_m;
};

/// The bodies of an arm, link by link.
struct CoveredBodies {
  std::vector<std::vector<SphereTree>> covers;
  std::vector<std::vector<BodyBox>> boxes;  ///< the same bodies
};

/// A body in the world.
struct PlacedBody {
  const SphereTree& cover;
  const BodyBox& box;
  const Pose& T_world_link;
};

/// Lower bound of the distance between two bodies. Balls are looked into until it is more than `enough_m`, or they are
/// of the finest level; at or below 0 they touch.
[[nodiscard]] double separation_m(const PlacedBody& a, const PlacedBody& b, double enough_m);

}  // namespace saccade
