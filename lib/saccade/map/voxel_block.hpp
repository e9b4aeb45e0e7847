// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelBlock: a brick and the voxels around it, unpacked, so that neighbours are a stride apart.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// v of a brick's voxels -1 … 9 along each axis, and whether they are known. About 4 KiB; meant to be reused.
class VoxelBlock {
 public:
  static constexpr int kFirst{-1};
  static constexpr int kEdge{kBrickEdge + 3};
  static constexpr std::int16_t kUnknown{-32768};  ///< v itself stays within ±32767

  /// Reads the block around `brick`. Voxels observed fewer than min_weight (≥ 1) times count as unknown.
  void load(const SectorTable& table, const Index3& brick, std::uint16_t min_weight) {
    constexpr int kEnd{kFirst + kEdge};
    load(table, brick, min_weight, {{kFirst, kFirst, kFirst}, {kEnd, kEnd, kEnd}});
  }
  /// Reads the voxels of a box, and some beside them along x; leaves others unchanged.
  void load(const SectorTable& table, const Index3& brick, std::uint16_t min_weight, const IndexBox& voxels) {
    const auto first = [](int lo) { return lo < 0 ? -1 : 0; };
    const auto last = [](int hi) { return hi > kBrickEdge ? 1 : 0; };
    for (int z = first(voxels.lo.z); z <= last(voxels.hi.z); ++z) {
      for (int y = first(voxels.lo.y); y <= last(voxels.hi.y); ++y) {
        for (int x = first(voxels.lo.x); x <= last(voxels.hi.x); ++x) {
          const Index3 key = brick + Index3{x, y, z};
          const Sector* sector = table.find(parent(key));
          const BrickRef unknown;
          const BrickRef& ref =
              sector == nullptr ? unknown : sector->bricks[static_cast<std::size_t>(child_index(key))];
          copy(ref, {x * kBrickEdge, y * kBrickEdge, z * kBrickEdge}, min_weight, voxels);
        }
      }
    }
  }

  /// Returns v. Requires a known voxel.
  [[nodiscard]] std::int16_t v(const Index3& i) const { return values_[at(i.x, i.y, i.z)]; }
  [[nodiscard]] bool known(const Index3& i) const { return v(i) != kUnknown; }

  /// Returns the values row by row, x fastest, kEdge voxels each; kUnknown where unknown.
  [[nodiscard]] const std::int16_t* data() const { return values_.data(); }

  /// Returns the row's voxels along x, from -1 on.
  [[nodiscard]] const std::int16_t* row(int y, int z) const { return &values_[at(kFirst, y, z)]; }

  /// Returns a mask: bit c is set when corner c of the cell with the lower corner (x, y, z) is inside. -1 when a corner
  /// is unknown.
  [[nodiscard]] int cell_signs(int x, int y, int z) const {
    const std::int16_t* p = &values_[at(x, y, z)];
    int inside{0};
    for (int c = 0; c < 8; ++c) {
      const std::int16_t value = p[(c & 1) + ((c >> 1) & 1) * kEdge + (c >> 2) * kEdge * kEdge];
      if (value == kUnknown) return -1;
      inside |= (value <= 0 ? 1 : 0) << c;
    }
    return inside;
  }

  /// Returns the central differences of v per voxel, one-sided next to an unknown voxel; nullopt when an axis has no
  /// neighbour.
  [[nodiscard]] std::optional<Eigen::Vector3d> gradient(const Index3& i) const {
    Eigen::Vector3d g;
    const double here = v(i);
    for (int axis = 0; axis < 3; ++axis) {
      const Index3 step{axis == 0, axis == 1, axis == 2};
      const bool has_lower = known(i - step);
      const bool has_upper = known(i + step);
      if (!has_lower && !has_upper) return std::nullopt;
      const double lower = has_lower ? v(i - step) : here;
      const double upper = has_upper ? v(i + step) : here;
      g[axis] = (upper - lower) / (has_lower && has_upper ? 2.0 : 1.0);
    }
    return g;
  }

 private:
  static constexpr std::size_t at(int x, int y, int z) {
    return static_cast<std::size_t>(((z - kFirst) * kEdge + (y - kFirst)) * kEdge + (x - kFirst));
  }

  void copy(const BrickRef& brick, const Index3& origin, std::uint16_t min_weight, const IndexBox& voxels) {
    switch (origin.x) {  // along x a neighbouring brick contributes its last voxel, the brick itself all, the next one
                         // its first two
      case -kBrickEdge: return copy_rows<1>(brick, origin, min_weight, voxels);
      case 0: return copy_rows<kBrickEdge>(brick, origin, min_weight, voxels);
      default: return copy_rows<2>(brick, origin, min_weight, voxels);
    }
  }

  /// For each value of a byte, a mask per set bit with all bits of the value set: which of 8 neighbours are known.
  using RowMask = std::array<std::uint64_t, 2>;
  static constexpr std::array<RowMask, 256> kRowMasks = [] {
    std::array<RowMask, 256> masks{};
    for (std::size_t known = 0; known < masks.size(); ++known) {
      for (std::size_t i = 0; i < kBrickEdge; ++i) {
        if (((known >> i) & 1U) != 0) masks[known][i / 4] |= std::uint64_t{0xFFFF} << (16 * (i % 4));
      }
    }
    return masks;
  }();
  static_assert(std::endian::native == std::endian::little, "values of a row are taken four at a time");

  /// Copies a row of values; bit i of `known` tells whether value i is known.
  template <std::size_t kCount>
  static void copy_row(const std::int16_t* values, std::uint8_t known, std::int16_t* row) {
    if constexpr (kCount == kBrickEdge) {
      constexpr std::uint64_t kAllUnknown{0x8000800080008000};
      static_assert(kUnknown == static_cast<std::int16_t>(0x8000));
      std::array<std::uint64_t, 2> words;
      std::memcpy(words.data(), values, sizeof(words));
      const RowMask& mask = kRowMasks[known];
      for (std::size_t i = 0; i < 2; ++i) words[i] = (words[i] & mask[i]) | (kAllUnknown & ~mask[i]);
      std::memcpy(row, words.data(), sizeof(words));
    } else {
      for (std::size_t i = 0; i < kCount; ++i) row[i] = ((known >> i) & 1U) != 0 ? values[i] : kUnknown;
    }
  }

  template <std::size_t kCount>
  void copy_rows(const BrickRef& brick, const Index3& origin, std::uint16_t min_weight, const IndexBox& voxels) {
    const auto range = [](int start, int lo, int hi) {
      return std::pair{std::max(start, lo), std::min(start + kBrickEdge, hi)};
    };
    const int x0 = std::max(origin.x, kFirst);
    const auto [y0, y1] = range(origin.y, voxels.lo.y, voxels.hi.y);
    const auto [z0, z1] = range(origin.z, voxels.lo.z, voxels.hi.z);
    const DenseBrick* dense = brick.dense();
    const FreeBrick* free = dense == nullptr ? brick.free() : nullptr;
    const bool constant_known = dense == nullptr && free == nullptr && brick.constant_weight() >= min_weight;
    constexpr std::array<std::int16_t, 8> kOnes{kTsdfOne, kTsdfOne, kTsdfOne, kTsdfOne,
                                                kTsdfOne, kTsdfOne, kTsdfOne, kTsdfOne};
    const std::int16_t* values = dense != nullptr ? dense->v.data() : kOnes.data();
    const int step = dense != nullptr ? 1 : 0;
    for (int z = z0; z < z1; ++z) {
      std::int16_t* row = &values_[at(x0, y0, z)];
      const auto slice = static_cast<std::size_t>(z & 7);
      std::uint64_t known = constant_known ? ~std::uint64_t{0} : 0;
      if (dense != nullptr) known = dense->weight_at_least(slice, min_weight);
      if (free != nullptr) known = free->weight_at_least(slice, min_weight);
      int first = child_index({x0, y0, z});
      for (int y = y0; y < y1; ++y, row += kEdge, first += kBrickEdge) {
        copy_row<kCount>(values + first * step, static_cast<std::uint8_t>(known >> (first & 63)), row);
      }
    }
  }

  std::array<std::int16_t, std::size_t{kEdge} * kEdge * kEdge> values_{};
};

}  // namespace saccade
