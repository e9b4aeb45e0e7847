// SPDX-License-Identifier: Apache-2.0
// In every benchmark: ours and peers alike find memory in the heap, as in the program
// (docs/decisions/0022-freed-memory.md); SACCADE_BENCH_SIMD=AVX2 has our kernels run on that instruction set.
#include <cstdio>
#include <cstdlib>

#include "saccade/core/freed_memory.hpp"
#include "saccade/core/simd.hpp"

namespace {

bool set_up() {
  saccade::keep_freed_memory();
  const char* simd = std::getenv("SACCADE_BENCH_SIMD");
  if (simd == nullptr) return true;
  const saccade::Status used = saccade::use_simd_target(simd);
  if (used) return true;
  std::fprintf(stderr, "SACCADE_BENCH_SIMD=%s\n", used.error().to_string().c_str());
  std::exit(2);
}

[[maybe_unused]] const bool is_set_up = set_up();

}  // namespace
