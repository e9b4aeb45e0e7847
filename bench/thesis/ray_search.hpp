// SPDX-License-Identifier: Apache-2.0
#pragma once
// RaySearch: ways to find the first voxel of a ray that is not empty: exact, at a fixed step, or with PCL's octree;
// gains_of and compare_rays cast all rays of views with one.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/map/ray_math.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "thesis/stop_volume.hpp"

namespace saccade::thesis {

/// Const use from many threads is safe.
class RaySearch {
 public:
  virtual ~RaySearch() = default;
  /// For progress.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// The first voxel that is not empty; nullopt where the ray leaves the volume before. It starts in an empty voxel of
  /// the volume.
  [[nodiscard]] virtual std::optional<Index3> first_voxel(const LatticeRay& ray) const = 0;
};

/// Ours: the exact walk of the map (map/ray_walk.hpp), each ray by itself. Both arguments outlive it.
[[nodiscard]] std::unique_ptr<RaySearch> exact_search(const TsdfSnapshot& map, const StopVolume& volume);

/// NBV-CPU-step of thesis §2.2.3: looks at the ray every step_vox voxels. The volume outlives it.
[[nodiscard]] std::unique_ptr<RaySearch> fixed_step_search(const StopVolume& volume, double step_vox);

/// NBV-CPU of thesis §2.2.3: getIntersectedVoxelCenters of pcl::octree::OctreePointCloudSearch, told to stop at the
/// first voxel. Its octree holds the boundary voxels only: the same answers as with all voxels that are not empty, for
/// a fraction of the time and memory.
/// @return unavailable in a build without PCL.
[[nodiscard]] Result<std::unique_ptr<RaySearch>> octree_search(const StopVolume& volume);

/// The gains that evaluate_views counts in rays, every ray of every view cast by itself. Cameras must lie in the
/// volume, its minimum range before the region; a camera in a voxel that is not empty sees nothing.
/// @return cancelled when progress says so. The threads share the poses.
[[nodiscard]] Result<std::vector<std::uint64_t>> gains_of(const RaySearch& search, const StopVolume& volume,
                                                          std::span<const Pose> T_world_camera,
                                                          const PinholeCamera& sensor, double voxel_size_m,
                                                          const Executor& executor, const Progress& progress = {});

/// The poses whose camera is in a voxel that is not empty.
[[nodiscard]] std::size_t blocked_cameras(const StopVolume& volume, std::span<const Pose> T_world_camera,
                                          double voxel_size_m);

/// How two searches agree, ray by ray.
struct RayComparison {
  std::uint64_t rays{0};
  std::uint64_t other_voxel{0};  ///< rays that end in another voxel, or only in one of the two
  std::uint64_t other_score{0};  ///< those of them that count for the gain in only one of the two

  [[nodiscard]] double other_voxel_share() const {
    return rays > 0 ? static_cast<double>(other_voxel) / static_cast<double>(rays) : 1.0;
  }
};
[[nodiscard]] Result<RayComparison> compare_rays(const RaySearch& search, const RaySearch& reference,
                                                 const StopVolume& volume, std::span<const Pose> T_world_camera,
                                                 const PinholeCamera& sensor, double voxel_size_m,
                                                 const Executor& executor, const Progress& progress = {});

}  // namespace saccade::thesis
