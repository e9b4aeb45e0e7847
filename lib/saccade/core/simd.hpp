// SPDX-License-Identifier: Apache-2.0
#pragma once
// simd_target, simd_targets, use_simd_target: which instruction set the vector kernels run on.

#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Highway's name of the instruction set that the vector kernels run on (SSE4, AVX2, AVX3: AVX-512, NEON …), as told by
/// a kernel that ran on it. Chosen once, by what the processor has. Results never depend on it, to the bit.
[[nodiscard]] std::string_view simd_target();

/// Those that the kernels were compiled for and this processor has, widest first.
[[nodiscard]] std::vector<std::string> simd_targets();

/// From now on kernels run on that one of simd_targets(); on the widest for an empty name. invalid_argument for others.
/// For tests and measurements; not while kernels run.
[[nodiscard]] Status use_simd_target(std::string_view name);

}  // namespace saccade
