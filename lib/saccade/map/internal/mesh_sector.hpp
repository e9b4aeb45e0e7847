// SPDX-License-Identifier: Apache-2.0
#pragma once
// MeshSector: the surface of one sector, brick by brick. MeshExtraction: extracts it from the map. Used by LiveMesh.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "saccade/map/mesh.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/map/voxel_block.hpp"

namespace saccade {

/// Brick that owns vertices or crossed cells. A vertex lies on the edge from a voxel of the brick to that voxel's upper
/// neighbour.
struct MeshBrick {
  int child{0};                                ///< child index within the sector
  std::array<Mask512, 3> edges{};              ///< per axis: voxels whose edge carries a vertex
  std::array<std::uint32_t, 8> slice_first{};  ///< index within the sector of the first vertex of slice z
  std::uint32_t vertex_count{0};
  std::uint32_t colored{0};  ///< number of vertices that have a colour
  std::uint32_t first_cell{0};
  std::uint32_t cell_count{0};
  std::uint32_t triangle_count{0};

  [[nodiscard]] std::uint32_t first_vertex() const { return slice_first[0]; }
  /// Returns the index within the sector of the vertex on edge (voxel, axis): ordered by voxel, then axis.
  [[nodiscard]] std::uint32_t vertex_rank(int voxel, int axis) const;
};

/// Cell crossed by the surface: its lower corner in the brick, and a bit for each inside corner.
struct MeshCell {
  std::uint16_t voxel;
  std::uint8_t inside;
};

/// Surface of one sector. It depends only on the bricks of the sector and those that touch them.
struct MeshSector {
  Index3 key;
  std::vector<MeshBrick> bricks;
  std::array<std::int16_t, kSectorBricks> slot{};  ///< index of each brick in `bricks`, or kNoSlot
  std::vector<MeshCell> cells;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;  ///< zero where the gradient is unknown
  std::vector<Rgb8> colors;              ///< grey where unknown

  static constexpr std::int16_t kNoSlot{-1};
  /// Returns nullptr for a brick that owns nothing.
  [[nodiscard]] const MeshBrick* find(int child) const {
    const std::int16_t at = slot[static_cast<std::size_t>(child)];
    return at == kNoSlot ? nullptr : &bricks[static_cast<std::size_t>(at)];
  }
};

/// Extraction of surfaces. Borrows the map, which must not be written meanwhile.
class MeshExtraction {
 public:
  MeshExtraction(const TsdfSnapshot& map, const MeshConfig& config);

  struct Extracted {
    MeshSector sector;
    std::size_t bricks{0};  ///< bricks whose cells were visited
  };
  /// Extracts the sector's surface: the bricks in `stale` from the map, the others from `previous` (nullptr: none).
  /// Different sectors may be extracted from different threads.
  [[nodiscard]] Extracted extract(const Index3& key, const Mask512& stale, const MeshSector* previous) const;

 private:
  [[nodiscard]] const BrickRef* find(const Index3& brick) const;
  [[nodiscard]] bool may_own_vertices(const Index3& brick) const;
  void extract_brick(const VoxelBlock& block, int child, MeshSector& sector) const;
  void add_vertices(const VoxelBlock& block, const Index3& brick, MeshBrick& owner, MeshSector& sector) const;
  void add_vertex(const VoxelBlock& block, const Index3& brick, const Index3& lower, int axis, MeshBrick& owner,
                  MeshSector& sector) const;
  [[nodiscard]] std::optional<Rgb8> color(const Index3& voxel) const;

  double voxel_size_m_;
  SectorTable table_;
  std::uint16_t min_weight_;
};

}  // namespace saccade
