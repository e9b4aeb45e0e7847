// SPDX-License-Identifier: Apache-2.0
// The kernels as clang compiles them to PTX: the structs of the headers, each behind an entry point. Needs no toolkit.

// Names that a toolkit's headers would define, and that clang's own headers ask for.
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))
#define __shared__ __attribute__((shared))
#define __launch_bounds__(threads, blocks) __attribute__((launch_bounds(threads, blocks)))

#include "saccade/cuda/internal/align_kernel.hpp"
#include "saccade/cuda/internal/fusion_kernel.hpp"
#include "saccade/cuda/internal/gain_kernel.hpp"
#include "saccade/cuda/internal/move_kernel.hpp"
#include "saccade/cuda/internal/raycast_kernel.hpp"

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

SACCADE_KERNEL(saccade_count_scoring_rays, CountScoringRays)
SACCADE_KERNEL(saccade_mark_blocks, MarkBlocks)
SACCADE_KERNEL(saccade_find_ranges, FindRanges)
SACCADE_KERNEL(saccade_find_bricks_in_view, FindBricksInView)
SACCADE_KERNEL(saccade_fuse_bricks, FuseBricks)
SACCADE_KERNEL(saccade_move_entries, MoveEntries)
SACCADE_KERNEL(saccade_mark_surface_bricks, MarkSurfaceBricks)
SACCADE_KERNEL(saccade_mark_surface_blocks, MarkSurfaceBlocks)
SACCADE_KERNEL(saccade_cast_surface_rays, CastSurfaceRays)
SACCADE_KERNEL(saccade_pair_pixels, PairPixels)
SACCADE_KERNEL(saccade_sum_lanes, SumLanes)
SACCADE_KERNEL(saccade_sum_chunks, SumChunks)
