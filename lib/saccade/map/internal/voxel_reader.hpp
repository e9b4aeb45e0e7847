// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelReader: fast reads of neighbouring voxels and of whole cells.

#include <array>
#include <optional>

#include "saccade/map/internal/cell.hpp"
#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// Reader of voxels with a small cache of bricks, so that neighbouring reads cost one array access. One per thread; the
/// table and its grid must outlive it and stay unchanged.
class VoxelReader {
 public:
  explicit VoxelReader(const SectorTable& sectors) : sectors_{&sectors} {}

  /// Returns the value of a voxel; nullopt where unknown.
  [[nodiscard]] std::optional<float> value(const Index3& voxel) {
    const Slot& slot = find(parent(voxel));
    return read(slot, child_index(voxel));
  }

  /// Returns the cell whose lower corner is `base`; nullopt when one of its corners is unknown.
  [[nodiscard]] std::optional<Cell> cell(const Index3& base) {
    Cell cell;
    if ((base.x & 7) != 7 && (base.y & 7) != 7 && (base.z & 7) != 7) {
      const Slot& slot = find(parent(base));
      if (slot.dense == nullptr && slot.free == nullptr && slot.constant == 0) return std::nullopt;
      const int first = child_index(base);
      for (int i = 0; i < 8; ++i) {
        const auto value_i = read(slot, first + (i & 1) + ((i & 2) << 2) + ((i & 4) << 4));
        if (!value_i) return std::nullopt;
        cell.v[static_cast<std::size_t>(i)] = *value_i;
      }
      return cell;
    }
    for (int i = 0; i < 8; ++i) {
      const auto value_i = value(base + Index3{i & 1, (i >> 1) & 1, (i >> 2) & 1});
      if (!value_i) return std::nullopt;
      cell.v[static_cast<std::size_t>(i)] = *value_i;
    }
    return cell;
  }

  /// Returns the colour of a voxel; nullopt where it has none.
  [[nodiscard]] std::optional<Rgb8> color(const Index3& voxel) {
    const Slot& slot = find(parent(voxel));
    if (slot.dense == nullptr || slot.dense->colors == nullptr) return std::nullopt;
    const Rgb8 color = (*slot.dense->colors)[static_cast<std::size_t>(child_index(voxel))];
    return color == Rgb8{} ? std::nullopt : std::optional{color};
  }

 private:
  struct Slot {
    Index3 brick{};
    bool filled{false};
    const DenseBrick* dense{nullptr};
    const FreeBrick* free{nullptr};
    std::uint16_t constant{0};
  };

  [[nodiscard]] static std::optional<float> read(const Slot& slot, int i) {
    if (slot.dense != nullptr) {
      if (slot.dense->w[static_cast<std::size_t>(i)] == 0) return std::nullopt;
      return static_cast<float>(slot.dense->v[static_cast<std::size_t>(i)]);
    }
    const bool known = slot.free != nullptr ? slot.free->weight(i) != 0 : slot.constant != 0;
    return known ? std::optional{static_cast<float>(kTsdfOne)} : std::nullopt;
  }

  /// Finds the cached brick. Bricks whose coordinates differ in parity never evict each other, so all bricks of a cell
  /// stay.
  [[nodiscard]] const Slot& find(const Index3& brick) {
    Slot& slot = slots_[static_cast<std::size_t>((brick.x & 1) | ((brick.y & 1) << 1) | ((brick.z & 1) << 2))];
    if (slot.filled && slot.brick == brick) return slot;
    slot = {brick, true, nullptr, nullptr, 0};
    if (const Sector* sector = sectors_->find(parent(brick))) {
      const BrickRef& ref = sector->bricks[static_cast<std::size_t>(child_index(brick))];
      slot.dense = ref.dense();
      slot.free = ref.free();
      slot.constant = slot.dense == nullptr && slot.free == nullptr ? ref.constant_weight() : std::uint16_t{0};
    }
    return slot;
  }

  const SectorTable* sectors_;
  std::array<Slot, 8> slots_{};
};

}  // namespace saccade
