// SPDX-License-Identifier: Apache-2.0
#pragma once
// CudaDevice and cuda_device: the GPU that the CUDA back end would use.

#include <cstddef>
#include <string>

#include "saccade/core/result.hpp"

namespace saccade {

/// An NVIDIA GPU.
struct CudaDevice {
  std::string name;
  std::size_t memory_bytes{0};
  int compute_major{0};  ///< compute capability, 9.0 of an H200
  int compute_minor{0};
  int driver_version{0};   ///< newest CUDA version that the driver speaks, 1000 · major + 10 · minor
  std::string ptx_target;  ///< virtual architecture of the program's kernels, which the driver compiles for the GPU
};

/// Returns the first GPU. Answers unavailable, with the reason, where the build has no kernels, or the machine no
/// driver or no GPU. The driver's library is loaded on the first call.
[[nodiscard]] Result<CudaDevice> cuda_device();

}  // namespace saccade
