// SPDX-License-Identifier: Apache-2.0
#pragma once
// SensorRays: the rays of a virtual sensor at a pose, in one canonical basis per camera centre and roll; PixelAxes.

#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/map/ray_math.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Camera's centre and axes as every implementation of view evaluation uses them, so that all trace equal rays to the
/// bit. The centre is snapped to 2⁻¹⁶ voxel, each component of the axes to 2⁻²⁴. Of the four quarter turns of (x, y)
/// about the optical axis, the canonical one has the lexicographically largest x axis in the world. Poses that differ
/// by quarter turns of roll therefore share their axes.
struct SensorRays {
  LatticePoint origin;
  float x[3];  ///< canonical axes in the world, voxels per metre
  float y[3];
  float z[3];
  int quarter_turns{0};  ///< canonical = camera turned this many times by 90° from x towards y

  /// Tells whether centre and canonical axes are equal.
  [[nodiscard]] bool same_lattice(const SensorRays& other) const;
  /// Returns the ray through canonical image coordinates (a, b) at depth 1: d = x·a + (y·b + z), in float32, in this
  /// order.
  [[nodiscard]] LatticeRay ray(float a, float b) const {
    return make_lattice_ray(origin, x[0] * a + (y[0] * b + z[0]), x[1] * a + (y[1] * b + z[1]),
                            x[2] * a + (y[2] * b + z[2]));
  }
};
[[nodiscard]] SensorRays sensor_rays(const Pose& T_world_camera, double voxel_size_m);

/// Canonical image coordinates of the pixels, ascending: column i of the canonical image lies at a[i], row j at b[j].
/// The values are float((u − cx) / fx) and float((v − cy) / fy), swapped and negated according to the quarter turns.
struct PixelAxes {
  std::vector<float> a;
  std::vector<float> b;
  double pixels_per_a{0.0};  ///< focal length along a
  double pixels_per_b{0.0};
};
[[nodiscard]] PixelAxes pixel_axes(const PinholeCamera& camera, int quarter_turns);

/// Returns the ray that evaluate_views traces for pixel (u, v).
[[nodiscard]] LatticeRay pixel_ray(const SensorRays& rays, const PinholeCamera& camera, int u, int v);

}  // namespace saccade
