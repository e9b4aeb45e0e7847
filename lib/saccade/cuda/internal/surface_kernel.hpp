// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kernels of the expected surface: states of voxels, exposed voxels, lines of sight.

#include <cstdint>

#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/cuda/internal/kernel.hpp"
#include "saccade/views/internal/exposure.hpp"
#include "saccade/views/internal/line_of_sight.hpp"

namespace saccade::internal::cuda {

struct StatesArguments {
  MapView map;
  TableBox bricks;  ///< bricks that the box meets
  Index3 lo;        ///< lowest voxel of the box
  Index3 size;
  std::uint8_t* states;  ///< states of its voxels, as in StateBox
};

/// Writes the states of a brick's voxels, a brick per block.
struct ReadStates {
  using Arguments = StatesArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_read_states"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const Index3 brick = a.bricks.index(thread.block);
    const BrickEntry entry = a.map.entry(brick);
    for (unsigned i = thread.index; i < kBrickVoxels; i += kThreads) {
      const Index3 at = brick * kBrickEdge + child_offset(static_cast<int>(i)) - a.lo;
      if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= a.size.x || at.y >= a.size.y || at.z >= a.size.z) continue;
      std::uint8_t state = entry.unknown() ? StateBox::kUnknown : StateBox::kEmpty;
      if (entry.stored()) {
        const std::uint64_t word = std::uint64_t{entry.slot()} * kBrickWords + (i >> 6U);
        if ((a.map.occupied[word] >> (i & 63U) & 1U) != 0) state = StateBox::kOccupied;
        if ((a.map.unknown[word] >> (i & 63U) & 1U) != 0) state = StateBox::kUnknown;
      }
      a.states[(std::int64_t{at.z} * a.size.y + at.y) * a.size.x + at.x] = state;
    }
  }
};

struct ExposureArguments {
  ExposureTask task;      ///< pointers of the device
  std::uint32_t* count;   ///< number of exposed voxels; may grow beyond `room`
  ExposedVoxel* exposed;  ///< in no order
  std::uint32_t room;
};

/// Lists the exposed voxels of a box, except at its border; a voxel per thread.
struct ExposeVoxels {
  using Arguments = ExposureArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_expose_voxels"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const StateBox& volume = a.task.volume;
    const std::int64_t voxel = std::int64_t{thread.block} * kThreads + thread.index;
    if (voxel >= volume.count()) return;
    const Index3 at = volume.at(voxel);
    if (at.x < 1 || at.y < 1 || at.z < 1) return;
    if (at.x + 1 >= volume.size.x || at.y + 1 >= volume.size.y || at.z + 1 >= volume.size.z) return;
    if (!is_exposed(a.task, voxel)) return;
    ExposedVoxel exposed;
    if (!expose(a.task, voxel, exposed)) return;
    const std::uint32_t place = atomic_add(*a.count, 1U);
    if (place < a.room) a.exposed[place] = exposed;
  }
};

struct SightArguments {
  StateBox volume;
  const std::uint32_t* lines;  ///< voxel and camera of each line
  const double* cameras_m;     ///< three coordinates of each
  double through_m;
  std::uint32_t count;
  std::uint8_t* visible;  ///< one per line
};

/// Traces lines of sight, a line per thread.
struct TraceSights {
  using Arguments = SightArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_trace_sights"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t line = std::uint64_t{thread.block} * kThreads + thread.index;
    if (line >= a.count) return;
    const double* const camera = a.cameras_m + 3 * std::uint64_t{a.lines[2 * line + 1]};
    const double camera_m[3]{camera[0], camera[1], camera[2]};
    a.visible[line] = is_in_sight(a.volume, a.lines[2 * line], camera_m, a.through_m) ? 1 : 0;
  }
};

}  // namespace saccade::internal::cuda
