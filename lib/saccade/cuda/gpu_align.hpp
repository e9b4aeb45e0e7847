// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuAligner: ICP on a GPU.

#include <memory>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/tracking/icp.hpp"

namespace saccade {

/// Aligns depth images as saccade::align does, to the bit: the terms of each pixel are found in parallel, and summed in
/// the order of the CPU. One thread at a time.
class GpuAligner {
 public:
  /// Opens the first GPU. Answers unavailable where there is none.
  [[nodiscard]] static Result<GpuAligner> create();
  /// Runs the same kernels on the host, for tests.
  [[nodiscard]] static Result<GpuAligner> create_emulated(const Executor& executor);
  GpuAligner(GpuAligner&&) noexcept;
  GpuAligner& operator=(GpuAligner&&) noexcept;
  ~GpuAligner();

  /// @return errors of the configuration; unavailable where the GPU fails. O(pixels · iterations), 112 bytes per pixel.
  [[nodiscard]] Result<IcpResult> align(const PointImage& measured, const PointImage& model,
                                        const PinholeCamera& camera, const Pose& T_model_camera_start,
                                        const IcpConfig& config = {});

 private:
  class Impl;
  explicit GpuAligner(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace saccade
