// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/mesh_sector.hpp"

#include <algorithm>
#include <bit>

#include "saccade/map/internal/marching_cubes.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kNoColor{128, 128, 128};

/// Cells and voxels around a brick as rows of bits: bit x + 1 of the row (y, z) stands for x in -1 … 8. Cells are named
/// by their lower corner, which lies at -1 … 7.
class CellRows {
 public:
  explicit CellRows(const VoxelBlock& block) {
    std::array<unsigned, kRows> known_voxels{};
    for (int z = -1; z <= kBrickEdge; ++z) {
      for (int y = -1; y <= kBrickEdge; ++y) {
        const std::int16_t* row = block.row(y, z);
        unsigned known{0};
        unsigned inside{0};
        for (int i = 0; i < kCorners; ++i) {
          known |= (row[i] != VoxelBlock::kUnknown ? 1U : 0U) << i;
          inside |= (row[i] <= 0 ? 1U : 0U) << i;
        }
        known_voxels[at(y, z)] = known;
        inside_[at(y, z)] = inside;
      }
    }
    for (int z = -1; z < kBrickEdge; ++z) {
      for (int y = -1; y < kBrickEdge; ++y) {
        const unsigned corners = known_voxels[at(y, z)] & known_voxels[at(y + 1, z)] & known_voxels[at(y, z + 1)] &
                                 known_voxels[at(y + 1, z + 1)];
        known_[at(y, z)] = corners & (corners >> 1);
      }
    }
  }

  /// Returns the cells with known corners, some of them inside and some not.
  [[nodiscard]] unsigned crossed(int y, int z) const {
    const std::array<unsigned, 4> rows{inside_[at(y, z)], inside_[at(y + 1, z)], inside_[at(y, z + 1)],
                                       inside_[at(y + 1, z + 1)]};
    const unsigned some = rows[0] | rows[1] | rows[2] | rows[3];
    const unsigned all = rows[0] & rows[1] & rows[2] & rows[3];
    return known_[at(y, z)] & (some | (some >> 1)) & ~(all & (all >> 1));
  }

  /// Returns the voxels whose edge along the axis the surface crosses in a cell with known corners; y and z in 0 … 7.
  [[nodiscard]] unsigned crossed_edges(int axis, int y, int z) const {
    const unsigned lower = inside_[at(y, z)];
    if (axis == 0) {
      return (lower ^ (lower >> 1)) &
             (known_[at(y, z)] | known_[at(y - 1, z)] | known_[at(y, z - 1)] | known_[at(y - 1, z - 1)]);
    }
    const unsigned upper = axis == 1 ? inside_[at(y + 1, z)] : inside_[at(y, z + 1)];
    const unsigned cells = known_[at(y, z)] | (axis == 1 ? known_[at(y, z - 1)] : known_[at(y - 1, z)]);
    return (lower ^ upper) & (cells | (cells << 1));
  }

 private:
  static constexpr int kCorners{kBrickEdge + 2};
  static constexpr std::size_t kRows{std::size_t{kCorners} * kCorners};
  static std::size_t at(int y, int z) { return static_cast<std::size_t>((z + 1) * kCorners + y + 1); }
  std::array<unsigned, kRows> inside_{};  ///< inside voxels, including unknown ones
  std::array<unsigned, kRows> known_{};   ///< cells whose corners are all known
};

/// Records the brick's crossed cells, and its edges that these or cells of lower neighbours use.
void mark_cells(const VoxelBlock& block, MeshBrick& owner, MeshSector& sector) {
  const CellRows rows{block};
  for (int z = 0; z < kBrickEdge; ++z) {
    for (int y = 0; y < kBrickEdge; ++y) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::uint64_t row = (rows.crossed_edges(axis, y, z) >> 1) & 0xFFU;
        owner.edges[static_cast<std::size_t>(axis)].words[static_cast<std::size_t>(z)] |= row << (8 * y);
      }
      for (unsigned rest = (rows.crossed(y, z) >> 1) & 0xFFU; rest != 0; rest &= rest - 1) {
        const Index3 cell{std::countr_zero(rest), y, z};
        const auto inside = static_cast<std::uint8_t>(block.cell_signs(cell.x, cell.y, cell.z));
        sector.cells.push_back({static_cast<std::uint16_t>(child_index(cell)), inside});
        owner.triangle_count += cube_cases()[inside].count;
      }
    }
  }
}

Rgb8 blend(const Rgb8& a, const Rgb8& b, double t) {
  Rgb8 mixed{};
  for (std::size_t i = 0; i < 3; ++i) mixed[i] = static_cast<std::uint8_t>((1.0 - t) * a[i] + t * b[i] + 0.5);
  return mixed;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, std::uint32_t first, std::uint32_t count) {
  to.insert(to.end(), from.begin() + first, from.begin() + first + count);
}

void append_brick(const MeshSector& from, const MeshBrick& brick, MeshSector& to) {
  MeshBrick copy = brick;
  const auto first_vertex = static_cast<std::uint32_t>(to.vertices.size());
  for (std::uint32_t& first : copy.slice_first) first = first - brick.first_vertex() + first_vertex;
  copy.first_cell = static_cast<std::uint32_t>(to.cells.size());
  append(to.cells, from.cells, brick.first_cell, brick.cell_count);
  append(to.vertices, from.vertices, brick.first_vertex(), brick.vertex_count);
  append(to.normals, from.normals, brick.first_vertex(), brick.vertex_count);
  append(to.colors, from.colors, brick.first_vertex(), brick.vertex_count);
  to.slot[static_cast<std::size_t>(brick.child)] = static_cast<std::int16_t>(to.bricks.size());
  to.bricks.push_back(copy);
}

}  // namespace

std::uint32_t MeshBrick::vertex_rank(int voxel, int axis) const {
  const auto slice = static_cast<std::size_t>(voxel >> 6);
  const std::uint64_t bit = std::uint64_t{1} << (voxel & 63);
  std::uint32_t rank = slice_first[slice];
  for (int a = 0; a < 3; ++a) {
    const std::uint64_t before = a < axis ? (bit << 1) - 1 : bit - 1;
    rank += static_cast<std::uint32_t>(std::popcount(edges[static_cast<std::size_t>(a)].words[slice] & before));
  }
  return rank;
}

MeshExtraction::MeshExtraction(const TsdfSnapshot& map, const MeshConfig& config)
    : voxel_size_m_{map.config.voxel_size_m},
      table_{map.grid},
      min_weight_{std::max<std::uint16_t>(config.min_weight, 1)} {}

MeshExtraction::Extracted MeshExtraction::extract(const Index3& key, const Mask512& stale,
                                                  const MeshSector* previous) const {
  Extracted result;
  MeshSector& sector = result.sector;
  sector.key = key;
  sector.slot.fill(MeshSector::kNoSlot);
  VoxelBlock block;
  for (int child = 0; child < kSectorBricks; ++child) {
    if (!stale.test(child)) {
      const MeshBrick* kept = previous != nullptr ? previous->find(child) : nullptr;
      if (kept != nullptr) append_brick(*previous, *kept, sector);
      continue;
    }
    const Index3 brick = key * kSectorEdge + child_offset(child);
    if (!may_own_vertices(brick)) continue;
    block.load(table_, brick, min_weight_);
    extract_brick(block, child, sector);
    ++result.bricks;
  }
  return result;
}

const BrickRef* MeshExtraction::find(const Index3& brick) const {
  const Sector* sector = table_.find(parent(brick));
  return sector == nullptr ? nullptr : &sector->bricks[static_cast<std::size_t>(child_index(brick))];
}

/// Tells whether a brick can own a vertex: only with an inside voxel in itself or in an upper neighbour.
bool MeshExtraction::may_own_vertices(const Index3& brick) const {
  const BrickRef* self = find(brick);
  if (self == nullptr || self->is_unknown()) return false;
  for (int i = 0; i < 8; ++i) {
    const BrickRef* other = find(brick + Index3{i & 1, (i >> 1) & 1, i >> 2});
    if (other != nullptr && other->dense() != nullptr && other->dense()->occupied.any()) return true;
  }
  return false;
}

void MeshExtraction::extract_brick(const VoxelBlock& block, int child, MeshSector& sector) const {
  MeshBrick owner;
  owner.child = child;
  owner.first_cell = static_cast<std::uint32_t>(sector.cells.size());
  mark_cells(block, owner, sector);
  owner.cell_count = static_cast<std::uint32_t>(sector.cells.size()) - owner.first_cell;
  if (owner.cell_count == 0 && (owner.edges[0] | owner.edges[1] | owner.edges[2]).none()) return;
  add_vertices(block, sector.key * kSectorEdge + child_offset(child), owner, sector);
  sector.slot[static_cast<std::size_t>(child)] = static_cast<std::int16_t>(sector.bricks.size());
  sector.bricks.push_back(owner);
}

void MeshExtraction::add_vertices(const VoxelBlock& block, const Index3& brick, MeshBrick& owner,
                                  MeshSector& sector) const {
  const std::size_t first = sector.vertices.size();
  for (int voxel = 0; voxel < kBrickVoxels; ++voxel) {
    if ((voxel & 63) == 0) {
      owner.slice_first[static_cast<std::size_t>(voxel >> 6)] = static_cast<std::uint32_t>(sector.vertices.size());
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (owner.edges[static_cast<std::size_t>(axis)].test(voxel)) {
        add_vertex(block, brick, child_offset(voxel), axis, owner, sector);
      }
    }
  }
  owner.vertex_count = static_cast<std::uint32_t>(sector.vertices.size() - first);
}

void MeshExtraction::add_vertex(const VoxelBlock& block, const Index3& brick, const Index3& lower, int axis,
                                MeshBrick& owner, MeshSector& sector) const {
  const Index3 step{axis == 0, axis == 1, axis == 2};
  const Index3 upper = lower + step;
  const double v0 = block.v(lower);
  const double v1 = block.v(upper);
  const double t = v0 / (v0 - v1);
  Eigen::Vector3d p_world = voxel_center(brick * kBrickEdge + lower, voxel_size_m_);
  p_world[axis] += t * voxel_size_m_;
  sector.vertices.push_back(p_world.cast<float>());

  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  const auto g0 = block.gradient(lower);
  const auto g1 = block.gradient(upper);
  if (g0 && g1) normal = ((1.0 - t) * *g0 + t * *g1).stableNormalized();
  sector.normals.push_back(normal.cast<float>());

  const std::optional<Rgb8> c0 = color(brick * kBrickEdge + lower);
  const std::optional<Rgb8> c1 = color(brick * kBrickEdge + upper);
  owner.colored += c0 || c1 ? 1 : 0;
  sector.colors.push_back(c0 && c1 ? blend(*c0, *c1, t) : c0 ? *c0 : c1 ? *c1 : kNoColor);
}

std::optional<Rgb8> MeshExtraction::color(const Index3& voxel) const {
  const BrickRef* brick = find(parent(voxel));
  const DenseBrick* dense = brick == nullptr ? nullptr : brick->dense();
  if (dense == nullptr || dense->colors == nullptr) return std::nullopt;
  const Rgb8& color = (*dense->colors)[static_cast<std::size_t>(child_index(voxel))];
  if (color == Rgb8{}) return std::nullopt;  // black: none was fused
  return color;
}

}  // namespace saccade
