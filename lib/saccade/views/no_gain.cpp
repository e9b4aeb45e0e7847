// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/no_gain.hpp"

#include "saccade/views/internal/gain_problem.hpp"

namespace saccade {
namespace {

/// Tells whether an unknown voxel has its centre in the region, which may reach beyond `voxels`.
bool holds_unknown(const TsdfSnapshot& map, const Region& region, const IndexBox& voxels) {
  Index3 voxel = voxels.lo;
  for (voxel.z = voxels.lo.z; voxel.z < voxels.hi.z; ++voxel.z) {
    for (voxel.y = voxels.lo.y; voxel.y < voxels.hi.y; ++voxel.y) {
      for (voxel.x = voxels.lo.x; voxel.x < voxels.hi.x; ++voxel.x) {
        if (map.grid.state(voxel) == VoxelState::unknown &&
            contains(region, voxel_center(voxel, map.config.voxel_size_m))) {
          return true;
        }
      }
    }
  }
  return false;
}

/// Tells whether rays of a camera in the voxel end there.
bool stops_camera(const TsdfSnapshot& map, const Region& region, const Index3& voxel, UnknownOutside outside) {
  const Eigen::Vector3d p_world = voxel_center(voxel, map.config.voxel_size_m);
  if (map.config.workspace && !contains(*map.config.workspace, p_world)) return false;
  const VoxelState state = map.grid.state(voxel);
  return state == VoxelState::occupied ||
         (state == VoxelState::unknown && (outside == UnknownOutside::blocks || contains(region, p_world)));
}

/// Cameras within range of the region. Those whose rays end in the voxel of the camera, and those whose voxel is
/// occupied.
struct CameraCounts {
  std::size_t within_range{0};
  std::size_t stopped{0};
  std::size_t in_occupied{0};
};

CameraCounts count_cameras(const TsdfSnapshot& map, const Region& region, const IndexBox& voxels,
                           std::span<const Pose> T_world_camera, const GainConfig& config) {
  const double voxel_size_m = map.config.voxel_size_m;
  const double reach = longest_ray_vox(widened_vertically(config.sensor, config.tilt_rad), voxel_size_m);
  CameraCounts counts;
  for (const Pose& pose : T_world_camera) {
    const Index3 voxel = voxel_at(pose.translation(), voxel_size_m);
    if (!within_reach(voxel, voxels, reach)) continue;
    ++counts.within_range;
    if (!stops_camera(map, region, voxel, config.unknown_outside)) continue;
    ++counts.stopped;
    counts.in_occupied += map.grid.state(voxel) == VoxelState::occupied ? 1 : 0;
  }
  return counts;
}

}  // namespace

NoGain why_no_gain(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                   const GainConfig& config) {
  if (T_world_camera.empty()) return NoGain::no_poses;
  const IndexBox voxels = region_in_workspace(region, map.config);
  if (voxels.empty()) return NoGain::outside_workspace;
  if (!holds_unknown(map, region, voxels)) return NoGain::nothing_unknown;
  const CameraCounts cameras = count_cameras(map, region, voxels, T_world_camera, config);
  if (cameras.within_range == 0) return NoGain::out_of_range;
  if (cameras.stopped < cameras.within_range) return NoGain::out_of_sight;
  return cameras.in_occupied == 0 ? NoGain::cameras_in_unknown : NoGain::cameras_blocked;
}

std::string_view advice(NoGain reason) {
  switch (reason) {
    case NoGain::some_gain: return "at least one pose gains something";
    case NoGain::no_poses: return "there is no pose to evaluate: pass at least one";
    case NoGain::outside_workspace:
      return "the region lies outside the map's workspace, where nothing counts as unknown: enlarge the workspace or "
             "move the region";
    case NoGain::nothing_unknown:
      return "every voxel of the region is known: choose another region, or forget this one to look at it again";
    case NoGain::out_of_range:
      return "every camera is farther from the region than its range: move the poses closer, or raise the sensor's "
             "maximum range";
    case NoGain::cameras_in_unknown:
      return "every camera within range stands in unknown space, where its rays end: give the map a workspace, outside "
             "of which nothing is unknown, or set the cameras' surroundings free";
    case NoGain::cameras_blocked:
      return "every camera within range stands in occupied or unknown space, where its rays end: move the poses away "
             "from surfaces, and give the map a workspace, outside of which nothing is unknown";
    case NoGain::out_of_sight:
      return "the region's unknown voxels are hidden, nearer than the sensor's minimum range, or outside of every "
             "image: try other poses";
  }
  return "";
}

}  // namespace saccade
