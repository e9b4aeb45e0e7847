// SPDX-License-Identifier: Apache-2.0
#pragma once
// shown_surfels, SurfelPoints, surfel_points: surfels of a map that were seen often enough, as averages or as winning
// modes. view_surfels: the surfels that each pixel of a camera sees.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/surfel/mode_store.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Returns the ids of the surfels with w_s ≥ min_weight, in order. Surfels that were seen only a few times are often
/// not on a surface: they are veil between near and far, or belong to a wrong pose. Where any of them has a colour,
/// those without are omitted: no frame with colour saw them, and black is a valid colour.
[[nodiscard]] std::vector<SurfelId> shown_surfels(const SurfelMap& map, double min_weight = 0.0);

/// Points of surfels, in the order of their ids.
struct SurfelPoints {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> colors;  ///< in [0, 1]; black where there are no colours
  std::vector<float> radii_m;
  std::vector<float> weights;  ///< w_s
  bool has_color{false};       ///< either all have a colour or none

  [[nodiscard]] std::size_t size() const { return positions_m.size(); }
};

/// Returns the points of shown_surfels.
/// @param modes  eq. 4.11 per surfel: positions and colours that replace the surfels' own where the weight is not 0.
/// Empty: the averages of eq. 4.12. Expects none, or one per surfel.
[[nodiscard]] SurfelPoints surfel_points(const SurfelMap& map, std::span<const SurfelMode> modes = {},
                                         double min_weight = 0.0);

/// Moves modes to their surfels' positions, the mean over all observations as measured (decision 20). Expects one per
/// surfel.
void put_at_averages(std::span<SurfelMode> modes, const SurfelMap& map);

/// Returns the 8-bit colour nearest to a colour in [0, 1].
[[nodiscard]] Rgb8 byte_color(const Eigen::Vector3f& color);

/// Discs in the world frame; the spans are equally long.
struct SurfelDiscs {
  std::span<const Eigen::Vector3f> positions_m;
  std::span<const Eigen::Vector3f> normals;  ///< unit length
  std::span<const float> radii_m;
};

struct SurfelView {
  Image<SurfelId> seen;  ///< index of the disc, or kNoSurfel
  Image<float> depth;    ///< depth of the intersection with the pixel's ray along z in metres; 0 where no disc is hit
};

/// Finds the disc that each pixel sees. Discs overlap, and noise puts one slightly in front of the other. Candidates
/// are the discs that the ray meets no farther behind the nearest than their own radius. Of these the pixel sees the
/// one whose centre is nearest to the intersection, the first at a tie. Discs are visible from the front only; the
/// camera's range plays no part.
/// The thread count never changes a bit of the result. O(discs + covered pixels).
[[nodiscard]] SurfelView view_surfels(const SurfelDiscs& discs, const PinholeCamera& camera, const Pose& T_world_camera,
                                      const Executor& executor);

}  // namespace saccade
