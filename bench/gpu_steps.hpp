// SPDX-License-Identifier: Apache-2.0
#pragma once
// The part of bench_gpu_check about the expected surface, and about steps of an exploration that stay on the GPU.

#include <functional>

#include "saccade/cuda/gpu_map.hpp"

namespace saccade::bench {

struct GpuStepsOptions {
  bool quick{false};
  bool emulated{false};
  std::function<Result<GpuMap>(const TsdfConfig& config)> open;  ///< makes a map on the device under test
};

/// Prints members of a JSON object, each with a comma behind it. @return whether every result equals the CPU's.
[[nodiscard]] Result<bool> check_gpu_steps(const GpuStepsOptions& options);

}  // namespace saccade::bench
