// SPDX-License-Identifier: Apache-2.0
// Tells the build whether a clang++ compiles kernels: it does, and it finds the standard library's headers.
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#include <cmath>
#include <cstdint>

extern "C" __attribute__((global)) void saccade_probe(std::uint32_t* out) {
  out[__nvvm_read_ptx_sreg_tid_x()] = 1;
  __syncthreads();
}
