// SPDX-License-Identifier: Apache-2.0
#pragma once
// MapView: the map as kernels see it: a table of bricks, and pools of those whose voxels differ.

#include <cstdint>

#include "saccade/core/host_device.hpp"
#include "saccade/map/voxel_index.hpp"

namespace saccade::internal::cuda {

/// Content of a brick in 32 bits: unknown; constant free with a weight; or a slot of the pools and whether one of its
/// voxels is unknown or occupied.
struct BrickEntry {
  std::uint32_t bits;

  static constexpr std::uint32_t kStops{1};     ///< flag: a stored brick holds a voxel that is not empty
  static constexpr std::uint32_t kOccupied{2};  ///< flag: a stored brick holds an occupied voxel
  static constexpr std::uint32_t kStored{8};
  static constexpr int kSlotShift{4};
  static constexpr std::uint32_t kMostSlots{1U << 28U};

  [[nodiscard]] SACCADE_HD constexpr bool unknown() const { return bits == 0; }
  [[nodiscard]] SACCADE_HD constexpr bool stored() const { return (bits & kStored) != 0; }
  /// Weight of a constant-free brick; 0 of an unknown one.
  [[nodiscard]] SACCADE_HD constexpr std::uint32_t weight() const { return bits; }
  [[nodiscard]] SACCADE_HD constexpr std::uint32_t slot() const { return bits >> kSlotShift; }
  /// Tells whether every voxel is known and empty.
  [[nodiscard]] SACCADE_HD constexpr bool clear() const { return bits != 0 && !(stored() && (bits & kStops) != 0); }
  [[nodiscard]] static SACCADE_HD constexpr BrickEntry free(std::uint32_t weight) { return {weight}; }
  [[nodiscard]] static SACCADE_HD constexpr BrickEntry at(std::uint32_t slot, bool stops, bool occupied) {
    return {slot << kSlotShift | kStored | (stops ? kStops : 0U) | (occupied ? kOccupied : 0U)};
  }
};

/// Box of indices as a flat table, x fastest.
struct TableBox {
  Index3 lo{};
  std::uint32_t size_x{0};
  std::uint32_t size_y{0};
  std::uint32_t size_z{0};

  [[nodiscard]] SACCADE_HD constexpr std::uint64_t count() const { return std::uint64_t{size_x} * size_y * size_z; }
  [[nodiscard]] SACCADE_HD constexpr bool contains(const Index3& i) const {
    return static_cast<std::uint32_t>(i.x - lo.x) < size_x && static_cast<std::uint32_t>(i.y - lo.y) < size_y &&
           static_cast<std::uint32_t>(i.z - lo.z) < size_z;
  }
  [[nodiscard]] SACCADE_HD constexpr std::uint64_t at(const Index3& i) const {
    return (std::uint64_t{static_cast<std::uint32_t>(i.z - lo.z)} * size_y + static_cast<std::uint32_t>(i.y - lo.y)) *
               size_x +
           static_cast<std::uint32_t>(i.x - lo.x);
  }
  [[nodiscard]] SACCADE_HD constexpr Index3 index(std::uint64_t at) const {
    return {lo.x + static_cast<std::int32_t>(at % size_x), lo.y + static_cast<std::int32_t>(at / size_x % size_y),
            lo.z + static_cast<std::int32_t>(at / size_x / size_y)};
  }
};

constexpr int kBrickWords{8};       ///< 64-bit words of a mask of a brick's voxels
constexpr int kBlockLevel{5};       ///< blocks of 4³ bricks, which rays skip where all are clear
constexpr int kBlockBrickEdge{4};   ///< bricks along an edge of a block
constexpr int kSurfaceFree{32767};  ///< v of free space, kTsdfOne

/// The map in a device's memory. Bricks outside the table are unknown.
struct MapView {
  TableBox bricks;
  BrickEntry* entries{nullptr};
  std::uint8_t* touched{nullptr};    ///< whether kernels changed a brick since the host last read it
  std::int16_t* v{nullptr};          ///< kBrickVoxels of each slot
  std::uint16_t* w{nullptr};         ///< likewise
  std::uint64_t* unknown{nullptr};   ///< kBrickWords of each slot
  std::uint64_t* occupied{nullptr};  ///< likewise
  TableBox blocks;
  std::uint8_t* block_stops{nullptr};  ///< whether a block holds a voxel that is not empty

  [[nodiscard]] SACCADE_HD BrickEntry entry(const Index3& brick) const {
    return bricks.contains(brick) ? entries[bricks.at(brick)] : BrickEntry{};
  }
};

}  // namespace saccade::internal::cuda
