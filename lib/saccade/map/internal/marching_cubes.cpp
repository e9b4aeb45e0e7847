// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/marching_cubes.hpp"

namespace saccade {
namespace {

using Loop = std::array<std::uint8_t, kCubeEdgeCount>;
constexpr std::uint8_t kNoEdge{255};

constexpr std::array<CubeEdge, kCubeEdgeCount> make_edges() {
  std::array<CubeEdge, kCubeEdgeCount> edges{};
  std::size_t n{0};
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    for (std::uint8_t corner = 0; corner < 8; ++corner) {
      if (((corner >> axis) & 1) == 0) edges[n++] = {corner, axis};
    }
  }
  return edges;
}
constexpr std::array<CubeEdge, kCubeEdgeCount> kEdges{make_edges()};

constexpr std::uint8_t edge_between(unsigned a, unsigned b) {
  const unsigned lower = a < b ? a : b;
  for (std::uint8_t e = 0; e < kCubeEdgeCount; ++e) {
    if (kEdges[e].corner == lower && ((a ^ b) >> kEdges[e].axis) == 1U) return e;
  }
  return kNoEdge;
}

/// Returns the four corners of a face, counter-clockwise seen from outside the cell.
constexpr std::array<unsigned, 4> face_corners(unsigned axis, unsigned side) {
  const unsigned u = 1U << ((axis + 1) % 3);
  const unsigned v = 1U << ((axis + 2) % 3);
  const unsigned base = side << axis;
  if (side == 1) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

/// Returns successor[e]: the crossed edge that follows e on its loop. Around a face, the edge where the inside is
/// entered is joined to the next one where it is left.
constexpr Loop successors(unsigned inside) {
  Loop successor{};
  successor.fill(kNoEdge);
  const auto is_inside = [inside](unsigned corner) { return ((inside >> corner) & 1U) != 0; };
  for (unsigned face = 0; face < 6; ++face) {
    const std::array<unsigned, 4> corners = face_corners(face / 2, face % 2);
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned from = corners[i];
      const unsigned to = corners[(i + 1) % 4];
      if (is_inside(from) || !is_inside(to)) continue;
      unsigned k = (i + 1) % 4;
      while (is_inside(corners[(k + 1) % 4])) k = (k + 1) % 4;
      successor[edge_between(from, to)] = edge_between(corners[k], corners[(k + 1) % 4]);
    }
  }
  return successor;
}

constexpr bool share_a_face(std::uint8_t a, std::uint8_t b) {
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    if (kEdges[a].axis == axis || kEdges[b].axis == axis) continue;
    if (((kEdges[a].corner ^ kEdges[b].corner) >> axis & 1) == 0) return true;
  }
  return false;
}

constexpr bool fan_stays_off_faces(const Loop& loop, std::size_t length, std::size_t apex) {
  for (std::size_t i = 2; i + 1 < length; ++i) {
    if (share_a_face(loop[apex], loop[(apex + i) % length])) return false;
  }
  return true;
}

constexpr void add_fan(const Loop& loop, std::size_t length, CubeCase& result) {
  std::size_t apex{0};
  while (apex + 1 < length && !fan_stays_off_faces(loop, length, apex)) ++apex;
  for (std::size_t i = 1; i + 1 < length; ++i) {
    result.corners_of[result.count++] = {loop[apex], loop[(apex + i) % length], loop[(apex + i + 1) % length]};
  }
}

constexpr CubeCase make_case(unsigned inside) {
  CubeCase result{};
  Loop successor = successors(inside);
  for (std::uint8_t start = 0; start < kCubeEdgeCount; ++start) {
    Loop loop{};
    std::size_t length{0};
    for (std::uint8_t e = start; successor[e] != kNoEdge;) {
      loop[length++] = e;
      const std::uint8_t next = successor[e];
      successor[e] = kNoEdge;
      e = next;
    }
    if (length > 0) add_fan(loop, length, result);
  }
  return result;
}

constexpr std::array<CubeCase, 256> make_cases() {
  std::array<CubeCase, 256> cases{};
  for (unsigned inside = 0; inside < 256; ++inside) cases[inside] = make_case(inside);
  return cases;
}

constexpr std::array<CubeCase, 256> kCases{make_cases()};

}  // namespace

const std::array<CubeEdge, kCubeEdgeCount>& cube_edges() { return kEdges; }

const std::array<CubeCase, 256>& cube_cases() { return kCases; }

}  // namespace saccade
