// SPDX-License-Identifier: Apache-2.0
#pragma once
// CubeEdge, CubeCase and cube_cases(): the triangles of each of the 256 sign patterns of a cell, derived by rule.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade {

/// Corner c of a cell lies at offset (c & 1, c >> 1 & 1, c >> 2). Edge e joins `corner` to its neighbour along `axis`.
struct CubeEdge {
  std::uint8_t corner;
  std::uint8_t axis;
};
constexpr std::size_t kCubeEdgeCount{12};
/// Returns the edges by axis, then by corner.
[[nodiscard]] const std::array<CubeEdge, kCubeEdgeCount>& cube_edges();

/// Triangles over cell edges, counter-clockwise seen from outside the surface.
struct CubeCase {
  static constexpr std::size_t kMaxTriangles{5};
  std::array<std::array<std::uint8_t, 3>, kMaxTriangles> corners_of{};
  std::uint8_t count{0};
  [[nodiscard]] std::span<const std::array<std::uint8_t, 3>> triangles() const { return {corners_of.data(), count}; }
};

/// Returns the triangles of each sign pattern; bit c of the index is set when corner c is inside (v ≤ 0). After
/// Lorensen and Cline (1987), without their table. On every face of the cell the crossed edges are joined so that
/// inside corners stay apart. This rule reads the face's four signs alone, so two cells agree on their common face and
/// the surface has no holes. The segments close to loops. Each loop becomes a fan whose diagonals lie in no face, so
/// every edge of the mesh has exactly two triangles.
[[nodiscard]] const std::array<CubeCase, 256>& cube_cases();

}  // namespace saccade
