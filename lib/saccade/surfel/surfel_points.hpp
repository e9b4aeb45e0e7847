// SPDX-License-Identifier: Apache-2.0
#pragma once
// shown_surfels, SurfelPoints, surfel_points: the surfels of a map that were seen often enough, as averages or as
// winning modes; view_surfels: which of them each pixel of a camera sees.

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

/// Ids of the surfels of w_s ≥ min_weight, in order. What was seen a few times only is often no surface: veil between
/// near and far, or a surface at a place where a pose was wrong. Where any of them has a colour, those without are left
/// out: no frame with colour saw them, and black is a colour like others.
[[nodiscard]] std::vector<SurfelId> shown_surfels(const SurfelMap& map, double min_weight = 0.0);

/// A row per surfel, in the order of their ids.
struct SurfelPoints {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> colors;  ///< in [0, 1]; black where none has a colour
  std::vector<float> radii_m;
  std::vector<float> weights;  ///< w_s
  bool has_color{false};       ///< of all, or of none

  [[nodiscard]] std::size_t size() const { return positions_m.size(); }
};

/// Of shown_surfels.
/// @param modes  eq. 4.11 per surfel, whose positions and colours stand for the surfels' own where their weight is not
///               0; or none: the averages of eq. 4.12. Expects none, or one per surfel.
[[nodiscard]] SurfelPoints surfel_points(const SurfelMap& map, std::span<const SurfelMode> modes = {},
                                         double min_weight = 0.0);

/// Puts modes where their surfels are, at the mean over all observations as they were measured (decision 20). Expects
/// one per surfel.
void put_at_averages(std::span<SurfelMode> modes, const SurfelMap& map);

/// The nearest 8-bit colour of one in [0, 1].
[[nodiscard]] Rgb8 byte_color(const Eigen::Vector3f& color);

/// Discs in the world frame; as many of each.
struct SurfelDiscs {
  std::span<const Eigen::Vector3f> positions_m;
  std::span<const Eigen::Vector3f> normals;  ///< unit length
  std::span<const float> radii_m;
};

struct SurfelView {
  Image<SurfelId> seen;  ///< index of the disc, or kNoSurfel
  Image<float> depth;    ///< where the pixel's ray meets it, metres along z; 0: nowhere
};

/// Discs overlap, and noise puts one a little before the other. So of those that a pixel's ray meets no farther behind
/// the nearest than their own radius, it sees the one whose centre is nearest to where the ray meets it, of equal ones
/// the first. Discs are seen from the front alone; the camera's range plays no part.
/// The thread count never changes a bit of the result. O(discs + covered pixels).
[[nodiscard]] SurfelView view_surfels(const SurfelDiscs& discs, const PinholeCamera& camera, const Pose& T_world_camera,
                                      const Executor& executor);

}  // namespace saccade
