// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuMap: a TSDF map in the memory of a GPU, which fuses depth images and evaluates views there.

#include <memory>
#include <optional>
#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/cuda/device.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/view_device.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

namespace internal::cuda {
struct GpuMapMaker;
}

/// Traffic of a GPU since it was opened.
struct GpuTraffic {
  std::uint64_t bytes_sent{0};
  std::uint64_t bytes_read{0};
  std::uint64_t kernels{0};
};

/// Map on a GPU. Its voxels equal those of TsdfMap to the bit after the same images, its gains those of evaluate_views,
/// and what it does as a ViewDevice that of the CPU. Colours are not fused. One thread at a time.
///
/// The map lies in a flat table of bricks that grows with what is seen, and in pools of the bricks whose voxels differ,
/// 2.1 KiB each. Only bricks that changed go to the GPU, and come back. Where its memory does not suffice for the map,
/// the GPU holds the bricks that the work at hand can meet, and the host the rest. Where it does not suffice for these
/// either, the call answers unavailable, and the map stays as it was: snapshot() returns it whole. A GPU that is lost
/// takes with it what it fused since the last snapshot(), which then answers unavailable like every other call.
class GpuMap final : public ViewDevice {
 public:
  /// Opens the first GPU. Answers unavailable where there is none; invalid_argument for an invalid configuration.
  [[nodiscard]] static Result<GpuMap> create(const TsdfConfig& config);
  /// Runs the same kernels on the host, for tests and comparisons: much slower than TsdfMap.
  /// @param memory_bytes  memory of the emulated device.
  [[nodiscard]] static Result<GpuMap> create_emulated(const TsdfConfig& config, const Executor& executor,
                                                      std::size_t memory_bytes = ~std::size_t{0});
  GpuMap(GpuMap&&) noexcept;
  GpuMap& operator=(GpuMap&&) noexcept;
  ~GpuMap() override;

  [[nodiscard]] const TsdfConfig& config() const;

  /// Fuses one depth image, as TsdfMap::integrate does. Of the statistics, valid_pixels equals that of the CPU;
  /// bricks_updated counts the bricks of which a voxel was observed, also those that are free as a whole; bricks_free
  /// and bricks_saturated are 0, since the GPU does not tell them apart. O(bricks in the frustum).
  [[nodiscard]] Result<FusionStats> integrate(const PinholeCamera& camera, const DepthImage& depth,
                                              const Pose& T_world_camera);

  /// Replaces the content. O(bricks that differ from those the GPU holds). Answers unsupported for a map of which
  /// sectors are out of memory.
  [[nodiscard]] Status assign(const TsdfSnapshot& map);
  [[nodiscard]] Status follow(const TsdfSnapshot& map, const Executor& executor) override;
  /// Returns the content, without colours of bricks that the GPU changed. O(bricks that it changed since the last
  /// call).
  [[nodiscard]] Result<TsdfSnapshot> snapshot() const;

  /// Casts a ray per pixel to the surface, as saccade::raycast does; without colours. O(pixels · bricks along the ray).
  [[nodiscard]] Result<SurfaceView> raycast(const PinholeCamera& camera, const Pose& T_world_camera);

  /// Tells whether evaluate_views can do this on a GPU, without opening one: unsupported for a cylinder, and where
  /// distinct voxels are counted.
  [[nodiscard]] static Status can_evaluate(const Region& region, const GainConfig& config);
  /// Computes the gains of evaluate_views, a ray per thread. The executor finds the rays' windows.
  /// @return errors of evaluate_views; unsupported for a cylinder, and where distinct voxels are counted.
  /// O(rays that meet the region · bricks along them).
  [[nodiscard]] Result<GainResult> evaluate_views(const Region& region, std::span<const Pose> T_world_camera,
                                                  const GainConfig& config, const Executor& executor);

  [[nodiscard]] Result<GainResult> evaluate_views_of(const TsdfSnapshot& map, const Region& region,
                                                     std::span<const Pose> T_world_camera, const GainConfig& config,
                                                     const Executor& executor) override;
  [[nodiscard]] Result<std::uint64_t> read_states(const IndexBox& box, std::span<VoxelState> states) override;
  [[nodiscard]] Result<std::vector<ExposedVoxel>> exposed(std::uint64_t ticket, const ExposureTask& task) override;
  [[nodiscard]] Result<std::vector<std::uint8_t>> in_sight(std::uint64_t ticket, std::span<const LineOfSight> lines,
                                                           std::span<const Eigen::Vector3d> cameras_m,
                                                           double through_m) override;
  [[nodiscard]] std::optional<Error> take_problem() override;

  /// Tells whether the GPU's memory did not suffice for the map, so that it holds a part. A smaller map that is
  /// assigned is tried whole again.
  [[nodiscard]] bool is_paged() const;
  /// Tells whether the GPU is gone for good: every call answers unavailable from now on.
  [[nodiscard]] bool is_lost() const;
  [[nodiscard]] GpuTraffic traffic() const;

 private:
  class Impl;
  friend struct internal::cuda::GpuMapMaker;
  explicit GpuMap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace saccade
