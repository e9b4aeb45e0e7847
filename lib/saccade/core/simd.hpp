// SPDX-License-Identifier: Apache-2.0
#pragma once
// simd_target, simd_targets, use_simd_target: the instruction set that the vector kernels run on.

#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Returns Highway's name of the instruction set that the vector kernels run on (SSE4, AVX2, AVX3: AVX-512, NEON …), as
/// reported by a kernel that ran on it. It is chosen once, by the processor's abilities. Results never depend on it, to
/// the bit.
[[nodiscard]] std::string_view simd_target();

/// Returns the instruction sets that the kernels were compiled for and this processor has, widest first.
[[nodiscard]] std::vector<std::string> simd_targets();

/// Makes kernels run on one of simd_targets() from now on, or on the widest for an empty name. Answers invalid_argument
/// for others. For tests and measurements; must not be called while kernels run.
[[nodiscard]] Status use_simd_target(std::string_view name);

}  // namespace saccade
