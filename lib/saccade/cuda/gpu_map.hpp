// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuMap: a TSDF map in the memory of a GPU, which fuses depth images and evaluates views there.

#include <memory>
#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/cuda/device.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// Map on a GPU. Its voxels equal those of TsdfMap to the bit after the same images, and its gains those of
/// evaluate_views. Colours are not fused. One thread at a time.
///
/// The map lies in a flat table of bricks that grows with what is seen, and in pools of the bricks whose voxels differ,
/// 2.1 KiB each. Every call answers unavailable where the GPU's memory does not suffice or the GPU is lost; the map is
/// then undefined, and snapshot() of an earlier moment is what is left.
class GpuMap {
 public:
  /// Opens the first GPU. Answers unavailable where there is none; invalid_argument for an invalid configuration.
  [[nodiscard]] static Result<GpuMap> create(const TsdfConfig& config);
  /// Runs the same kernels on the host, for tests and comparisons: much slower than TsdfMap.
  /// @param memory_bytes  memory of the emulated device.
  [[nodiscard]] static Result<GpuMap> create_emulated(const TsdfConfig& config, const Executor& executor,
                                                      std::size_t memory_bytes = ~std::size_t{0});
  GpuMap(GpuMap&&) noexcept;
  GpuMap& operator=(GpuMap&&) noexcept;
  ~GpuMap();

  [[nodiscard]] const TsdfConfig& config() const;

  /// Fuses one depth image, as TsdfMap::integrate does. The statistics count updated bricks and valid pixels alone.
  /// O(bricks in the frustum).
  [[nodiscard]] Result<FusionStats> integrate(const PinholeCamera& camera, const DepthImage& depth,
                                              const Pose& T_world_camera);

  /// Replaces the content. Answers unsupported for a map whose bricks span more than 2²⁷ bricks of space. O(bricks).
  [[nodiscard]] Status assign(const TsdfSnapshot& map);
  /// Copies the content back, without colours. O(bricks).
  [[nodiscard]] Result<TsdfSnapshot> snapshot() const;

  /// Casts a ray per pixel to the surface, as saccade::raycast does; without colours. O(pixels · bricks along the ray).
  [[nodiscard]] Result<SurfaceView> raycast(const PinholeCamera& camera, const Pose& T_world_camera);

  /// Computes the gains of evaluate_views, a ray per thread. The executor finds the rays' windows.
  /// @return errors of evaluate_views; unsupported for a cylinder, and where distinct voxels are counted.
  /// O(rays that meet the region · bricks along them).
  [[nodiscard]] Result<GainResult> evaluate_views(const Region& region, std::span<const Pose> T_world_camera,
                                                  const GainConfig& config, const Executor& executor);

 private:
  class Impl;
  explicit GpuMap(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace saccade
