// SPDX-License-Identifier: Apache-2.0
#pragma once
// The other libraries that the benchmarks measure ours against, where they are installed.

#include <memory>
#include <span>

#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::bench {

/// Open3D's VoxelBlockGrid on the CPU: blocks of 8³ voxels around surfaces only, float TSDF and weight. All its
/// threads.
class Open3dGrid {
 public:
  Open3dGrid(const PinholeCamera& camera, double voxel_size_m, double truncation_vox);
  ~Open3dGrid();

  /// Choice of blocks and fusion, as its own pipeline does it.
  void integrate(const DepthImage& depth, const Pose& T_world_camera);
  /// Depth and normals through the blocks that the frame touches, as in its own tracking.
  [[nodiscard]] DepthImage raycast(const DepthImage& depth_there, const Pose& T_world_camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// OpenCV's FastICPOdometry: dense point-to-plane ICP on three levels.
class OpencvIcp {
 public:
  explicit OpencvIcp(const PinholeCamera& camera);
  ~OpencvIcp();

  void set_model(const DepthImage& depth);
  /// The pose of the frame relative to the model's; false: none found.
  [[nodiscard]] bool align(const DepthImage& depth, Pose& T_model_camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// FCL's dynamic tree of axis-aligned boxes, as motion planners keep it.
class FclBoxes {
 public:
  explicit FclBoxes(std::span<const Box> boxes);
  ~FclBoxes();

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool touches(const Sphere& sphere) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saccade::bench
