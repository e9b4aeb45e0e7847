// SPDX-License-Identifier: Apache-2.0
#pragma once
// CudaCompute: memory and kernels of an NVIDIA GPU, by its driver alone.

#include <memory>
#include <string>
#include <string_view>

#include "saccade/cuda/device.hpp"
#include "saccade/cuda/internal/compute.hpp"

namespace saccade::internal::cuda {

struct Driver;

/// The kernels as PTX text, made at build time; empty where no clang that compiles CUDA was found.
[[nodiscard]] std::string_view kernel_ptx();
/// Names the virtual architecture of the PTX.
[[nodiscard]] std::string_view ptx_target();

/// Returns the text with another kBlocksPerUnit of a kernel, by which the driver limits its registers; unchanged where
/// there is no such kernel.
[[nodiscard]] std::string with_blocks_per_unit(std::string_view ptx, std::string_view kernel, unsigned blocks);

/// Opens the first device and loads the kernels. Answers unavailable, with the reason, where that cannot be.
[[nodiscard]] Result<std::unique_ptr<Compute>> open_cuda(std::string_view ptx = kernel_ptx());
/// Describes the first device without loading anything onto it.
[[nodiscard]] Result<CudaDevice> describe_cuda();
/// Do the same by a driver that is loaded, or that a test provides. It must outlive what it opens.
[[nodiscard]] Result<std::unique_ptr<Compute>> open_by(const Driver& driver, std::string_view ptx);
[[nodiscard]] Result<CudaDevice> describe_by(const Driver& driver);

}  // namespace saccade::internal::cuda
