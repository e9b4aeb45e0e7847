// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuAlignment: the linearisations of ICP in a device's memory.

#include "saccade/cuda/internal/align_kernel.hpp"
#include "saccade/cuda/internal/compute.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/tracking/internal/alignment.hpp"

namespace saccade::internal::cuda {

/// Planes of a PointImage, one after the other in device memory.
class Planes {
 public:
  explicit Planes(Compute& compute) : memory_{compute} {}
  [[nodiscard]] Status assign(const PointImage& image);
  /// Returns every stride-th pixel of every stride-th row, of an image of this size.
  [[nodiscard]] LevelPoints level(int width, int height, int stride) const;

 private:
  Buffer<float> memory_;
};

/// Buffers of an alignment, which stay for the next.
class GpuAlignment {
 public:
  explicit GpuAlignment(Compute& compute)
      : compute_{compute},
        measured_{compute},
        model_{compute},
        terms_{compute},
        lane_sums_{compute},
        chunk_sums_{compute},
        pairs_{compute} {}

  [[nodiscard]] Result<IcpResult> align(const PointImage& measured, const PointImage& model,
                                        const PinholeCamera& camera, const Pose& T_model_camera_start,
                                        const IcpConfig& config);

 private:
  [[nodiscard]] Result<NormalEquations> sums_of(const PairingTask& task, int measured_width);

  Compute& compute_;
  Planes measured_;
  Planes model_;
  Buffer<float> terms_;
  Buffer<float> lane_sums_;
  Buffer<double> chunk_sums_;
  Buffer<std::uint32_t> pairs_;
};

}  // namespace saccade::internal::cuda
