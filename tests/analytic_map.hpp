// SPDX-License-Identifier: Apache-2.0
#pragma once
// Maps written by hand from a signed distance, and the topology of a mesh, for tests.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "saccade/map/mesh.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade::test {

/// A map of the voxels in `box` with v = clamp(sdf / truncation) and weight 10 (the free weight where v = 1); `colored`
/// gives every dense brick the colour (200, 100, 50). sdf takes metres, positive outside.
template <class Sdf>
TsdfSnapshot map_of(const TsdfConfig& config, const IndexBox& box, const Sdf& sdf, bool colored = false) {
  TsdfSnapshot map;
  map.config = config;
  const Index3 lo = parent(box.lo);
  const Index3 hi = parent(box.hi + Index3{kBrickEdge - 1, kBrickEdge - 1, kBrickEdge - 1});
  for (int z = lo.z; z < hi.z; ++z) {
    for (int y = lo.y; y < hi.y; ++y) {
      for (int x = lo.x; x < hi.x; ++x) {
        const Index3 brick{x, y, z};
        BrickRef ref = BrickRef::make_dense();
        DenseBrick& dense = ref.writable_dense();
        for (int i = 0; i < kBrickVoxels; ++i) {
          const Index3 voxel = brick * kBrickEdge + child_offset(i);
          if (!box.contains(voxel)) continue;
          const double d = sdf(voxel_center(voxel, config.voxel_size_m)) / config.truncation_m();
          const auto k = static_cast<std::size_t>(i);
          dense.v[k] = static_cast<std::int16_t>(std::lround(std::clamp(d, -1.0, 1.0) * kTsdfOne));
          dense.w[k] = dense.v[k] == kTsdfOne ? config.free_weight : std::uint16_t{10};
        }
        if (colored) {
          dense.colors = std::make_unique<BrickColors>();
          for (std::size_t i = 0; i < kBrickVoxels; ++i) {
            if (dense.w[i] > 0) (*dense.colors)[i] = {200, 100, 50};
          }
        }
        dense.update_masks();
        ref.canonicalize(config.free_weight);
        Sector& sector = map.grid.writable(parent(brick));
        sector.bricks[static_cast<std::size_t>(child_index(brick))] = ref;
        sector.update_summary(child_index(brick), config.free_weight);
      }
    }
  }
  return map;
}

inline double sphere_sdf(const Eigen::Vector3d& p, const Eigen::Vector3d& center, double radius_m) {
  return (p - center).norm() - radius_m;
}

inline double box_sdf(const Eigen::Vector3d& p, const Eigen::Vector3d& center, const Eigen::Vector3d& half_m) {
  const Eigen::Vector3d q = (p - center).cwiseAbs() - half_m;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

struct MeshFacts {
  std::size_t open_edges{0};     ///< edges with one triangle
  std::size_t crowded_edges{0};  ///< directed edges used twice: non-manifold or inconsistently oriented
  std::size_t unused_vertices{0};
  std::size_t degenerate{0};  ///< triangles with a repeated index
  long euler{0};              ///< vertices − edges + triangles
  double area_m2{0.0};
  double volume_m3{0.0};  ///< signed: positive when triangles are counter-clockwise from outside
};

inline MeshFacts facts_of(const TriangleMesh& mesh) {
  MeshFacts facts;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  std::vector<bool> used(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) ++facts.degenerate;
    for (std::size_t i = 0; i < 3; ++i) {
      ++directed[{t[i], t[(i + 1) % 3]}];
      used[t[i]] = true;
    }
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    facts.area_m2 += (b - a).cross(c - a).norm() / 2.0;
    facts.volume_m3 += a.dot(b.cross(c)) / 6.0;
  }
  long edges{0};
  for (const auto& [edge, count] : directed) {
    if (count != 1) ++facts.crowded_edges;
    const bool paired = directed.count({edge.second, edge.first}) > 0;
    if (!paired) ++facts.open_edges;
    if (!paired || edge.first < edge.second) ++edges;
  }
  facts.unused_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  facts.euler = static_cast<long>(mesh.vertices.size()) - edges + static_cast<long>(mesh.triangles.size());
  return facts;
}

}  // namespace saccade::test
