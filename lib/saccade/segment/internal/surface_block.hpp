// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceBlock: 8³ voxels of the surface of a map, and the parts of supervoxels in them. SurfaceBlocks: all blocks,
// with their neighbours. Used by LiveSegments.

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "saccade/map/brick.hpp"
#include "saccade/segment/lccp.hpp"

namespace saccade {

/// Voxel of the surface, and name of the supervoxel whose seed it is: slot of the block · 512 + child_index.
using VoxelName = std::uint32_t;

/// Block of points, voxels and labels in z-y-x order of voxels.
struct SurfaceBlock {
  /// Part of a supervoxel in this block.
  struct SupervoxelPart {
    VoxelName supervoxel{0};
    std::uint32_t voxels{0};
    std::uint32_t points{0};
    Eigen::Matrix<double, 9, 1> sum;  ///< sum of positions, normals and colours
    [[nodiscard]] bool operator==(const SupervoxelPart&) const = default;
  };
  /// Supervoxel whose seed lies in this block.
  struct OwnedSupervoxel {
    VoxelName name{0};
    Supervoxel supervoxel;
  };
  /// Edge from one of `own` to a later supervoxel.
  struct Edge {
    std::uint32_t from{0};  ///< index in `own`
    VoxelName to{0};
    bool convex{false};
  };

  Index3 key;  ///< block coordinates
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> colors;  ///< empty where no point has a colour
  std::vector<std::uint16_t> voxel_of;  ///< per point: index in `voxels`
  Mask512 mask;                         ///< positions of the voxels
  std::vector<CloudVoxel> voxels;

  std::vector<VoxelName> labels;  ///< per voxel
  std::vector<SupervoxelPart> parts;
  std::vector<std::pair<VoxelName, VoxelName>> touching;  ///< a label in this block, and an adjacent one; sorted
  std::vector<OwnedSupervoxel> own;                       ///< by name
  std::vector<Edge> edges;                                ///< sorted by supervoxel, then by the position of the other

  [[nodiscard]] bool same_surface(const SurfaceBlock& other) const {
    return positions_m == other.positions_m && normals == other.normals && colors == other.colors &&
           voxel_of == other.voxel_of && mask == other.mask;
  }
};

/// Blocks by slot and by key. Slots of removed blocks are reused.
class SurfaceBlocks {
 public:
  static constexpr std::uint32_t kNone{~std::uint32_t{0}};
  using Around = std::array<std::uint32_t, 27>;  ///< slots, z slowest, the block itself in the middle; kNone: no block

  [[nodiscard]] SurfaceBlock& operator[](std::uint32_t slot) { return blocks_[slot]; }
  [[nodiscard]] const SurfaceBlock& operator[](std::uint32_t slot) const { return blocks_[slot]; }
  [[nodiscard]] const Around& around(std::uint32_t slot) const { return around_[slot]; }
  /// Returns a number larger than any slot.
  [[nodiscard]] std::size_t slots() const { return blocks_.size(); }
  [[nodiscard]] std::uint32_t find(const Index3& key) const {
    const auto found = slot_of_.find(key);
    return found == slot_of_.end() ? kNone : found->second;
  }
  /// Inserts a block and returns its slot.
  std::uint32_t insert(SurfaceBlock&& block);
  void erase(std::uint32_t slot);
  /// Returns these blocks and those connected through up to `rings` neighbours, sorted by slot.
  [[nodiscard]] std::vector<std::uint32_t> with_rings(std::span<const std::uint32_t> slots, int rings) const;

  /// Tells whether block a precedes block b, independent of their slots.
  [[nodiscard]] bool block_before(std::uint32_t a, std::uint32_t b) const {
    return zyx_less(blocks_[a].key, blocks_[b].key);
  }
  /// Tells whether voxel a precedes voxel b: by block and then within it.
  [[nodiscard]] bool before(VoxelName a, VoxelName b) const {
    const Index3& key_a = blocks_[a / kBrickVoxels].key;
    const Index3& key_b = blocks_[b / kBrickVoxels].key;
    return key_a == key_b ? a < b : zyx_less(key_a, key_b);
  }

 private:
  std::vector<SurfaceBlock> blocks_;
  std::vector<Around> around_;
  std::vector<std::uint32_t> free_slots_;
  std::unordered_map<Index3, std::uint32_t, Index3Hash> slot_of_;
};

/// Returns the voxels of a block that touch its neighbour n, numbered as in SurfaceBlocks::Around.
[[nodiscard]] const Mask512& border_towards(std::size_t n);

/// Values of all voxels of a block and of those around it, so that neighbours are a stride apart.
class PaddedBlock {
 public:
  static constexpr int kEdge{kBrickEdge + 2};
  static constexpr std::uint32_t kNothing{~std::uint32_t{0}};

  /// Loads value(slot, position of the voxel in its block).
  template <class Value>
  void load(const SurfaceBlocks& blocks, std::uint32_t slot, const Value& value) {
    values_.fill(kNothing);
    const SurfaceBlocks::Around& around = blocks.around(slot);
    for (std::size_t n = 0; n < around.size(); ++n) {
      if (around[n] == SurfaceBlocks::kNone) continue;
      const auto i = static_cast<int>(n);
      const int first = index(Index3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1} * kBrickEdge);
      const Mask512& mask = blocks[around[n]].mask;
      const Mask512& border = border_towards(n);
      int before{0};
      for (int z = 0; z < kBrickEdge; ++z) {
        const std::uint64_t word = mask.words[static_cast<std::size_t>(z)];
        for (std::uint64_t rest = word & border.words[static_cast<std::size_t>(z)]; rest != 0; rest &= rest - 1) {
          const int bit = std::countr_zero(rest);
          const int position = before + std::popcount(word & ((std::uint64_t{1} << bit) - 1));
          values_[static_cast<std::size_t>(first + (z * kEdge + (bit >> 3)) * kEdge + (bit & 7))] =
              value(around[n], static_cast<std::size_t>(position));
        }
        before += std::popcount(word);
      }
    }
  }

  struct Neighbours {
    std::array<std::uint32_t, 27> values;
    std::size_t count{0};
    [[nodiscard]] const std::uint32_t* begin() const { return values.data(); }
    [[nodiscard]] const std::uint32_t* end() const { return values.data() + count; }
  };
  /// Reads the voxel's neighbours, z slowest.
  void read_neighbours(std::size_t child, Neighbours& to) const {
    const std::uint32_t* here = &values_[static_cast<std::size_t>(index(child_offset(static_cast<int>(child))))];
    to.count = 0;
    for (const int dz : {-kEdge * kEdge, 0, kEdge * kEdge}) {
      for (const int dy : {-kEdge, 0, kEdge}) {
        for (const int dx : {-1, 0, 1}) {
          const int step = dz + dy + dx;
          if (step == 0) continue;
          to.values[to.count] = here[step];
          to.count += here[step] != kNothing ? 1 : 0;
        }
      }
    }
  }

 private:
  static constexpr int index(const Index3& i) { return ((i.z + 1) * kEdge + i.y + 1) * kEdge + i.x + 1; }
  std::array<std::uint32_t, std::size_t{kEdge} * kEdge * kEdge> values_;
};

}  // namespace saccade
