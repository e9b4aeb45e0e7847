// SPDX-License-Identifier: Apache-2.0
#pragma once
// ray_hits: the ends of a view's rays, which its gain counts.

#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::server {

enum class RayEnd : std::uint8_t {
  gained,   ///< an unknown voxel of the region: counts
  unknown,  ///< an unknown voxel elsewhere
  surface,  ///< an occupied voxel
};

struct RayHit {
  Eigen::Vector3f center_m;  ///< centre of the voxel
  RayEnd end{RayEnd::surface};
};

/// Returns the first voxel that is not empty for every ray that meets one within the sensor's range, ray by ray, row by
/// row. The number of gained hits equals the count of evaluate_views (eq. 2.10, unknown outside blocks). Voxels outside
/// the workspace are transparent. A voxel before the minimum range, or one that holds the camera, ends a ray without a
/// hit. O(voxels along the rays).
[[nodiscard]] std::vector<RayHit> ray_hits(const TsdfSnapshot& map, const Region& region, const PinholeCamera& sensor,
                                           const Pose& T_world_camera, const Executor& executor);

}  // namespace saccade::server
