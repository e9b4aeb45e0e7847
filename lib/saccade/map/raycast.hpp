// SPDX-License-Identifier: Apache-2.0
#pragma once
// Surface ray cast: what a camera would see of the map (depth, normals, colours); to_points: the same as a PointImage.

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/sensor/point_image.hpp"

namespace saccade {

/// Depth and normals of the mapped surface.
struct SurfaceView {
  DepthImage depth;                ///< metres along camera +z; 0: no surface met within the camera's range
  Image<Eigen::Vector3f> normals;  ///< camera frame, unit length, towards free space; zero where depth is 0
  ColorImage colors;               ///< black where there is none; empty unless asked for
};

struct RaycastConfig {
  bool colors{false};
};

/// Casts one ray per pixel to the first zero crossing from outside to inside of the trilinear interpolation of v
/// (thesis §2.2.1), walking the cells between voxel centres exactly, so thin structure is not stepped over. Cells with
/// an unknown corner hold no surface; rays pass through unknown space. Surfaces seen from behind are not reported.
/// O(pixels · bricks along the ray). Threads never change a bit of the result.
[[nodiscard]] Result<SurfaceView> raycast(const TsdfSnapshot& map, const PinholeCamera& camera,
                                          const Pose& T_world_camera, const Executor& executor,
                                          const RaycastConfig& config = {});

/// A view of the mapped surface in planes, as it is. O(pixels).
[[nodiscard]] PointImage to_points(const SurfaceView& view, const Executor& executor);

}  // namespace saccade
