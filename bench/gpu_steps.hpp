// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parts of bench_gpu_check. Each prints members of a JSON object, each with a comma behind it, and returns whether
// every result equals the CPU's.

#include "gpu_report.hpp"

namespace saccade::bench {

/// Fusion, surface ray cast and alignment of single images.
[[nodiscard]] bool check_gpu_frames(const GpuCheck& check);
/// Reconstruction with the GPU tracking beside that of the CPU.
[[nodiscard]] bool check_gpu_tracking(const GpuCheck& check);
/// Choices of the surface strategy, one after the other.
[[nodiscard]] Result<bool> check_gpu_choices(const GpuCheck& check);
/// Expected surface, steps that stay on the GPU, and pages.
[[nodiscard]] Result<bool> check_gpu_steps(const GpuCheck& check);

}  // namespace saccade::bench
