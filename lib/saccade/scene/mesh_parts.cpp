// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/mesh_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "saccade/cloud/disjoint_sets.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using Ids = std::vector<std::uint32_t>;

constexpr double kHoles{1e-3};  // share of the area that the holes of a closed part may have
constexpr double kFlat{1e-6};   // a volume this small, relative to area and size, is rounding
constexpr std::uint32_t kOpen = std::numeric_limits<std::uint32_t>::max();

struct Parts {
  Ids of_triangle;        ///< number of the closed part; kOpen where it is not closed
  std::uint32_t count{};  ///< closed parts
};

Vector3d position(const TriangleMesh& mesh, std::uint32_t vertex) { return mesh.vertices[vertex].cast<double>(); }

/// Returns twice the triangle's area, along its normal.
Vector3d area_vector(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Vector3d a = position(mesh, triangle[0]);
  return (position(mesh, triangle[1]) - a).cross(position(mesh, triangle[2]) - a);
}

/// Returns for each vertex the first one at its position.
Ids welded(const TriangleMesh& mesh) {
  const auto key = [&](std::uint32_t i) {
    const Eigen::Vector3f& p = mesh.vertices[i];
    return std::tuple{p.x(), p.y(), p.z()};
  };
  Ids order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(a), std::tuple{a}) < std::tuple_cat(key(b), std::tuple{b});
  });
  Ids first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool joins = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = joins ? first[order[i - 1]] : order[i];
  }
  return first;
}

struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  int uses;  ///< from low to high, less those from high to low
};

/// Returns the edges that are used more often one way than the other.
std::vector<Edge> border_edges(const TriangleMesh& mesh, const Ids& triangles, const Ids& vertex) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = vertex[mesh.triangles[t][i]];
      const std::uint32_t b = vertex[mesh.triangles[t][(i + 1) % 3]];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair{a.low, a.high} < std::pair{b.low, b.high};
  });
  std::vector<Edge> border;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    Edge sum{edges[begin].low, edges[begin].high, 0};
    for (; end < edges.size() && edges[end].low == sum.low && edges[end].high == sum.high; ++end) {
      sum.uses += edges[end].uses;
    }
    if (sum.uses != 0) border.push_back(sum);
  }
  return border;
}

/// Numbers the parts without holes among the triangles that have no number yet.
/// @param vertex       by vertex: the one that stands for it
/// @param small_holes  false: a part with any border is open. The border of a tube with a seam encloses no area.
void add_closed(const TriangleMesh& mesh, const Ids& vertex, bool small_holes, Parts& parts) {
  Ids rest;
  DisjointSets sets{mesh.vertices.size()};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (parts.of_triangle[t] != kOpen) continue;
    rest.push_back(t);
    const auto& [a, b, c] = mesh.triangles[t];
    sets.join(vertex[a], vertex[b]);
    sets.join(vertex[a], vertex[c]);
  }
  std::vector<double> area(mesh.vertices.size());   // by the vertex that names a part; twice as large
  std::vector<double> holes(mesh.vertices.size());  // likewise
  for (const std::uint32_t t : rest) {
    area[sets.root(vertex[mesh.triangles[t][0]])] += area_vector(mesh, mesh.triangles[t]).norm();
  }
  const std::vector<Edge> border = border_edges(mesh, rest, vertex);
  if (small_holes) {
    DisjointSets loops{mesh.vertices.size()};
    for (const Edge& edge : border) loops.join(edge.low, edge.high);
    std::vector<Vector3d> enclosed(mesh.vertices.size(), Vector3d::Zero());
    for (const Edge& edge : border) {
      const std::uint32_t loop = loops.root(edge.low);
      const Vector3d origin = position(mesh, loop);
      enclosed[loop] += edge.uses * (position(mesh, edge.low) - origin).cross(position(mesh, edge.high) - origin);
    }
    for (std::uint32_t i = 0; i < enclosed.size(); ++i) holes[sets.root(i)] += enclosed[i].norm();
  } else {
    for (const Edge& edge : border) holes[sets.root(edge.low)] = std::numeric_limits<double>::infinity();
  }
  Ids number(mesh.vertices.size(), kOpen);
  for (const std::uint32_t t : rest) {
    const std::uint32_t part = sets.root(vertex[mesh.triangles[t][0]]);
    if (!(area[part] > 0.0) || holes[part] > kHoles * area[part]) continue;
    if (number[part] == kOpen) number[part] = parts.count++;
    parts.of_triangle[t] = number[part];
  }
}

/// Numbers the closed parts. Bodies that touch share positions but, in most files, no vertices: these are looked at
/// first.
Parts closed_parts(const TriangleMesh& mesh) {
  Parts parts{Ids(mesh.triangles.size(), kOpen), 0};
  Ids own(mesh.vertices.size());
  std::iota(own.begin(), own.end(), 0U);
  add_closed(mesh, own, false, parts);
  const auto is_open = [](std::uint32_t part) { return part == kOpen; };
  if (std::none_of(parts.of_triangle.begin(), parts.of_triangle.end(), is_open)) return parts;
  add_closed(mesh, welded(mesh), true, parts);
  return parts;
}

/// Closed part, and what its orientation is known by.
struct ClosedPart {
  Ids triangles;
  Eigen::AlignedBox3d bounds;
  std::array<Vector3d, 6> ends;  ///< its lowest and highest vertex along each axis
  double area{0.0};              ///< twice as large
  double volume{0.0};            ///< six times as large; negative where it is inside out
};

ClosedPart closed_part(const TriangleMesh& mesh, Ids triangles) {
  ClosedPart body;
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t i : mesh.triangles[t]) {
      const Vector3d p = position(mesh, i);
      for (int axis = 0; axis < 3; ++axis) {
        const auto low = static_cast<std::size_t>(2 * axis);
        if (body.bounds.isEmpty() || p[axis] < body.ends[low][axis]) body.ends[low] = p;
        if (body.bounds.isEmpty() || p[axis] > body.ends[low + 1][axis]) body.ends[low + 1] = p;
      }
      body.bounds.extend(p);
    }
  }
  const Vector3d middle = body.bounds.center();
  for (const std::uint32_t t : triangles) {
    const Vector3d area = area_vector(mesh, mesh.triangles[t]);
    body.area += area.norm();
    body.volume += (position(mesh, mesh.triangles[t][0]) - middle).dot(area);
  }
  body.triangles = std::move(triangles);
  return body;
}

/// Tells whether p lies inside, by the solid angle under which the body is seen: 4π, or 0 outside. Unlike a ray it has
/// no edges to meet.
bool contains(const TriangleMesh& mesh, const ClosedPart& body, const Vector3d& p) {
  double half_angle{0.0};
  for (const std::uint32_t t : body.triangles) {
    const Vector3d a = position(mesh, mesh.triangles[t][0]) - p;
    const Vector3d b = position(mesh, mesh.triangles[t][1]) - p;
    const Vector3d c = position(mesh, mesh.triangles[t][2]) - p;
    half_angle += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                    b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return std::abs(half_angle) > EIGEN_PI;
}

bool contains(const TriangleMesh& mesh, const ClosedPart& outer, const ClosedPart& inner) {
  const bool fits = (inner.bounds.min().array() > outer.bounds.min().array()).all() &&
                    (inner.bounds.max().array() < outer.bounds.max().array()).all();
  return fits &&
         std::all_of(inner.ends.begin(), inner.ends.end(), [&](const Vector3d& p) { return contains(mesh, outer, p); });
}

bool is_inside_out(const ClosedPart& body) { return body.volume < -kFlat * body.area * body.bounds.diagonal().norm(); }

/// Returns the triangles of each closed part, or of all of them together where there are too many.
std::vector<Ids> triangles_of(const Parts& parts) {
  const bool apart = parts.count <= kMostMeshBodies;
  std::vector<Ids> triangles(apart ? parts.count : 1);
  for (std::uint32_t t = 0; t < parts.of_triangle.size(); ++t) {
    if (parts.of_triangle[t] != kOpen) triangles[apart ? parts.of_triangle[t] : 0].push_back(t);
  }
  return triangles;
}

/// Returns the mesh that these triangles make, with the vertices that they have.
TriangleMesh part_of(const TriangleMesh& mesh, const Ids& triangles) {
  TriangleMesh part;
  Ids moved(mesh.vertices.size(), kOpen);
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t i : mesh.triangles[t]) moved[i] = 0;
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (moved[i] == kOpen) continue;
    moved[i] = static_cast<std::uint32_t>(part.vertices.size());
    part.vertices.push_back(mesh.vertices[i]);
    if (!mesh.colors.empty()) part.colors.push_back(mesh.colors[i]);
  }
  for (const std::uint32_t t : triangles) {
    const auto& [a, b, c] = mesh.triangles[t];
    part.triangles.push_back({moved[a], moved[b], moved[c]});
  }
  return part;
}

}  // namespace

void turn_outside_out(TriangleMesh& mesh) {
  std::vector<ClosedPart> bodies;
  for (Ids& triangles : triangles_of(closed_parts(mesh))) bodies.push_back(closed_part(mesh, std::move(triangles)));
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const ClosedPart& a, const ClosedPart& b) { return std::abs(a.volume) > std::abs(b.volume); });
  std::vector<bool> turned;  // before any is turned, so that a part can be looked for in a larger one
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    std::optional<std::size_t> around;  // the smallest
    for (std::size_t larger = i; larger-- > 0 && !around;) {
      if (contains(mesh, bodies[larger], bodies[i])) around = larger;
    }
    turned.push_back(around ? turned[*around] : is_inside_out(bodies[i]));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!turned[i]) continue;
    for (const std::uint32_t t : bodies[i].triangles) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
}

std::vector<TriangleMesh> bodies_of(TriangleMesh mesh) {
  mesh.normals.clear();
  const Parts parts = closed_parts(mesh);
  Ids open;
  for (std::uint32_t t = 0; t < parts.of_triangle.size(); ++t) {
    if (parts.of_triangle[t] == kOpen) open.push_back(t);
  }
  std::vector<TriangleMesh> bodies;
  if (parts.count > kMostMeshBodies || parts.count + (open.empty() ? 0U : 1U) < 2U) {
    bodies.push_back(std::move(mesh));
    return bodies;
  }
  for (const Ids& triangles : triangles_of(parts)) bodies.push_back(part_of(mesh, triangles));
  if (!open.empty()) bodies.push_back(part_of(mesh, open));
  return bodies;
}

}  // namespace saccade
