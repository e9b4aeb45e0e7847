// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/entry_faces.hpp"

#include <array>

namespace saccade {
namespace {

constexpr std::int32_t kCellBricks{2};     // bricks along each axis whose faces form one group
constexpr std::size_t kFaceDirections{6};  // 2 · axis + forward

using Squares = std::array<std::vector<FaceSquare>, kFaceDirections>;

std::int32_t& component(Index3& index, std::size_t axis) { return axis == 0 ? index.x : axis == 1 ? index.y : index.z; }

Index3 unit(std::size_t axis) { return {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0}; }

Mask512 stops_of(const StopGrid& grid, const Index3& brick) {
  const StopGrid::Brick found = grid.brick(brick);
  if ((found.flags & stop_flags::kSolid) != 0) return Mask512::all_set();
  return found.flags == stop_flags::kClear ? Mask512{} : found.masks->stop;
}

/// Returns the voxels whose neighbour one step back along an axis does not stop rays.
Mask512 open_behind(const Mask512& stop, const Mask512& beside, std::size_t axis, bool forward) {
  constexpr std::uint64_t kColumn0{0x0101010101010101ULL};
  constexpr std::uint64_t kColumn7{kColumn0 << 7};
  Mask512 behind;  // per voxel: whether that neighbour stops rays
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    const std::uint64_t here = stop.words[z];
    const std::uint64_t other = beside.words[z];
    std::uint64_t& word = behind.words[z];
    if (axis == 0) {
      word = forward ? (here & ~kColumn7) << 1 | (other & kColumn7) >> 7
                     : (here & ~kColumn0) >> 1 | (other & kColumn0) << 7;
    } else if (axis == 1) {
      word = forward ? here << 8 | other >> 56 : here >> 8 | other << 56;
    } else if (forward) {
      word = z == 0 ? beside.words[kBrickEdge - 1] : stop.words[z - 1];
    } else {
      word = z == kBrickEdge - 1 ? beside.words[0] : stop.words[z + 1];
    }
  }
  return ~behind;
}

/// Splits the set bits of 8 × 8 faces (bit 8 · v + u) into aligned squares.
template <class Body>
void for_each_square(std::uint64_t faces, const Body& body) {
  for (int edge = kBrickEdge; edge >= 1 && faces != 0; edge /= 2) {
    const std::uint64_t row = (std::uint64_t{1} << edge) - 1;
    std::uint64_t square{0};
    for (int v = 0; v < edge; ++v) square |= row << (8 * v);
    for (int v = 0; v < kBrickEdge; v += edge) {
      for (int u = 0; u < kBrickEdge; u += edge) {
        const std::uint64_t here = square << (8 * v + u);
        if ((faces & here) != here) continue;
        faces &= ~here;
        body(u, v, edge);
      }
    }
  }
}

void add_squares(const Mask512& faces, const Index3& brick, std::size_t axis, bool forward,
                 std::vector<FaceSquare>& squares) {
  const std::size_t u_axis = axis == 0 ? 1 : 0;
  const std::size_t v_axis = axis == 2 ? 1 : 2;
  std::array<std::uint64_t, kBrickEdge> planes{};
  faces.for_each([&](std::size_t i) {
    Index3 voxel = child_offset(static_cast<int>(i));
    planes[static_cast<std::size_t>(component(voxel, axis))] |=
        std::uint64_t{1} << (component(voxel, u_axis) + kBrickEdge * component(voxel, v_axis));
  });
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    for_each_square(planes[plane], [&](int u, int v, int edge) {
      Index3 corner = brick * kBrickEdge;
      component(corner, axis) += static_cast<std::int32_t>(plane) + (forward ? 0 : 1);
      component(corner, u_axis) += u;
      component(corner, v_axis) += v;
      squares.push_back({corner, edge});
    });
  }
}

void add_brick(const StopGrid& grid, const Index3& brick, Squares& squares) {
  const StopGrid::Brick here = grid.brick(brick);
  if ((here.flags & stop_flags::kScores) == 0) return;
  const bool whole = here.flags == stop_flags::kAllScore;
  const Mask512 stop = whole ? Mask512::all_set() : here.masks->stop;
  const Mask512 score = whole ? Mask512::all_set() : here.masks->score;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool forward : {false, true}) {
      const Index3 back = unit(axis) * (forward ? -1 : 1);
      const Mask512 faces = score & open_behind(stop, stops_of(grid, brick + back), axis, forward);
      if (faces.any()) add_squares(faces, brick, axis, forward, squares[2 * axis + (forward ? 1 : 0)]);
    }
  }
}

Squares squares_of_cell(const StopGrid& grid, const Index3& first) {
  Squares squares;
  for (std::int32_t i = 0; i < kCellBricks * kCellBricks * kCellBricks; ++i) {
    add_brick(grid, first + Index3{i % kCellBricks, i / kCellBricks % kCellBricks, i / (kCellBricks * kCellBricks)},
              squares);
  }
  return squares;
}

}  // namespace

EntryFaces::EntryFaces(const StopGrid& grid, const Executor& executor) {
  const IndexBox& voxels = grid.scoring_voxels();
  if (voxels.empty()) return;
  const IndexBox bricks = parents(voxels);
  const Index3 size = bricks.size();
  const auto cells_along = [](std::int32_t n) { return (n + kCellBricks - 1) / kCellBricks; };
  const Index3 cells{cells_along(size.x), cells_along(size.y), cells_along(size.z)};
  const std::size_t slice = static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y);
  std::vector<Squares> found(slice * static_cast<std::size_t>(cells.z));
  executor.parallel_for(static_cast<std::size_t>(cells.z), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * slice; i < end * slice; ++i) {
      const Index3 cell{static_cast<std::int32_t>(i) % cells.x, static_cast<std::int32_t>(i) / cells.x % cells.y,
                        static_cast<std::int32_t>(i / slice)};
      found[i] = squares_of_cell(grid, bricks.lo + cell * kCellBricks);
    }
  });
  for (const Squares& of_cell : found) {
    for (std::size_t direction = 0; direction < kFaceDirections; ++direction) {
      if (of_cell[direction].empty()) continue;
      add_group(of_cell[direction], static_cast<int>(direction / 2), direction % 2 == 1);
    }
  }
}

void EntryFaces::add_group(const std::vector<FaceSquare>& squares, int axis, bool forward) {
  FaceGroup group{edges_vox_.size(), 0, axis, forward, squares.front().corner, squares.front().corner};
  const auto add = [this](const FaceSquare& square) {
    corners_[0].push_back(square.corner.x);
    corners_[1].push_back(square.corner.y);
    corners_[2].push_back(square.corner.z);
    edges_vox_.push_back(static_cast<float>(square.edge_vox));
  };
  for (const FaceSquare& square : squares) {
    add(square);
    Index3 high = square.corner + Index3{1, 1, 1} * square.edge_vox;
    component(high, static_cast<std::size_t>(axis)) -= square.edge_vox;
    group.lo = group.lo.cwise_min(square.corner);
    group.hi = group.hi.cwise_max(high);
  }
  while (edges_vox_.size() % kLanes != 0) add(squares.back());
  group.end = edges_vox_.size();
  groups_.push_back(group);
}

}  // namespace saccade
