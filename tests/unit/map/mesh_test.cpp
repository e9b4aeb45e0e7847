// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/mesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <utility>

#include "analytic_map.hpp"
#include "saccade/map/internal/marching_cubes.hpp"
#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

using test::facts_of;
using test::map_of;
using test::MeshFacts;

using Segment = std::pair<int, int>;

bool crossed(unsigned inside, const CubeEdge& e) {
  return ((inside >> e.corner) & 1U) != ((inside >> (e.corner | (1U << e.axis))) & 1U);
}

bool on_face(const CubeEdge& e, int axis, int side) { return e.axis != axis && ((e.corner >> axis) & 1) == side; }

/// Edges of the case's triangles that no other triangle of the case shares: the outline that neighbours must continue.
std::set<Segment> outline(const CubeCase& cube) {
  std::set<Segment> open;
  for (const auto& t : cube.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Segment s{t[i], t[(i + 1) % 3]};
      if (open.erase({s.second, s.first}) > 0) continue;
      EXPECT_TRUE(open.insert(s).second) << "one direction used twice";
    }
  }
  return open;
}

TEST(CubeCases, UseExactlyTheCrossedEdgesAndCloseEveryLoop) {
  ASSERT_EQ(cube_cases().size(), 256U);
  for (unsigned inside = 0; inside < 256; ++inside) {
    const CubeCase& cube = cube_cases()[inside];
    std::set<int> used;
    for (const auto& t : cube.triangles()) used.insert(t.begin(), t.end());
    std::set<int> expected;
    for (int e = 0; e < 12; ++e) {
      if (crossed(inside, cube_edges()[static_cast<std::size_t>(e)])) expected.insert(e);
    }
    EXPECT_EQ(used, expected) << "case " << inside;
    std::array<int, 12> out{};
    std::array<int, 12> in{};
    for (const Segment& s : outline(cube)) {
      ++out[static_cast<std::size_t>(s.first)];
      ++in[static_cast<std::size_t>(s.second)];
    }
    for (std::size_t e = 0; e < 12; ++e) {
      EXPECT_EQ(out[e], expected.count(static_cast<int>(e)) != 0 ? 1 : 0) << "case " << inside << " edge " << e;
      EXPECT_EQ(in[e], out[e]) << "case " << inside << " edge " << e;
    }
  }
}

TEST(CubeCases, NeighboursAgreeOnTheFaceTheyShareWithOppositeDirections) {
  // For every pair of cells stacked along an axis: the outline of one on the shared face, moved to the other cell, is
  // the other's with every segment reversed. Grouping by the face's signs compares all 16 · 16 pairs per sign pattern.
  for (int axis = 0; axis < 3; ++axis) {
    std::map<unsigned, std::set<std::set<Segment>>> seen;  // face signs → outlines, in the upper cell's edge numbers
    std::size_t compared{0};
    for (unsigned inside = 0; inside < 256; ++inside) {
      for (int side = 0; side < 2; ++side) {
        unsigned signs{0};
        for (unsigned corner = 0; corner < 8; ++corner) {
          if (((corner >> axis) & 1U) != 0) continue;
          const unsigned here = side == 0 ? corner : corner | (1U << axis);
          signs |= ((inside >> here) & 1U) << corner;
        }
        std::set<Segment> segments;
        for (const Segment& s : outline(cube_cases()[inside])) {
          const CubeEdge a = cube_edges()[static_cast<std::size_t>(s.first)];
          const CubeEdge b = cube_edges()[static_cast<std::size_t>(s.second)];
          if (!on_face(a, axis, side) || !on_face(b, axis, side)) continue;
          const auto lowered = [&](const CubeEdge& e) {
            const int corner = e.corner & ~(1 << axis);
            for (int k = 0; k < 12; ++k) {
              const CubeEdge& other = cube_edges()[static_cast<std::size_t>(k)];
              if (other.axis == e.axis && other.corner == corner) return k;
            }
            return -1;
          };
          side == 0 ? segments.insert({lowered(a), lowered(b)}) : segments.insert({lowered(b), lowered(a)});
        }
        seen[signs].insert(segments);
        ++compared;
      }
    }
    EXPECT_EQ(compared, 512U);
    EXPECT_EQ(seen.size(), 16U);
    for (const auto& [signs, outlines] : seen) EXPECT_EQ(outlines.size(), 1U) << "axis " << axis << " face " << signs;
  }
}

TEST(CubeCases, SingleInsideCornerFacesAwayFromIt) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    const CubeCase& cube = cube_cases()[1U << corner];
    ASSERT_EQ(cube.count, 1);
    const auto middle = [&](std::uint8_t edge) {
      const CubeEdge e = cube_edges()[edge];
      Eigen::Vector3d p{double(e.corner & 1), double((e.corner >> 1) & 1), double(e.corner >> 2)};
      p[e.axis] += 0.5;
      return p;
    };
    const auto t = cube.triangles()[0];
    const Eigen::Vector3d normal = (middle(t[1]) - middle(t[0])).cross(middle(t[2]) - middle(t[0]));
    const Eigen::Vector3d at{double(corner & 1), double((corner >> 1) & 1), double(corner >> 2)};
    EXPECT_GT(normal.dot(middle(t[0]) - at), 0.0);
  }
}

TsdfConfig centimetre() {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  return config;
}

const IndexBox kBlock{{-30, -30, -30}, {30, 30, 30}};
const Eigen::Vector3d kCenter{0.013, -0.021, 0.004};

TsdfSnapshot sphere_map(bool colored = false) {
  return map_of(
      centimetre(), kBlock, [](const Eigen::Vector3d& p) { return test::sphere_sdf(p, kCenter, 0.2); }, colored);
}

TEST(Mesh, RandomSignsGiveAClosedManifoldSurface) {
  const unsigned seed{20240611};
  SCOPED_TRACE(seed);
  std::mt19937 random{seed};
  std::array<int, 256> met{};
  for (int round = 0; round < 8; ++round) {
    // Random values inside, outside at the border: every kind of cell, all loops closed.
    TsdfSnapshot map = map_of(centimetre(), {{0, 0, 0}, {24, 16, 16}}, [&](const Eigen::Vector3d& p) {
      const Index3 i = voxel_at(p, 0.01);
      if (!IndexBox{{1, 1, 1}, {23, 15, 15}}.contains(i)) return 1.0;
      return std::uniform_real_distribution{-0.04, 0.04}(random);
    });
    for (int z = 0; z < 15; ++z) {
      for (int y = 0; y < 15; ++y) {
        for (int x = 0; x < 23; ++x) {
          unsigned inside{0};
          for (int c = 0; c < 8; ++c) {
            const Voxel voxel = map.grid.voxel({x + (c & 1), y + ((c >> 1) & 1), z + (c >> 2)});
            inside |= (voxel.v <= 0 ? 1U : 0U) << c;
          }
          ++met[inside];
        }
      }
    }
    const MeshFacts facts = facts_of(extract_mesh(map, Executor{}));
    EXPECT_EQ(facts.open_edges, 0U);
    EXPECT_EQ(facts.crowded_edges, 0U);
    EXPECT_EQ(facts.unused_vertices, 0U);
    EXPECT_EQ(facts.degenerate, 0U);
  }
  EXPECT_EQ(std::count(met.begin(), met.end(), 0), 0) << "some sign patterns were never met";
}

TEST(Mesh, TrianglesAreThoseOfEveryCellWithKnownCorners) {
  const unsigned seed{7};
  SCOPED_TRACE(seed);
  std::mt19937 random{seed};
  using Corner = std::array<float, 3>;
  std::size_t compared{0};
  for (const double unknown : {0.02, 0.15, 0.3}) {
    TsdfSnapshot map = map_of(centimetre(), {{-16, -16, -16}, {16, 16, 16}}, [&](const Eigen::Vector3d&) {
      return std::uniform_real_distribution{-0.04, 0.04}(random);
    });
    for (int i = 0; i < 32 * 32 * 32; ++i) {
      if (std::uniform_real_distribution{0.0, 1.0}(random) >= unknown) continue;
      const Index3 voxel{i % 32 - 16, i / 32 % 32 - 16, i / 1024 - 16};
      Sector& sector = map.grid.writable(parent(parent(voxel)));
      DenseBrick& dense = sector.bricks[static_cast<std::size_t>(child_index(parent(voxel)))].writable_dense();
      dense.v[static_cast<std::size_t>(child_index(voxel))] = 0;
      dense.w[static_cast<std::size_t>(child_index(voxel))] = 0;
      dense.update_masks();
    }
    std::multiset<std::array<Corner, 3>> expected;
    for (int i = 0; i < 31 * 31 * 31; ++i) {
      const Index3 cell{i % 31 - 16, i / 31 % 31 - 16, i / 961 - 16};
      const auto corner = [&](int c) { return cell + Index3{c & 1, (c >> 1) & 1, c >> 2}; };
      unsigned inside{0};
      bool known{true};
      for (int c = 0; c < 8; ++c) {
        const Voxel voxel = map.grid.voxel(corner(c));
        known = known && voxel.w > 0;
        inside |= (voxel.v <= 0 ? 1U : 0U) << c;
      }
      if (!known) continue;
      for (const auto& edges : cube_cases()[inside].triangles()) {
        std::array<Corner, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
          const CubeEdge e = cube_edges()[edges[k]];
          const double v0 = map.grid.voxel(corner(e.corner)).v;
          const double v1 = map.grid.voxel(corner(e.corner | (1 << e.axis))).v;
          Eigen::Vector3d p = voxel_center(corner(e.corner), 0.01);
          p[e.axis] += v0 / (v0 - v1) * 0.01;
          triangle[k] = {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
        }
        expected.insert(triangle);
      }
    }
    const TriangleMesh mesh = extract_mesh(map, Executor{});
    std::multiset<std::array<Corner, 3>> actual;
    for (const auto& t : mesh.triangles) {
      std::array<Corner, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3f& p = mesh.vertices[t[k]];
        triangle[k] = {p.x(), p.y(), p.z()};
      }
      actual.insert(triangle);
    }
    EXPECT_TRUE(actual == expected) << unknown << " of the voxels unknown";
    EXPECT_EQ(facts_of(mesh).unused_vertices, 0U);
    compared += expected.size();
  }
  EXPECT_GT(compared, 50000U);
}

TEST(Mesh, NormalsPointOutwardsAndAreUnit) {
  const TriangleMesh mesh = extract_mesh(sphere_map(), Executor{});
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  ASSERT_GT(mesh.vertices.size(), 5000U);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d outward = (mesh.vertices[i].cast<double>() - kCenter).normalized();
    EXPECT_NEAR(mesh.normals[i].norm(), 1.0F, 1e-5F);
    EXPECT_GT(mesh.normals[i].cast<double>().dot(outward), 0.995);
  }
}

TEST(Mesh, HasColorsOnlyWhereTheMapHas) {
  EXPECT_TRUE(extract_mesh(sphere_map(), Executor{}).colors.empty());
  TsdfSnapshot map = sphere_map(true);
  TriangleMesh mesh = extract_mesh(map, Executor{});
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  for (const Rgb8& color : mesh.colors) ASSERT_EQ(color, (Rgb8{200, 100, 50}));

  // Colours gone from one octant: its vertices are grey, the others keep theirs.
  Sector& octant = map.grid.writable({0, 0, 0});
  for (BrickRef& brick : octant.bricks) {
    if (brick.dense() != nullptr) brick.writable_dense().colors->fill({});
  }
  mesh = extract_mesh(map, Executor{});
  std::size_t grey{0};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const bool inside_octant = mesh.vertices[i].minCoeff() > 0.011F;
    if (inside_octant) {
      ASSERT_EQ(mesh.colors[i], (Rgb8{128, 128, 128}));
    }
    grey += mesh.colors[i] == Rgb8{128, 128, 128} ? 1 : 0;
  }
  EXPECT_GT(grey, mesh.vertices.size() / 16);
  EXPECT_LT(grey, mesh.vertices.size() / 4);
}

TEST(Mesh, UnknownCornersLeaveHoles) {
  TsdfSnapshot map = sphere_map();
  const std::size_t whole = extract_mesh(map, Executor{}).triangles.size();
  // One voxel next to the surface forgotten: exactly the cells around it go.
  const Index3 hole = voxel_at(kCenter + Eigen::Vector3d{0.2, 0.0, 0.0}, 0.01);
  Sector& sector = map.grid.writable(parent(parent(hole)));
  DenseBrick& dense = sector.bricks[static_cast<std::size_t>(child_index(parent(hole)))].writable_dense();
  dense.v[static_cast<std::size_t>(child_index(hole))] = 0;
  dense.w[static_cast<std::size_t>(child_index(hole))] = 0;
  dense.update_masks();
  const TriangleMesh mesh = extract_mesh(map, Executor{});
  const MeshFacts facts = facts_of(mesh);
  EXPECT_LT(mesh.triangles.size(), whole);
  EXPECT_GE(mesh.triangles.size() + 40, whole);
  EXPECT_GT(facts.open_edges, 3U);
  EXPECT_EQ(facts.euler, 1) << "a sphere with one hole";
  EXPECT_EQ(facts.unused_vertices, 0U);
  EXPECT_EQ(facts.crowded_edges, 0U);
  const Eigen::Vector3d at = voxel_center(hole, 0.01);
  for (const auto& v : mesh.vertices) EXPECT_GT((v.cast<double>() - at).norm(), 1e-6);
}

TEST(Mesh, WeightsBelowTheMinimumCountAsUnknown) {
  TsdfSnapshot map = sphere_map();
  EXPECT_TRUE(extract_mesh(map, Executor{}, {.min_weight = 11}).triangles.empty());
  EXPECT_EQ(extract_mesh(map, Executor{}, {.min_weight = 5}).triangles.size(),
            extract_mesh(map, Executor{}).triangles.size());
}

TEST(Mesh, EmptyMapGivesAnEmptyMesh) {
  const TriangleMesh mesh = extract_mesh(TsdfSnapshot{}, Executor{});
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(Mesh, SameForEveryThreadCount) {
  const TsdfSnapshot map = sphere_map(true);
  const TriangleMesh reference = extract_mesh(map, Executor{});
  for (const std::size_t threads : {2U, 3U, 8U}) {
    for (const auto backend : {test::kParallelBackend, Executor::Backend::std_thread}) {
      const TriangleMesh mesh = extract_mesh(map, Executor::with_threads(threads, backend));
      EXPECT_EQ(mesh.vertices, reference.vertices);
      EXPECT_EQ(mesh.normals, reference.normals);
      EXPECT_EQ(mesh.colors, reference.colors);
      EXPECT_EQ(mesh.triangles, reference.triangles);
    }
  }
}

}  // namespace
}  // namespace saccade
