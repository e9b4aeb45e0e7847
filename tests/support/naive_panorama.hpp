// SPDX-License-Identifier: Apache-2.0
#pragma once
// naive_depth_m: the depth of one pixel of a DepthPanorama, disc by disc.

#include <algorithm>
#include <span>

#include "saccade/views/internal/depth_panorama.hpp"

namespace saccade::test {

/// Tests the pixel against each disc as DepthPanorama defines it.
inline float naive_depth_m(std::span<const SurfelDisc> discs, const Eigen::Vector3f& place_m,
                           const DepthPanorama& pixels, int face, int x, int y) {
  float nearest_m{DepthPanorama::kNothing};
  const float a = pixels.middle(x);
  const float b = pixels.middle(y);
  for (const SurfelDisc& disc : discs) {
    const Eigen::Vector3f p = disc.position_m - place_m;
    const DepthPanorama::OnFace own = DepthPanorama::on_face(p, DepthPanorama::face_of(p));
    if (!(own.z > DepthPanorama::kNear_m)) continue;
    if (DepthPanorama::face_of(p) == face && pixels.pixel(own.x / own.z) == x && pixels.pixel(own.y / own.z) == y)
      nearest_m = std::min(nearest_m, own.z);
    const DepthPanorama::OnFace at = DepthPanorama::on_face(p, face);
    if (!(at.z > 2.0F * disc.radius_m)) continue;
    const DepthPanorama::OnFace n = DepthPanorama::on_face(disc.normal, face);
    const float z = (n.x * at.x + n.y * at.y + n.z * at.z) / (n.x * a + n.y * b + n.z);
    const Eigen::Vector3f miss{z * a - at.x, z * b - at.y, z - at.z};
    if (z > DepthPanorama::kNear_m &&
        miss.x() * miss.x() + miss.y() * miss.y() + miss.z() * miss.z() <= disc.radius_m * disc.radius_m)
      nearest_m = std::min(nearest_m, z);
  }
  return nearest_m;
}

}  // namespace saccade::test
