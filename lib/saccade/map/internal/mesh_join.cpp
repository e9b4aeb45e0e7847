// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/mesh_join.hpp"

#include <algorithm>
#include <unordered_map>

#include "saccade/map/internal/marching_cubes.hpp"

namespace saccade {
namespace {

const MeshSector* find_sector(std::span<const MeshSector> sectors, const Index3& key) {
  const auto at = std::lower_bound(sectors.begin(), sectors.end(), key,
                                   [](const MeshSector& s, const Index3& k) { return zyx_less(s.key, k); });
  return at == sectors.end() || !(at->key == key) ? nullptr : &*at;
}

/// Vertex of a sector.
struct VertexPlace {
  const MeshSector* sector;
  std::uint32_t rank;

  [[nodiscard]] const Eigen::Vector3f& position() const { return sector->vertices[rank]; }
  [[nodiscard]] const Eigen::Vector3f& normal() const { return sector->normals[rank]; }
};
using TrianglePlaces = std::array<VertexPlace, 3>;

VertexPlace vertex_on_edge(std::span<const MeshSector> sectors, const MeshSector& near, const Index3& cell,
                           std::uint8_t edge) {
  const CubeEdge& e = cube_edges()[edge];
  const Index3 voxel = cell + Index3{e.corner & 1, (e.corner >> 1) & 1, e.corner >> 2};
  const Index3 brick = parent(voxel);
  const MeshSector* sector = parent(brick) == near.key ? &near : find_sector(sectors, parent(brick));
  return {sector, sector->find(child_index(brick))->vertex_rank(child_index(voxel), e.axis)};
}

/// Calls body(places of the three vertices) for the triangles of a brick, in order.
template <class Body>
void for_each_triangle(std::span<const MeshSector> sectors, const MeshSector& sector, const MeshBrick& brick,
                       const Body& body) {
  const Index3 origin = (sector.key * kSectorEdge + child_offset(brick.child)) * kBrickEdge;
  for (std::uint32_t i = 0; i < brick.cell_count; ++i) {
    const MeshCell& cell = sector.cells[brick.first_cell + i];
    const Index3 voxel = origin + child_offset(cell.voxel);
    for (const auto& edges : cube_cases()[cell.inside].triangles()) {
      body(TrianglePlaces{vertex_on_edge(sectors, sector, voxel, edges[0]),
                          vertex_on_edge(sectors, sector, voxel, edges[1]),
                          vertex_on_edge(sectors, sector, voxel, edges[2])});
    }
  }
}

bool is_missing(const Eigen::Vector3f& normal) { return normal.isZero(0.0F); }

/// Returns the triangle's normal with the length of twice its area.
Eigen::Vector3f area_normal(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  return (b - a).cross(c - a);
}

Eigen::Vector3f mean_normal(const Eigen::Vector3f& sum) {
  return is_missing(sum) ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f{sum.stableNormalized()};
}

void finish_normals(TriangleMesh& mesh) {
  std::vector<bool> missing(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) missing[i] = is_missing(mesh.normals[i]);
  if (std::find(missing.begin(), missing.end(), true) == missing.end()) return;
  for (const auto& t : mesh.triangles) {
    if (!(missing[t[0]] || missing[t[1]] || missing[t[2]])) continue;
    const Eigen::Vector3f normal = area_normal(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    for (const std::uint32_t i : t) {
      if (missing[i]) mesh.normals[i] += normal;
    }
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (missing[i]) mesh.normals[i] = mean_normal(mesh.normals[i]);
  }
}

/// First vertex and triangle of a sector in the whole mesh.
struct Offsets {
  std::size_t vertex{0};
  std::size_t triangle{0};
};

/// Vertices of a brick's mesh, found by sector and index.
class PieceVertices {
 public:
  explicit PieceVertices(TriangleMesh& mesh) : mesh_{mesh} {}

  std::uint32_t add(const VertexPlace& place) {
    const auto [at, added] = index_of_.try_emplace(key(place), static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) {
      mesh_.vertices.push_back(place.position());
      mesh_.normals.push_back(place.normal());
      mesh_.colors.push_back(place.sector->colors[place.rank]);
    }
    return at->second;
  }
  [[nodiscard]] std::optional<std::uint32_t> find(const VertexPlace& place) const {
    const auto at = index_of_.find(key(place));
    return at == index_of_.end() ? std::nullopt : std::optional{at->second};
  }

 private:
  /// Returns the vertex's address as its unique key.
  static const Eigen::Vector3f* key(const VertexPlace& place) { return &place.position(); }
  TriangleMesh& mesh_;
  std::unordered_map<const Eigen::Vector3f*, std::uint32_t> index_of_;
};

/// Returns a brick and its neighbours in the order of the whole mesh.
std::array<Index3, 27> bricks_around(const Index3& brick) {
  std::array<Index3, 27> bricks;
  for (int i = 0; i < 27; ++i) {
    bricks[static_cast<std::size_t>(i)] = brick + Index3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
  }
  std::sort(bricks.begin(), bricks.end(), [](const Index3& a, const Index3& b) {
    return parent(a) == parent(b) ? child_index(a) < child_index(b) : zyx_less(parent(a), parent(b));
  });
  return bricks;
}

/// Works as finish_normals, with the triangles of all cells that touch the brick's, in the order of the whole mesh.
void finish_normals(std::span<const MeshSector> sectors, const Index3& brick, const PieceVertices& vertices,
                    TriangleMesh& mesh) {
  const std::vector<Eigen::Vector3f> given = mesh.normals;
  if (std::none_of(given.begin(), given.end(), is_missing)) return;
  for (const Index3& near : bricks_around(brick)) {
    const MeshSector* sector = find_sector(sectors, parent(near));
    const MeshBrick* owner = sector == nullptr ? nullptr : sector->find(child_index(near));
    if (owner == nullptr) continue;
    for_each_triangle(sectors, *sector, *owner, [&](const TrianglePlaces& t) {
      for (const VertexPlace& place : t) {
        if (!is_missing(place.normal())) continue;
        const auto i = vertices.find(place);
        if (i) mesh.normals[*i] += area_normal(t[0].position(), t[1].position(), t[2].position());
      }
    });
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (is_missing(given[i])) mesh.normals[i] = mean_normal(mesh.normals[i]);
  }
}

}  // namespace

TriangleMesh join_mesh(std::span<const MeshSector> sectors, const Executor& executor) {
  std::vector<Offsets> offsets;
  Offsets total;
  bool colored{false};
  for (const MeshSector& sector : sectors) {
    offsets.push_back(total);
    total.vertex += sector.vertices.size();
    for (const MeshBrick& brick : sector.bricks) {
      total.triangle += brick.triangle_count;
      colored = colored || brick.colored > 0;
    }
  }
  TriangleMesh mesh;
  mesh.vertices.resize(total.vertex);
  mesh.normals.resize(total.vertex);
  if (colored) mesh.colors.resize(total.vertex);
  mesh.triangles.resize(total.triangle);
  const auto index_of = [&](const VertexPlace& place) {
    const auto sector = static_cast<std::size_t>(place.sector - sectors.data());
    return static_cast<std::uint32_t>(offsets[sector].vertex) + place.rank;
  };
  executor.parallel_for(sectors.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const MeshSector& sector = sectors[s];
      const auto first = static_cast<std::ptrdiff_t>(offsets[s].vertex);
      std::copy(sector.vertices.begin(), sector.vertices.end(), mesh.vertices.begin() + first);
      std::copy(sector.normals.begin(), sector.normals.end(), mesh.normals.begin() + first);
      if (colored) std::copy(sector.colors.begin(), sector.colors.end(), mesh.colors.begin() + first);
      std::size_t next = offsets[s].triangle;
      for (const MeshBrick& brick : sector.bricks) {
        for_each_triangle(sectors, sector, brick, [&](const TrianglePlaces& t) {
          mesh.triangles[next++] = {index_of(t[0]), index_of(t[1]), index_of(t[2])};
        });
      }
    }
  });
  finish_normals(mesh);
  return mesh;
}

TriangleMesh mesh_of_brick(std::span<const MeshSector> sectors, const Index3& brick) {
  TriangleMesh mesh;
  const MeshSector* sector = find_sector(sectors, parent(brick));
  const MeshBrick* owner = sector == nullptr ? nullptr : sector->find(child_index(brick));
  if (owner == nullptr) return mesh;
  PieceVertices vertices{mesh};
  mesh.triangles.reserve(owner->triangle_count);
  for_each_triangle(sectors, *sector, *owner, [&](const TrianglePlaces& t) {
    const std::uint32_t a = vertices.add(t[0]);
    const std::uint32_t b = vertices.add(t[1]);
    const std::uint32_t c = vertices.add(t[2]);
    mesh.triangles.push_back({a, b, c});
  });
  finish_normals(sectors, brick, vertices, mesh);
  return mesh;
}

}  // namespace saccade
