// SPDX-License-Identifier: Apache-2.0
#pragma once
// MapSegmentsConfig, segment_map: segments of a map's surface. LiveSegments: segments of a map that keeps changing.

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
  double voxel_size_m{0.0075};  ///< desired; becomes 1, 2, 4 or 8 voxels of the map, whichever is nearest. Seeds: one
                                ///< per 4³
  double spatial_weight{1.0};   ///< this and the next three as in SupervoxelConfig
  double normal_weight{4.0};
  double color_weight{0.0};
  double min_seed_share{0.3};
  std::uint16_t min_weight{1};  ///< voxels of the map observed less often count as unknown
  /// Box of interest: blocks of 8³ voxels outside it are ignored.
  std::optional<Box> within{};
  LccpConfig lccp{};

  /// @return invalid_argument as SupervoxelConfig and LccpConfig do, and for an invalid box.
  [[nodiscard]] Status validate() const;
  /// Returns the parameters for a map with this voxel size; voxel_size_m and seed_spacing_m hold the values in use.
  [[nodiscard]] SupervoxelConfig supervoxels(double map_voxel_size_m) const;
};

/// Segments of a map. Labels are per point, as in find_supervoxels and segment_by_convexity.
struct MapSegments {
  PointCloud points;  ///< as in surface_points, by blocks of 8³ voxels in z-y-x order, by voxels within
  SupervoxelResult supervoxels;
  LccpResult segments;
};

/// Voxels instead of their points: sufficient for saliency, and faster.
struct VoxelSegments {
  std::vector<Eigen::Vector3f> positions_m;  ///< means of the points, in the order of MapSegments' voxels
  std::vector<std::uint32_t> labels;         ///< segment of each voxel
  std::size_t segments{0};
};

/// Changes made by LiveSegments::update.
struct MapSegmentsUpdate {
  std::size_t bricks_changed{0};   ///< changed bricks of the map
  std::size_t voxels_changed{0};   ///< voxels in blocks whose surface changed
  std::size_t voxels_labelled{0};  ///< voxels whose supervoxel was searched again
  double ms{0.0};
};

/// Segments that follow a map from snapshot to snapshot. After update(map), segments() equals segment_map(map) to the
/// bit; segment_map is the first update of a new LiveSegments. Thesis §3.1.2.
///
/// Supervoxels are found as in find_supervoxels, but a voxel's label depends only on blocks of 8³ voxels up to two
/// blocks away. The cells of seeds lie within blocks, a seed reaches eight voxels, and voxels that no seed reaches form
/// one supervoxel per cell. After a change only blocks up to two away are labelled anew. Joining by convexity runs on
/// the whole map, from stored edges.
/// Const use from many threads is safe, with one writer at a time. LiveSegments holds the snapshot.
class LiveSegments {
 public:
  /// Answers invalid_argument for an invalid configuration.
  [[nodiscard]] static Result<LiveSegments> create(const MapSegmentsConfig& config = {});

  /// Brings the segments to this state of the map, later or earlier, or to another map with the same voxel size
  /// (contract). O(changed_sectors + voxels around changed ones + supervoxels). The thread count never changes the
  /// result.
  MapSegmentsUpdate update(const TsdfSnapshot& map, const Executor& executor);

  /// Returns the number of segments, without visiting points.
  [[nodiscard]] std::size_t segment_count() const { return segments_.segments; }
  /// Returns all voxels with their segments. O(voxels).
  [[nodiscard]] VoxelSegments voxels(const Executor& executor) const;
  /// Returns all points with their labels. O(points).
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
  int shift_{0};  ///< log2 of the map's voxels along one of ours
  Hidden<SurfaceBlocks> blocks_;
  Slots order_;                              ///< blocks in z-y-x order
  std::vector<std::uint32_t> first_number_;  ///< per slot: number of its first own supervoxel
  SupervoxelResult supervoxels_;             ///< without labels
  LccpResult segments_;                      ///< without labels
};

/// Segments the surface of a map, directly from its voxels and the gradient of its TSDF. Thesis §3.1.2, lines 3 and 4
/// of Algorithm 4.
/// @return invalid_argument for a bad config; a map without a surface: no points.
/// O(bricks near the surface + points). The thread count never changes a bit of the result.
[[nodiscard]] Result<MapSegments> segment_map(const TsdfSnapshot& map, const Executor& executor,
                                              const MapSegmentsConfig& config = {});

}  // namespace saccade
