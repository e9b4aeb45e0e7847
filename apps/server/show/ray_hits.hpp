// SPDX-License-Identifier: Apache-2.0
#pragma once
// ray_hits: where the rays of a view end, which is what its gain counts.

#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::server {

enum class RayEnd : std::uint8_t {
  gained,   ///< an unknown voxel of the region: counts
  unknown,  ///< an unknown voxel elsewhere
  surface,  ///< an occupied one
};

struct RayHit {
  Eigen::Vector3f center_m;  ///< of the voxel
  RayEnd end{RayEnd::surface};
};

/// The first voxel that is not empty of every ray that meets one within the sensor's range, ray by ray, row by row.
/// Those that gained are as many as evaluate_views counts rays (eq. 2.10, unknown outside blocks). Voxels outside the
/// workspace are transparent; what is met before the minimum range, or holds the camera, ends a ray without a hit.
/// O(voxels along the rays).
[[nodiscard]] std::vector<RayHit> ray_hits(const TsdfSnapshot& map, const Region& region, const PinholeCamera& sensor,
                                           const Pose& T_world_camera, const Executor& executor);

}  // namespace saccade::server
