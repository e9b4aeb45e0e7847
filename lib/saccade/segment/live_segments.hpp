// SPDX-License-Identifier: Apache-2.0
#pragma once
// MapSegmentsConfig, segment_map: the surface of a map in segments; LiveSegments: those of a map that goes on changing.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/segment/lccp.hpp"

namespace saccade {

class SurfaceBlocks;
struct SurfaceBlock;

/// Parameters of segment_map.
struct MapSegmentsConfig {
  double voxel_size_m{0.0075};  ///< wanted; it becomes 1, 2, 4 or 8 voxels of the map, the nearest. Seeds: one per 4³
  double spatial_weight{1.0};   ///< this and the next three as in SupervoxelConfig
  double normal_weight{4.0};
  double color_weight{0.0};
  double min_seed_share{0.3};
  std::uint16_t min_weight{1};  ///< voxels of the map observed less often count as unknown
  /// Surface away from this box does not count: blocks of 8³ voxels that do not meet it.
  std::optional<Box> within{};
  LccpConfig lccp{};

  /// @return invalid_argument as of SupervoxelConfig and LccpConfig, and for a box that is none.
  [[nodiscard]] Status validate() const;
  /// For a map with such voxels; voxel_size_m and seed_spacing_m are those that are taken.
  [[nodiscard]] SupervoxelConfig supervoxels(double map_voxel_size_m) const;
};

/// Labels are per point, as of find_supervoxels and segment_by_convexity.
struct MapSegments {
  PointCloud points;  ///< those of surface_points, by blocks of 8³ voxels in z-y-x order, by voxels within
  SupervoxelResult supervoxels;
  LccpResult segments;
};

/// Voxels in place of their points: what saliency needs, in less time.
struct VoxelSegments {
  std::vector<Eigen::Vector3f> positions_m;  ///< means of the points, in the order of MapSegments' voxels
  std::vector<std::uint32_t> labels;         ///< segment of each
  std::size_t segments{0};
};

/// What LiveSegments::update did.
struct MapSegmentsUpdate {
  std::size_t bricks_changed{0};   ///< in the map
  std::size_t voxels_changed{0};   ///< of the blocks whose surface changed
  std::size_t voxels_labelled{0};  ///< whose supervoxel was looked for anew
  double ms{0.0};
};

/// Follows a map from snapshot to snapshot. After update(map), segments() equals segment_map(map) to the bit, which is
/// the first update of a new one. Thesis §3.1.2.
///
/// Supervoxels are found as in find_supervoxels, but so that what a voxel belongs to depends on nothing more than two
/// blocks of 8³ voxels away: the cells of seeds lie within blocks, a seed reaches eight voxels, and voxels that none
/// reaches are a supervoxel per cell. So after a change blocks up to two away are labelled anew, all others are kept;
/// which supervoxels convexity joins is found for the whole map, from edges that are kept as well.
/// Const use from many threads is safe, one writer at a time. It holds the snapshot.
class LiveSegments {
 public:
  /// invalid_argument when the configuration is.
  [[nodiscard]] static Result<LiveSegments> create(const MapSegmentsConfig& config = {});

  /// Follows the map to this state, any later or earlier one, or that of another map of the same voxel size (contract).
  /// O(changed_sectors + voxels around changed ones + supervoxels). The same for every thread count.
  MapSegmentsUpdate update(const TsdfSnapshot& map, const Executor& executor);

  /// How many segments there are, without going through points.
  [[nodiscard]] std::size_t segment_count() const { return segments_.segments; }
  /// All voxels with their segments. O(voxels).
  [[nodiscard]] VoxelSegments voxels(const Executor& executor) const;
  /// All points with their labels. O(points).
  [[nodiscard]] MapSegments segments(const Executor& executor) const;

 private:
  using Slots = std::vector<std::uint32_t>;
  explicit LiveSegments(const MapSegmentsConfig& config);

  [[nodiscard]] std::vector<Index3> keys_of(const SectorTable& table, std::span<const SectorBricks> stale) const;
  [[nodiscard]] bool is_wanted(const Index3& key) const;
  [[nodiscard]] SurfaceBlock read_block(const SectorTable& table, const Index3& key) const;
  [[nodiscard]] Slots renew_surface(const TsdfSnapshot& map, std::span<const SectorBricks> stale,
                                    const Executor& executor);
  [[nodiscard]] Slots renew_labels(const Slots& slots, const Executor& executor);
  void label_blocks(std::span<const std::uint32_t> slots);
  void renew_parts(const Slots& slots, const Executor& executor);
  void renew_own(const Slots& slots, const Executor& executor);
  void reorder(const Slots& renewed);
  void join(const Executor& executor);
  [[nodiscard]] std::uint32_t number(std::uint32_t voxel_name) const;
  void read_numbers(const SurfaceBlock& block, Slots& numbers) const;

  MapSegmentsConfig config_;
  TsdfSnapshot map_;
  SupervoxelConfig supervoxel_config_;
  int shift_{0};  ///< log2 of the voxels of the map along one of ours
  Hidden<SurfaceBlocks> blocks_;
  Slots order_;                              ///< blocks in z-y-x order
  std::vector<std::uint32_t> first_number_;  ///< per slot: of its own supervoxels
  SupervoxelResult supervoxels_;             ///< without labels
  LccpResult segments_;                      ///< without labels
};

/// The surface of a map in segments, straight from its voxels and the gradient of its TSDF. Thesis §3.1.2, line 3 and 4
/// of Algorithm 4.
/// @return invalid_argument for a bad config; a map without a surface: no points.
/// O(bricks near the surface + points). The thread count never changes a bit of the result.
[[nodiscard]] Result<MapSegments> segment_map(const TsdfSnapshot& map, const Executor& executor,
                                              const MapSegmentsConfig& config = {});

}  // namespace saccade
