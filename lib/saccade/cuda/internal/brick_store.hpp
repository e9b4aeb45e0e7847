// SPDX-License-Identifier: Apache-2.0
#pragma once
// BrickStore: the map's bricks in a device's memory, and their ways from and to the host.

#include <vector>

#include "saccade/cuda/internal/compute.hpp"
#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/cuda/internal/place_kernel.hpp"
#include "saccade/cuda/internal/raycast_kernel.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade::internal::cuda {

/// Table and pools of MapView. Grows by need; every error leaves it undefined.
class BrickStore {
 public:
  explicit BrickStore(Compute& compute);

  /// Makes the table hold a box of bricks. Answers unsupported for a box that is too large for a flat table.
  [[nodiscard]] Status cover(const IndexBox& bricks);
  /// Makes room for stored bricks in addition to the present ones.
  [[nodiscard]] Status reserve_slots(std::size_t more);
  /// Makes room for pull(), so that it works where no memory is left.
  [[nodiscard]] Status reserve_pull();
  [[nodiscard]] MapView view() const;
  [[nodiscard]] std::size_t slots() const { return v_.capacity() / kBrickVoxels; }
  [[nodiscard]] std::size_t used_slots() const { return used_slots_; }
  /// Notes how many slots the kernels have taken in all.
  void set_used_slots(std::size_t used) { used_slots_ = used; }
  /// Takes note that kernels changed bricks.
  void changed() {
    forget_copies();
    may_be_touched_ = true;
  }
  /// Marks the blocks of bricks that hold a voxel that is not empty.
  [[nodiscard]] Status mark_blocks();
  /// Marks where surface cells may be, unless that is done already.
  [[nodiscard]] Result<SurfaceMarks> mark_surface();

  [[nodiscard]] Status assign(const TsdfSnapshot& map);
  /// Replaces the content of some bricks by that of a map, and leaves all others. Sends what these bricks hold alone.
  [[nodiscard]] Status update(const TsdfGrid& map, std::span<const SectorBricks> bricks);
  /// Writes the bricks that kernels changed since the last call into a map, which stays as it was on an error.
  [[nodiscard]] Status pull(TsdfSnapshot& map);
  [[nodiscard]] Result<TsdfSnapshot> snapshot(const TsdfConfig& config) const;

 private:
  void forget_copies() {
    blocks_marked_ = surface_marked_ = false;
    known_entries_.clear();
  }
  /// Makes the pools hold this number of bricks.
  [[nodiscard]] Status grow_pools(std::size_t slots);
  /// Bricks on their way to the device.
  struct Sent;
  [[nodiscard]] Status send(const Sent& sent);
  /// Returns the entry that a brick of the map gets; takes or gives back a slot.
  [[nodiscard]] BrickEntry entry_for(const BrickRef& brick, BrickEntry before);
  [[nodiscard]] Result<std::vector<TouchedBrick>> touched();
  /// As touched(), from the whole table, where there is no room for a list.
  [[nodiscard]] Result<std::vector<TouchedBrick>> touched_in_table();
  /// Reads the bricks of some slots, in their order.
  [[nodiscard]] Result<std::vector<BrickRef>> gather(std::span<const std::uint32_t> slots, std::uint16_t free_weight);

  Compute& compute_;
  TableBox bricks_{};
  TableBox blocks_{};
  std::size_t used_slots_{0};
  bool blocks_marked_{false};
  bool surface_marked_{false};
  bool may_be_touched_{false};
  Buffer<BrickEntry> entries_;
  Buffer<std::uint8_t> touched_;
  Buffer<std::int16_t> v_;
  Buffer<std::uint16_t> w_;
  Buffer<std::uint64_t> unknown_;
  Buffer<std::uint64_t> occupied_;
  Buffer<std::uint8_t> block_stops_;
  Buffer<std::uint8_t> brick_has_cells_;
  Buffer<std::uint8_t> block_has_cells_;
  std::vector<BrickEntry> known_entries_;  ///< copy of the table; empty: the host has none
  std::vector<std::uint32_t> free_slots_;  ///< slots that no entry names
  Buffer<std::uint64_t> sent_places_;
  Buffer<BrickEntry> sent_entries_;
  Buffer<std::int16_t> sent_v_;
  Buffer<std::uint16_t> sent_w_;
  Buffer<std::uint64_t> sent_unknown_;
  Buffer<std::uint64_t> sent_occupied_;
  Buffer<std::uint32_t> touched_count_;
  Buffer<TouchedBrick> touched_list_;
  Buffer<std::uint32_t> gathered_slots_;
};

/// Returns the number of blocks of kThreads threads that hold one thread for each of `count` items.
template <class Kernel>
[[nodiscard]] std::size_t blocks_for(std::uint64_t count) {
  return static_cast<std::size_t>((count + Kernel::kThreads - 1) / Kernel::kThreads);
}

}  // namespace saccade::internal::cuda
