// SPDX-License-Identifier: Apache-2.0
#pragma once
// SACCADE_ALL_KERNELS: every kernel, for the entry points on the device and for the tests of what clang made of them.

#include "saccade/cuda/internal/align_kernel.hpp"
#include "saccade/cuda/internal/fusion_kernel.hpp"
#include "saccade/cuda/internal/gain_kernel.hpp"
#include "saccade/cuda/internal/move_kernel.hpp"
#include "saccade/cuda/internal/place_kernel.hpp"
#include "saccade/cuda/internal/raycast_kernel.hpp"
#include "saccade/cuda/internal/surface_kernel.hpp"

/// Calls APPLY(name on the device, struct) for each kernel; the name is the struct's kName.
#define SACCADE_ALL_KERNELS(APPLY)                      \
  APPLY(saccade_count_scoring_rays, CountScoringRays)   \
  APPLY(saccade_mark_blocks, MarkBlocks)                \
  APPLY(saccade_find_ranges, FindRanges)                \
  APPLY(saccade_find_bricks_in_view, FindBricksInView)  \
  APPLY(saccade_fuse_bricks, FuseBricks)                \
  APPLY(saccade_move_entries, MoveEntries)              \
  APPLY(saccade_mark_surface_bricks, MarkSurfaceBricks) \
  APPLY(saccade_mark_surface_blocks, MarkSurfaceBlocks) \
  APPLY(saccade_cast_surface_rays, CastSurfaceRays)     \
  APPLY(saccade_pair_pixels, PairPixels)                \
  APPLY(saccade_sum_lanes, SumLanes)                    \
  APPLY(saccade_sum_chunks, SumChunks)                  \
  APPLY(saccade_place_bricks, PlaceBricks)              \
  APPLY(saccade_list_touched, ListTouched)              \
  APPLY(saccade_gather_bricks, GatherBricks)            \
  APPLY(saccade_read_states, ReadStates)                \
  APPLY(saccade_expose_voxels, ExposeVoxels)            \
  APPLY(saccade_trace_sights, TraceSights)
