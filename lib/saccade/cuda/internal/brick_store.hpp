// SPDX-License-Identifier: Apache-2.0
#pragma once
// BrickStore: the map's bricks in a device's memory, and their ways from and to the host.

#include "saccade/cuda/internal/compute.hpp"
#include "saccade/cuda/internal/device_map.hpp"
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
  [[nodiscard]] MapView view() const;
  [[nodiscard]] std::size_t slots() const { return v_.capacity() / kBrickVoxels; }
  [[nodiscard]] std::size_t used_slots() const { return used_slots_; }
  /// Notes how many slots the kernels have taken in all.
  void set_used_slots(std::size_t used) { used_slots_ = used; }
  /// Counts a change of the bricks, after which their blocks are marked anew.
  void changed() { blocks_marked_ = false; }
  /// Marks the blocks of bricks that hold a voxel that is not empty.
  [[nodiscard]] Status mark_blocks();

  [[nodiscard]] Status assign(const TsdfSnapshot& map);
  [[nodiscard]] Result<TsdfSnapshot> snapshot(const TsdfConfig& config) const;

 private:
  Compute& compute_;
  TableBox bricks_{};
  TableBox blocks_{};
  std::size_t used_slots_{0};
  bool blocks_marked_{false};
  Buffer<BrickEntry> entries_;
  Buffer<std::int16_t> v_;
  Buffer<std::uint16_t> w_;
  Buffer<std::uint64_t> unknown_;
  Buffer<std::uint64_t> occupied_;
  Buffer<std::uint8_t> block_stops_;
};

/// Returns the number of blocks of kThreads threads that hold one thread for each of `count` items.
template <class Kernel>
[[nodiscard]] std::size_t blocks_for(std::uint64_t count) {
  return static_cast<std::size_t>((count + Kernel::kThreads - 1) / Kernel::kThreads);
}

}  // namespace saccade::internal::cuda
