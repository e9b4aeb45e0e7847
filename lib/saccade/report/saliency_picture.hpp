// SPDX-License-Identifier: Apache-2.0
#pragma once
// saliency_picture: what drew the attention of an exploration, and the contours that it looked at. Thesis Figs. 3.6,
// 3.16 and 3.18.

#include <span>

#include "saccade/map/mesh.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/viewpoint.hpp"

namespace saccade {

/// A point at the border of what is known, and the direction to look at it from.
struct DrawnContour {
  Eigen::Vector3d p_world{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal_world{Eigen::Vector3d::UnitZ()};
  bool chosen{false};  ///< of the segment that the view is of
};

struct SaliencyScene {
  const TriangleMesh& mesh;               ///< the map's, before the move
  std::span<const std::uint32_t> labels;  ///< segment of each vertex; others than those with a saliency: grey
  std::span<const double> saliency;       ///< of each segment
  std::span<const DrawnContour> contours;
  const Box& workspace;  ///< all of the surface in it is in the picture
  Pose T_world_chosen{Pose::Identity()};
  PinholeCamera sensor;  ///< shape of the frustum
};

/// The surface from outside, the more salient the brighter; contour points, those of the chosen segment with their
/// normals; the chosen view as a frustum. The same picture for every thread count.
[[nodiscard]] ColorImage saliency_picture(const SaliencyScene& scene, const Executor& executor,
                                          const OverviewConfig& config = {.width = 720, .height = 540});

}  // namespace saccade
