// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/device.hpp"

#include "saccade/cuda/internal/cuda_compute.hpp"

namespace saccade {

Result<CudaDevice> cuda_device() { return internal::cuda::describe_cuda(); }

}  // namespace saccade
