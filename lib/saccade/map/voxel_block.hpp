// SPDX-License-Identifier: Apache-2.0
#pragma once
// VoxelBlock: a brick and the voxels around it, unpacked, so that neighbours are a stride away.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>

#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// v of the voxels -1 … 9 of a brick along each axis, and whether they are known. About 4 KiB; meant to be reused.
class VoxelBlock {
 public:
  static constexpr int kFirst{-1};
  static constexpr int kEdge{kBrickEdge + 3};
  static constexpr std::int16_t kUnknown{-32768};  ///< v itself stays within ±32767

  /// Reads the block around `brick`; voxels observed less than min_weight (≥ 1) times count as unknown.
  void load(const SectorTable& table, const Index3& brick, std::uint16_t min_weight) {
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const Index3 key = brick + Index3{x, y, z};
          const Sector* sector = table.find(parent(key));
          const BrickRef unknown;
          const BrickRef& ref =
              sector == nullptr ? unknown : sector->bricks[static_cast<std::size_t>(child_index(key))];
          copy(ref, {x * kBrickEdge, y * kBrickEdge, z * kBrickEdge}, min_weight);
        }
      }
    }
  }

  /// Only where known.
  [[nodiscard]] std::int16_t v(const Index3& i) const { return values_[at(i.x, i.y, i.z)]; }
  [[nodiscard]] bool known(const Index3& i) const { return v(i) != kUnknown; }

  /// Row by row, x fastest, kEdge voxels each; kUnknown where unknown.
  [[nodiscard]] const std::int16_t* data() const { return values_.data(); }

  /// The voxels from -1 on along x.
  [[nodiscard]] const std::int16_t* row(int y, int z) const { return &values_[at(kFirst, y, z)]; }

  /// Bit c set: corner c of the cell whose lower corner is (x, y, z) is inside. -1 when a corner is unknown.
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

  /// Central differences of v per voxel, one-sided next to an unknown voxel; nullopt when an axis has no neighbour.
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

  void copy(const BrickRef& brick, const Index3& origin, std::uint16_t min_weight) {
    switch (origin.x) {  // along x a brick gives the last of its voxels, all, or the first two
      case -kBrickEdge: return copy_rows<1>(brick, origin, min_weight);
      case 0: return copy_rows<kBrickEdge>(brick, origin, min_weight);
      default: return copy_rows<2>(brick, origin, min_weight);
    }
  }

  /// Bit i of `known`: whether value i is. Without branches, so that a row becomes vector code.
  template <std::size_t kCount>
  static void copy_row(const std::int16_t* values, std::uint16_t known, std::int16_t* row) {
    constexpr std::array<std::uint16_t, kBrickEdge> kBit{1, 2, 4, 8, 16, 32, 64, 128};
    std::array<std::int16_t, kCount> copied;
    std::copy_n(values, kCount, copied.begin());
    for (std::size_t i = 0; i < kCount; ++i) {
      const int hidden = (known & kBit[i]) == 0 ? -1 : 0;
      copied[i] = static_cast<std::int16_t>((copied[i] & ~hidden) | (kUnknown & hidden));
    }
    std::copy_n(copied.begin(), kCount, row);
  }

  template <std::size_t kCount>
  void copy_rows(const BrickRef& brick, const Index3& origin, std::uint16_t min_weight) {
    const auto range = [](int start) {
      return std::pair{std::max(start, kFirst), std::min(start + kBrickEdge, kFirst + kEdge)};
    };
    const int x0 = std::max(origin.x, kFirst);
    const auto [y0, y1] = range(origin.y);
    const auto [z0, z1] = range(origin.z);
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
        copy_row<kCount>(values + first * step, static_cast<std::uint16_t>(known >> (first & 63)), row);
      }
    }
  }

  std::array<std::int16_t, std::size_t{kEdge} * kEdge * kEdge> values_{};
};

}  // namespace saccade
