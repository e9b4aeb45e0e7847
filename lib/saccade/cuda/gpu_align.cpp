// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/gpu_align.hpp"

#include "saccade/cuda/internal/cuda_compute.hpp"
#include "saccade/cuda/internal/gpu_alignment.hpp"

namespace saccade {

using internal::cuda::GpuAlignment;

class GpuAligner::Impl {
 public:
  explicit Impl(std::unique_ptr<internal::cuda::Compute> device) : compute{std::move(device)} {}

  std::unique_ptr<internal::cuda::Compute> compute;
  GpuAlignment alignment{*compute};
};

GpuAligner::GpuAligner(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
GpuAligner::GpuAligner(GpuAligner&&) noexcept = default;
GpuAligner& GpuAligner::operator=(GpuAligner&&) noexcept = default;
GpuAligner::~GpuAligner() = default;

Result<GpuAligner> GpuAligner::create() {
  SACCADE_TRY(std::unique_ptr<internal::cuda::Compute> compute, internal::cuda::open_cuda());
  return GpuAligner{std::make_unique<Impl>(std::move(compute))};
}

Result<GpuAligner> GpuAligner::create_emulated(const Executor& executor) {
  return GpuAligner{std::make_unique<Impl>(std::make_unique<internal::cuda::HostCompute>(executor))};
}

Result<IcpResult> GpuAligner::align(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                                    const Pose& T_model_camera_start, const IcpConfig& config) {
  return impl_->alignment.align(measured, model, camera, T_model_camera_start, config);
}

}  // namespace saccade
