// SPDX-License-Identifier: Apache-2.0
#pragma once
// The scene of the benchmarks of view evaluation: a map of a table with clutter, a forgotten region, poses around it.

#include <cstddef>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/analytic_scene.hpp"

namespace saccade::bench {

inline const Eigen::Vector3d kPoi{0.0, 0.0, 0.1};
inline const Region kRegion{Sphere{kPoi, 0.2}};
constexpr int kMostViews{3};

/// A table; on it, in the region, a bin, a shelf and round things that hide each other, and large boxes around.
[[nodiscard]] const AnalyticScene& table();

struct TableMapConfig {
  double voxel_size_m{TsdfConfig{}.voxel_size_m};
  double reach_m{1.2};    ///< half the edge of the cube that was seen
  bool workspace{false};  ///< what lies beyond is transparent, not unknown
};
/// The table fully seen from outside, then the region forgotten; beyond the truncation behind surfaces all is unknown.
[[nodiscard]] TsdfSnapshot table_map(const TableMapConfig& config = {});

/// The map after the best views of the region were fused one after the other, at most kMostViews: clutter around,
/// unknown in front. Made at the first call.
[[nodiscard]] const TsdfSnapshot& map_after(std::size_t views);

/// The table in voxels of 3.6 mm (490,000 of its surface), then after each of six views of about 5 % of it, each fused
/// `frames` times.
constexpr double kFineVoxel_m{0.0036};
[[nodiscard]] std::vector<TsdfSnapshot> fine_maps_after_views(int frames);

/// The 960 poses of thesis §2.2.3 around the region; the eight rolls of a camera centre follow each other.
[[nodiscard]] const std::vector<Pose>& all_poses();
[[nodiscard]] std::vector<Pose> every_nth_pose(std::size_t n);

}  // namespace saccade::bench
