// SPDX-License-Identifier: Apache-2.0
#pragma once
// TsdfMap: the map that one thread fuses into. TsdfSnapshot: its content for readers, taken in microseconds.
// count_unknown: number of unknown voxels in a region.

#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/map_paging.hpp"
#include "saccade/map/tsdf_grid.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Changes made by one depth image.
struct FusionStats {
  std::size_t bricks_updated{0};    ///< bricks whose voxels were visited one by one
  std::size_t bricks_free{0};       ///< bricks found entirely in front of the surface, or saturated and unseen
                                    ///< elsewhere
  std::size_t bricks_saturated{0};  ///< bricks among bricks_free that needed no work at all
  std::size_t valid_pixels{0};
  double ms{0.0};
};

class MapPager;

/// Immutable view of a map, cheap to copy and destroy. It stays unchanged while the map goes on. That of a paged map
/// keeps the sectors in memory that were there, and reads the others from the store as they were then.
struct TsdfSnapshot {
  TsdfConfig config;
  TsdfGrid grid;
};

/// Truncated signed distance map that never confuses unknown with empty. Thesis §2.2.1, §2.2.2, §2.3.1.
/// One writer at a time (integrate, forget, free); snapshot() may be called from any thread meanwhile.
class TsdfMap {
 public:
  /// Answers invalid_argument for an invalid configuration.
  [[nodiscard]] static Result<TsdfMap> create(const TsdfConfig& config);
  /// Continues from a snapshot (for example a loaded map).
  explicit TsdfMap(TsdfSnapshot content);
  TsdfMap(TsdfMap&& other) noexcept;
  TsdfMap& operator=(TsdfMap&& other) noexcept;
  ~TsdfMap();

  /// Keeps the map within limits from now on: sectors go to a store and come back. Frames, forgotten and freed regions
  /// give the same content, to the bit. Where the store fails, integrate, forget and free answer its error, and the
  /// content is as it was. Answers invalid_argument for an invalid configuration, or a map that is paged already.
  [[nodiscard]] Status keep_within(const PagingConfig& config);
  /// Brings in what a ray cast from here reads, so that it need not do so itself. Does nothing for a map that is not
  /// paged. Errors: those of the store.
  [[nodiscard]] Status look_from(const PinholeCamera& camera, const Pose& T_world_camera, const Executor& executor);
  /// Takes all sectors out of memory, before other work on content() that brings in what it needs, part by part. Does
  /// nothing for a map that is not paged.
  [[nodiscard]] Status page_out_all(const Executor& executor);
  /// Returns none for a map that is not paged.
  [[nodiscard]] std::optional<PagingStats> paging() const;

  [[nodiscard]] const TsdfConfig& config() const { return content_.config; }
  /// Returns the writer's own view, without a copy. Not for other threads.
  [[nodiscard]] const TsdfSnapshot& content() const { return content_; }

  /// Fuses one depth image.  Thesis §2.2.1, eq. (2.1)–(2.3), distances along the ray; design §3.
  /// @param depth          H×W, metres along camera +z; 0 or NaN: no return; d < 0: seen free up to |d|.
  ///                       Returns outside the camera's range limits count as none.
  /// @param T_world_camera camera → world, rigid.
  /// @param color          optional, same size; averaged within the truncation band.
  /// @return what changed; size_mismatch if depth or colour and camera disagree, invalid_argument for a bad camera or
  ///         pose, or a view of too many voxels. The map is untouched on error.
  /// O(bricks in the frustum up to the measured surface). The thread count never changes a bit of the result.
  [[nodiscard]] Result<FusionStats> integrate(const PinholeCamera& camera, const DepthImage& depth,
                                              const Pose& T_world_camera, const Executor& executor,
                                              const ColorImage* color = nullptr);

  /// Sets every voxel whose centre lies in the region back to unknown (eq. 2.6, ForgetAround of Algorithm 1).
  [[nodiscard]] Status forget(const Region& region);
  /// Sets every voxel whose centre lies in the region empty: v = 1, w = W_th.
  [[nodiscard]] Status free(const Region& region);

  /// Returns a snapshot. O(sectors), microseconds; waits at most for the frame that is being fused.
  [[nodiscard]] TsdfSnapshot snapshot() const;

 private:
  explicit TsdfMap(const TsdfConfig& config);
  [[nodiscard]] Status check_region(const Region& region) const;
  /// Brings in sectors of a paged map; camera_world may be null.
  [[nodiscard]] Status bring_in(std::span<const Index3> keys, const Eigen::Vector3d* camera_world,
                                const Executor& executor);
  /// Brings in the sectors of a region, calls edit(), and takes note of what it wrote.
  [[nodiscard]] Status edit_sectors(const Region& region, const std::function<void()>& edit);
  mutable std::mutex mutex_;
  TsdfSnapshot content_;
  std::unique_ptr<MapPager> pager_;  ///< null for a map that is not paged
};

/// Counts the unknown voxels whose centre lies in the region and in the map's workspace. O(bricks of the region).
[[nodiscard]] std::size_t count_unknown(const TsdfSnapshot& map, const Region& region);

}  // namespace saccade
