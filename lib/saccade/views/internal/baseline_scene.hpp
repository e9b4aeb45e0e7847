// SPDX-License-Identifier: Apache-2.0
#pragma once
// BaselineScene: the voxels that count for the baselines' gains, shared by their implementations.

#include <span>
#include <vector>

#include "saccade/views/baseline_gains.hpp"
#include "saccade/views/internal/state_volume.hpp"

namespace saccade {

/// The map's workspace, and the box of counted voxels in it: around the objects seen so far, grown by the margin; the
/// whole workspace where no object was seen.
struct BaselineScene {
  StateVolume volume;
  IndexBox counted;        ///< box of counted voxels; empty: none
  Region bounds;           ///< region that must contain the centre of a counted voxel
  bool on_support{false};  ///< objects were seen that stand on something: cameras stay above it

  [[nodiscard]] bool counts(const Index3& voxel) const {
    return counted.contains(voxel) && contains(bounds, voxel_center(voxel, volume.voxel_size_m()));
  }
  /// Tells whether a camera sees nothing: in a voxel that is not empty, or lower than the objects.
  [[nodiscard]] bool is_blocked(const Eigen::Vector3d& camera_m) const {
    const Index3 voxel = voxel_at(camera_m, volume.voxel_size_m());
    if (on_support && voxel.z < counted.lo.z) return true;
    return volume.box().contains(voxel) && volume[volume.index(voxel)] != VoxelState::empty;
  }
};
/// Finds the counted voxels. O(voxels of the workspace).
[[nodiscard]] Result<BaselineScene> read_baseline_scene(const PlanningContext& context, const RegionOfInterest& region,
                                                        double object_margin_m);

/// Returns the virtual camera with `columns_px` pixels across, widened for the tilt.
[[nodiscard]] PinholeCamera sampled_camera(const BaselineGainConfig& config);

/// Tells whether a point lies in the camera's image and range.
[[nodiscard]] inline bool is_in_image(const PinholeCamera& camera, const Eigen::Vector3d& p_camera) {
  if (p_camera.z() < camera.min_range_m || p_camera.z() > camera.max_range_m) return false;
  const Eigen::Vector2d at = camera.project(p_camera);
  return at.x() >= -0.5 && at.x() < camera.width - 0.5 && at.y() >= -0.5 && at.y() < camera.height - 0.5;
}

/// The 26 neighbours of a voxel, and their index offsets in a volume.
struct Neighbours {
  explicit Neighbours(const StateVolume& volume);
  std::vector<std::ptrdiff_t> offsets;
  std::vector<Eigen::Vector3f> directions;  ///< not normalised
};

/// Occupied voxel with an empty one beside a face.
struct SurfaceVoxel {
  std::uint32_t voxel{0};
  Eigen::Vector3f normal{Eigen::Vector3f::UnitZ()};  ///< towards empty voxels
  float area_vox{0.0F};                              ///< approximate area of its surface, in faces of a voxel
};
/// Returns the surface voxels in a box, in the order of their indices, without those at the volume's border.
[[nodiscard]] std::vector<SurfaceVoxel> surface_voxels(const StateVolume& volume, const IndexBox& box,
                                                       const Executor& executor);

}  // namespace saccade
