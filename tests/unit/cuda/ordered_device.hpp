// SPDX-License-Identifier: Apache-2.0
#pragma once
// ordered_device, ordered_map: an emulated device whose threads and blocks run in another order for each number, since
// a GPU promises none, and a map on it.

#include <memory>

#include "saccade/cuda/internal/compute.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"

namespace saccade::test {

/// @param order as of HostCompute.
inline std::unique_ptr<internal::cuda::HostCompute> ordered_device(const Executor& executor, std::uint32_t order) {
  return std::make_unique<internal::cuda::HostCompute>(executor, ~std::size_t{0}, order);
}

inline GpuMap ordered_map(const TsdfConfig& config, const Executor& executor, std::uint32_t order) {
  return internal::cuda::GpuMapMaker::make(config, ordered_device(executor, order));
}

}  // namespace saccade::test
