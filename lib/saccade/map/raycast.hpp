// SPDX-License-Identifier: Apache-2.0
#pragma once
// Surface ray cast: the camera's view of the map (depth, normals, colours); to_points: this view as a PointImage.

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/sensor/point_image.hpp"

namespace saccade {

/// Depth and normals of the mapped surface.
struct SurfaceView {
  DepthImage depth;                ///< metres along camera +z; 0 where no surface is met within the camera's range
  Image<Eigen::Vector3f> normals;  ///< camera frame, unit length, towards free space; zero where depth is 0
  ColorImage colors;               ///< black where unknown; empty unless asked for
};

struct RaycastConfig {
  bool colors{false};
};

/// Casts one ray per pixel to the first zero crossing from outside to inside of the trilinear interpolation of v
/// (thesis §2.2.1). Walks the cells between voxel centres exactly, so that thin structures are never missed. Cells with
/// an unknown corner hold no surface; rays pass through unknown space. Surfaces seen from behind are not reported.
/// Of a paged map, it reads what it needs from the store where that is away; errors: those of the store.
/// O(pixels · bricks along the ray). Threads never change a bit of the result.
[[nodiscard]] Result<SurfaceView> raycast(const TsdfSnapshot& map, const PinholeCamera& camera,
                                          const Pose& T_world_camera, const Executor& executor,
                                          const RaycastConfig& config = {});

/// Converts a view of the mapped surface to a PointImage without change. O(pixels).
[[nodiscard]] PointImage to_points(const SurfaceView& view, const Executor& executor);

}  // namespace saccade
