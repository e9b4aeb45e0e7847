// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/mesh.hpp"

#include <algorithm>
#include <bit>

#include "saccade/map/marching_cubes.hpp"
#include "saccade/map/voxel_block.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kNoColor{128, 128, 128};
constexpr std::int16_t kInactive{-1};

/// A brick that owns vertices or crossed cells. A vertex lies on the edge from a voxel of the brick to that voxel's
/// upper neighbour.
struct MeshBrick {
  int child{0};                                ///< within the sector
  std::array<Mask512, 3> edges{};              ///< by axis: voxels whose edge carries a vertex
  std::array<std::uint32_t, 8> slice_first{};  ///< index within the sector of the first vertex of slice z
  std::size_t first_cell{0};
  std::size_t cell_count{0};
};

struct MeshCell {
  std::uint16_t voxel;
  std::uint8_t inside;
};

struct MeshSector {
  Index3 key;
  std::vector<MeshBrick> bricks;
  std::array<std::int16_t, kSectorBricks> slot{};
  std::vector<MeshCell> cells;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;  ///< zero where the gradient is not known
  std::vector<Rgb8> colors;
  std::size_t colored{0};
  std::size_t first_vertex{0};  ///< in the mesh
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Index within the sector of the vertex on edge (voxel, axis): order by voxel, then axis.
std::uint32_t vertex_rank(const MeshBrick& brick, int voxel, int axis) {
  const auto slice = static_cast<std::size_t>(voxel >> 6);
  const std::uint64_t bit = std::uint64_t{1} << (voxel & 63);
  std::uint32_t rank = brick.slice_first[slice];
  for (int a = 0; a < 3; ++a) {
    const std::uint64_t before = a < axis ? (bit << 1) - 1 : bit - 1;
    rank += static_cast<std::uint32_t>(std::popcount(brick.edges[static_cast<std::size_t>(a)].words[slice] & before));
  }
  return rank;
}

class Extraction {
 public:
  Extraction(const TsdfSnapshot& map, const MeshConfig& config)
      : voxel_size_m_{map.config.voxel_size_m},
        table_{map.grid},
        min_weight_{std::max<std::uint16_t>(config.min_weight, 1)} {
    for (const Index3& key : map.grid.sorted_sectors()) sectors_.emplace_back().key = key;
  }

  TriangleMesh run(const Executor& executor) {
    executor.parallel_for(sectors_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) find_vertices(sectors_[s]);
    });
    std::size_t vertex_count{0};
    for (MeshSector& sector : sectors_) {
      sector.first_vertex = vertex_count;
      vertex_count += sector.vertices.size();
    }
    executor.parallel_for(sectors_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) find_triangles(sectors_[s]);
    });
    TriangleMesh mesh = join();
    finish_normals(mesh);
    return mesh;
  }

 private:
  const BrickRef* find(const Index3& brick) const {
    const Sector* sector = table_.find(parent(brick));
    return sector == nullptr ? nullptr : &sector->bricks[static_cast<std::size_t>(child_index(brick))];
  }

  /// Only a brick that has an inside voxel in itself or in an upper neighbour can own a vertex.
  bool may_own_vertices(const Index3& brick) const {
    const BrickRef* self = find(brick);
    if (self == nullptr || self->is_unknown()) return false;
    for (int i = 0; i < 8; ++i) {
      const BrickRef* other = find(brick + Index3{i & 1, (i >> 1) & 1, i >> 2});
      if (other != nullptr && other->dense() != nullptr && other->dense()->occupied.any()) return true;
    }
    return false;
  }

  void find_vertices(MeshSector& sector) const {
    sector.slot.fill(kInactive);
    VoxelBlock block;
    for (int child = 0; child < kSectorBricks; ++child) {
      const Index3 brick = sector.key * kSectorEdge + child_offset(child);
      if (!may_own_vertices(brick)) continue;
      block.load(table_, brick, min_weight_);
      MeshBrick owner;
      owner.child = child;
      owner.first_cell = sector.cells.size();
      mark_cells(block, owner, sector);
      owner.cell_count = sector.cells.size() - owner.first_cell;
      if (owner.cell_count == 0 && (owner.edges[0] | owner.edges[1] | owner.edges[2]).none()) continue;
      sector.slot[static_cast<std::size_t>(child)] = static_cast<std::int16_t>(sector.bricks.size());
      add_vertices(block, brick, owner, sector);
      sector.bricks.push_back(owner);
    }
  }

  /// Goes through the cells whose lower corner is -1 … 7: all that touch an edge the brick owns. Notes the crossed ones
  /// and marks the owned edges they use.
  static void mark_cells(const VoxelBlock& block, MeshBrick& owner, MeshSector& sector) {
    for (int z = -1; z < kBrickEdge; ++z) {
      for (int y = -1; y < kBrickEdge; ++y) {
        for (int x = -1; x < kBrickEdge; ++x) {
          const int inside = block.cell_signs(x, y, z);
          if (inside <= 0 || inside == 255) continue;
          if (x >= 0 && y >= 0 && z >= 0) {
            sector.cells.push_back(
                {static_cast<std::uint16_t>(child_index({x, y, z})), static_cast<std::uint8_t>(inside)});
          }
          mark_edges({x, y, z}, static_cast<unsigned>(inside), owner);
        }
      }
    }
  }

  static void mark_edges(const Index3& cell, unsigned inside, MeshBrick& owner) {
    constexpr IndexBox kOwned{{0, 0, 0}, {kBrickEdge, kBrickEdge, kBrickEdge}};
    for (const CubeEdge& edge : cube_edges()) {
      const unsigned upper = edge.corner | (1U << edge.axis);
      if (((inside >> edge.corner) & 1U) == ((inside >> upper) & 1U)) continue;
      const Index3 voxel = cell + Index3{edge.corner & 1, (edge.corner >> 1) & 1, edge.corner >> 2};
      if (kOwned.contains(voxel)) owner.edges[edge.axis].set(child_index(voxel));
    }
  }

  void add_vertices(const VoxelBlock& block, const Index3& brick, MeshBrick& owner, MeshSector& sector) const {
    for (int voxel = 0; voxel < kBrickVoxels; ++voxel) {
      if ((voxel & 63) == 0) {
        owner.slice_first[static_cast<std::size_t>(voxel >> 6)] = static_cast<std::uint32_t>(sector.vertices.size());
      }
      for (int axis = 0; axis < 3; ++axis) {
        if (owner.edges[static_cast<std::size_t>(axis)].test(voxel)) {
          add_vertex(block, brick, child_offset(voxel), axis, sector);
        }
      }
    }
  }

  void add_vertex(const VoxelBlock& block, const Index3& brick, const Index3& lower, int axis,
                  MeshSector& sector) const {
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
    sector.colored += c0 || c1 ? 1 : 0;
    sector.colors.push_back(c0 && c1 ? blend(*c0, *c1, t) : c0 ? *c0 : c1 ? *c1 : kNoColor);
  }

  std::optional<Rgb8> color(const Index3& voxel) const {
    const BrickRef* brick = find(parent(voxel));
    const DenseBrick* dense = brick == nullptr ? nullptr : brick->dense();
    if (dense == nullptr || dense->colors == nullptr) return std::nullopt;
    const Rgb8& color = (*dense->colors)[static_cast<std::size_t>(child_index(voxel))];
    if (color == Rgb8{}) return std::nullopt;  // black: none was fused
    return color;
  }

  static Rgb8 blend(const Rgb8& a, const Rgb8& b, double t) {
    Rgb8 mixed{};
    for (std::size_t i = 0; i < 3; ++i) mixed[i] = static_cast<std::uint8_t>((1.0 - t) * a[i] + t * b[i] + 0.5);
    return mixed;
  }

  void find_triangles(MeshSector& sector) const {
    for (const MeshBrick& brick : sector.bricks) {
      const Index3 origin = (sector.key * kSectorEdge + child_offset(brick.child)) * kBrickEdge;
      for (std::size_t i = 0; i < brick.cell_count; ++i) {
        const MeshCell& cell = sector.cells[brick.first_cell + i];
        const Index3 voxel = origin + child_offset(cell.voxel);
        for (const auto& corners : cube_cases()[cell.inside].triangles()) {
          sector.triangles.push_back(
              {vertex_index(voxel, corners[0]), vertex_index(voxel, corners[1]), vertex_index(voxel, corners[2])});
        }
      }
    }
  }

  std::uint32_t vertex_index(const Index3& cell, std::uint8_t edge) const {
    const CubeEdge& e = cube_edges()[edge];
    const Index3 voxel = cell + Index3{e.corner & 1, (e.corner >> 1) & 1, e.corner >> 2};
    const Index3 brick = parent(voxel);
    const MeshSector& sector = sector_of(parent(brick));
    const auto slot = static_cast<std::size_t>(sector.slot[static_cast<std::size_t>(child_index(brick))]);
    return static_cast<std::uint32_t>(sector.first_vertex) +
           vertex_rank(sector.bricks[slot], child_index(voxel), e.axis);
  }

  const MeshSector& sector_of(const Index3& key) const {
    return *std::lower_bound(sectors_.begin(), sectors_.end(), key,
                             [](const MeshSector& s, const Index3& k) { return zyx_less(s.key, k); });
  }

  TriangleMesh join() const {
    TriangleMesh mesh;
    bool colored{false};
    for (const MeshSector& s : sectors_) colored = colored || s.colored > 0;
    for (const MeshSector& s : sectors_) {
      mesh.vertices.insert(mesh.vertices.end(), s.vertices.begin(), s.vertices.end());
      mesh.normals.insert(mesh.normals.end(), s.normals.begin(), s.normals.end());
      if (colored) mesh.colors.insert(mesh.colors.end(), s.colors.begin(), s.colors.end());
      mesh.triangles.insert(mesh.triangles.end(), s.triangles.begin(), s.triangles.end());
    }
    return mesh;
  }

  /// Vertices without a gradient get the mean normal of their triangles, weighted by area.
  static void finish_normals(TriangleMesh& mesh) {
    std::vector<bool> missing(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) missing[i] = mesh.normals[i].isZero(0.0F);
    for (const auto& t : mesh.triangles) {
      if (!(missing[t[0]] || missing[t[1]] || missing[t[2]])) continue;
      const Eigen::Vector3f a = mesh.vertices[t[0]];
      const Eigen::Vector3f normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
      for (const std::uint32_t i : t) {
        if (missing[i]) mesh.normals[i] += normal;
      }
    }
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
      if (!missing[i]) continue;
      mesh.normals[i] = mesh.normals[i].isZero(0.0F) ? Eigen::Vector3f::UnitZ() : mesh.normals[i].stableNormalized();
    }
  }

  double voxel_size_m_;
  SectorTable table_;
  std::uint16_t min_weight_;
  std::vector<MeshSector> sectors_;
};

}  // namespace

TriangleMesh extract_mesh(const TsdfSnapshot& map, const Executor& executor, const MeshConfig& config) {
  return Extraction{map, config}.run(executor);
}

}  // namespace saccade
