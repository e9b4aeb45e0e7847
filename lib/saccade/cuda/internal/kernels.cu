// SPDX-License-Identifier: Apache-2.0
// The kernels as clang compiles them to PTX: the structs of the headers, each behind an entry point. Needs no toolkit.

// Names that a toolkit's headers would define, and that clang's own headers ask for.
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))
#define __shared__ __attribute__((shared))
#define __launch_bounds__(threads, blocks) __attribute__((launch_bounds(threads, blocks)))

#include "saccade/cuda/internal/all_kernels.hpp"

namespace cuda = saccade::internal::cuda;

#define SACCADE_KERNEL(name, Kernel)                                                                                 \
  extern "C" __global__ __launch_bounds__(cuda::Kernel::kThreads, cuda::Kernel::kBlocksPerUnit) void name(                                         \
      const cuda::Kernel::Arguments arguments) {                                                                     \
    static __shared__ cuda::Kernel::Shared shared;                                                                   \
    const cuda::Thread thread{static_cast<unsigned>(__nvvm_read_ptx_sreg_ctaid_x()),                                 \
                              static_cast<unsigned>(__nvvm_read_ptx_sreg_tid_x())};                                  \
    cuda::for_each_phase<cuda::Kernel>([&](auto phase) {                                                             \
      if constexpr (decltype(phase)::value > 0) __syncthreads();                                                     \
      cuda::Kernel::run<decltype(phase)::value>(arguments, shared, thread);                                          \
    });                                                                                                              \
  }

SACCADE_ALL_KERNELS(SACCADE_KERNEL)
