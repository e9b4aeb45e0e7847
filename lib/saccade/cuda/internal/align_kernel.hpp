// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kernels of ICP: terms of every pixel, then their sums in the lanes, chunks and order of the CPU. Thesis §2.2.1.

#include <cstdint>

#include "saccade/cuda/internal/kernel.hpp"
#include "saccade/tracking/internal/pair_math.hpp"

namespace saccade::internal::cuda {

struct AlignArguments {
  PairingTask task;    ///< planes in the device's memory; `measured` has the level's size and stride
  int measured_width;  ///< columns of the whole measured image
  int rows_per_chunk;
  int chunks;
  float* terms;          ///< kPairTerms planes of the level's pixels
  float* lane_sums;      ///< kPairLanes sums of each term of each chunk
  double* chunk_sums;    ///< sum of each term of each chunk
  std::uint32_t* pairs;  ///< number of pixels with a partner
};

/// Finds the terms of every pixel of a level, a pixel per thread.
struct PairPixels {
  using Arguments = AlignArguments;
  struct Shared {
    std::uint32_t pairs;
  };
  static constexpr const char* kName{"saccade_pair_pixels"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{3};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& shared, const Thread& thread) {
    if constexpr (kPhase == 0) {
      if (thread.index == 0) shared.pairs = 0;
    } else if constexpr (kPhase == 1) {
      const LevelPoints& level = a.task.measured;
      const int count = level.width * level.height;
      const int pixel = static_cast<int>(thread.block * kThreads + thread.index);
      if (pixel >= count) return;
      const int column = pixel % level.width;
      const int row = pixel / level.width;
      const int at = row * level.stride * a.measured_width + column * level.stride;
      float terms[kPairTerms];
      const bool pair =
          pair_products(a.task, column, row, {level.z[at], level.nx[at], level.ny[at], level.nz[at]}, terms);
      float* term_of_pixel = a.terms + pixel;
      for (int k = 0; k < kPairTerms; ++k, term_of_pixel += count) *term_of_pixel = pair ? terms[k] : 0.0F;
      if (pair) atomic_add(shared.pairs, 1U);
    } else if (thread.index == 0 && shared.pairs != 0) {
      atomic_add(*a.pairs, shared.pairs);
    }
  }
};

/// Sums the terms of every kPairLanes-th column of a chunk of rows, in their order; a sum per thread.
struct SumLanes {
  using Arguments = AlignArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_sum_lanes"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const int at = static_cast<int>(thread.block * kThreads + thread.index);
    if (at >= a.chunks * kPairTerms * kPairLanes) return;
    const int lane = at % kPairLanes;
    const int term = at / kPairLanes % kPairTerms;
    const int chunk = at / kPairLanes / kPairTerms;
    const LevelPoints& level = a.task.measured;
    const float* const terms = a.terms + static_cast<std::ptrdiff_t>(term) * level.width * level.height;
    const int past_chunk = (chunk + 1) * a.rows_per_chunk;
    const int end = past_chunk < level.height ? past_chunk : level.height;
    float sum{0.0F};
    for (int row = chunk * a.rows_per_chunk; row < end; ++row) {
      for (int column = lane; column < level.width; column += kPairLanes) sum += terms[row * level.width + column];
    }
    a.lane_sums[at] = sum;
  }
};

/// Adds up the lanes of each term of each chunk, in order.
struct SumChunks {
  using Arguments = AlignArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_sum_chunks"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const int at = static_cast<int>(thread.block * kThreads + thread.index);
    if (at >= a.chunks * kPairTerms) return;
    double sum{0.0};
    for (int lane = 0; lane < kPairLanes; ++lane) sum += static_cast<double>(a.lane_sums[at * kPairLanes + lane]);
    a.chunk_sums[at] = sum;
  }
};

}  // namespace saccade::internal::cuda
