// SPDX-License-Identifier: Apache-2.0
#pragma once
// MoveEntries: the table of bricks in a larger one.

#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/cuda/internal/kernel.hpp"

namespace saccade::internal::cuda {

/// Copies the entries of one table into another, and what was touched; an entry per thread.
struct MoveEntries {
  struct Arguments {
    TableBox from_box;
    TableBox to_box;
    const BrickEntry* from;
    BrickEntry* to;
    const std::uint8_t* touched_from;
    std::uint8_t* touched_to;
  };
  struct Shared {};
  static constexpr const char* kName{"saccade_move_entries"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t at = std::uint64_t{thread.block} * kThreads + thread.index;
    if (at >= a.from_box.count()) return;
    const std::uint64_t to = a.to_box.at(a.from_box.index(at));
    a.to[to] = a.from[at];
    a.touched_to[to] = a.touched_from[at];
  }
};

}  // namespace saccade::internal::cuda
