// SPDX-License-Identifier: Apache-2.0
#pragma once
// PlaceBricks, ListTouched, GatherBricks: bricks on their way from the host, and back.

#include <cstdint>

#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/cuda/internal/kernel.hpp"

namespace saccade::internal::cuda {

struct PlaceArguments {
  MapView map;
  const std::uint64_t* places;    ///< index into the table, one per brick
  const BrickEntry* entries;      ///< likewise; stored ones first
  std::uint32_t stored;           ///< number of stored ones
  const std::int16_t* v;          ///< kBrickVoxels of each stored one
  const std::uint16_t* w;         ///< likewise
  const std::uint64_t* unknown;   ///< kBrickWords of each stored one
  const std::uint64_t* occupied;  ///< likewise
};

/// Writes a brick per block.
struct PlaceBricks {
  using Arguments = PlaceArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_place_bricks"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t from = thread.block;
    const BrickEntry entry = a.entries[from];
    if (thread.index == 0) a.map.entries[a.places[from]] = entry;
    if (from >= a.stored) return;
    const std::uint64_t to = entry.slot();
    for (unsigned i = thread.index; i < kBrickVoxels; i += kThreads) {
      a.map.v[to * kBrickVoxels + i] = a.v[from * kBrickVoxels + i];
      a.map.w[to * kBrickVoxels + i] = a.w[from * kBrickVoxels + i];
    }
    if (thread.index >= kBrickWords) return;
    a.map.unknown[to * kBrickWords + thread.index] = a.unknown[from * kBrickWords + thread.index];
    a.map.occupied[to * kBrickWords + thread.index] = a.occupied[from * kBrickWords + thread.index];
  }
};

/// Brick that kernels changed.
struct TouchedBrick {
  std::uint32_t place;  ///< index into the table
  BrickEntry entry;
};

struct TouchedArguments {
  MapView map;
  std::uint32_t* count;   ///< number of touched bricks; may grow beyond `room`
  TouchedBrick* touched;  ///< in no order
  std::uint32_t room;
};

/// Lists the bricks that kernels changed, an entry of the table per thread.
struct ListTouched {
  using Arguments = TouchedArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_list_touched"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t at = std::uint64_t{thread.block} * kThreads + thread.index;
    if (at >= a.map.bricks.count() || a.map.touched[at] == 0) return;
    const std::uint32_t place = atomic_add(*a.count, 1U);
    if (place < a.room) a.touched[place] = {static_cast<std::uint32_t>(at), a.map.entries[at]};
  }
};

struct GatherArguments {
  MapView map;
  const std::uint32_t* slots;
  std::int16_t* v;   ///< kBrickVoxels of each slot, in the order of the slots
  std::uint16_t* w;  ///< likewise
};

/// Copies the voxels of some slots behind each other, a slot per block.
struct GatherBricks {
  using Arguments = GatherArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_gather_bricks"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t from = a.slots[thread.block];
    const std::uint64_t to = thread.block;
    for (unsigned i = thread.index; i < kBrickVoxels; i += kThreads) {
      a.v[to * kBrickVoxels + i] = a.map.v[from * kBrickVoxels + i];
      a.w[to * kBrickVoxels + i] = a.map.w[from * kBrickVoxels + i];
    }
  }
};

}  // namespace saccade::internal::cuda
