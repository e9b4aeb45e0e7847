// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/find_walls.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace saccade {
namespace {

constexpr std::int32_t kWallTile{8};      // voxels
constexpr double kLeastOfTile{60.0};      // voxels
constexpr double kThin_vox{0.7};          // standard deviation across a tile's plane
constexpr double kBesideWall_vox{1.0};    // voxels within this distance of a plane belong to it
constexpr std::size_t kMaxWallSeeds{64};  // tiles to try planes from
constexpr double kEdge_vox{2.5};          // extent of a wall beyond the centres of its outermost voxels
constexpr double kMaxKnownBehind{0.05};   // share of the voxels behind a wall
constexpr double kBehindFrom_vox{6.0};    // fusion marks nearer voxels as occupied
constexpr double kBehindTo_vox{16.0};

/// Occupied voxel beside an empty one, counted within the volume.
struct Side {
  Eigen::Vector2f at;
  std::int32_t layer{0};
  Eigen::Vector2f out;  ///< direction towards empty voxels
};

/// Sides in a tile of columns, or their sum.
struct SideSum {
  double weight{0.0};
  Eigen::Vector2d sum{Eigen::Vector2d::Zero()};
  Eigen::Matrix2d squares{Eigen::Matrix2d::Zero()};
  Eigen::Vector2d out{Eigen::Vector2d::Zero()};

  void add(const Side& side) {
    const Eigen::Vector2d at = side.at.cast<double>();
    weight += 1.0;
    sum += at;
    squares += at * at.transpose();
    out += side.out.cast<double>();
  }
  void add(const SideSum& other) {
    weight += other.weight;
    sum += other.sum;
    squares += other.squares;
    out += other.out;
  }
  [[nodiscard]] Eigen::Vector2d mean() const { return sum / weight; }
};

/// Upright plane normal · (x, y) = offset, in voxels; the normal points to the empty side.
struct UprightPlane {
  Eigen::Vector2d normal{Eigen::Vector2d::UnitX()};
  double offset{0.0};
  double deviation{0.0};
  [[nodiscard]] double distance(const Eigen::Vector2d& at) const { return normal.dot(at) - offset; }
};

UprightPlane upright_plane(const SideSum& sides) {
  const Eigen::Vector2d mean = sides.mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver{sides.squares / sides.weight - mean * mean.transpose()};
  UprightPlane plane;
  plane.normal = solver.eigenvectors().col(0);
  if (plane.normal.dot(sides.out) < 0.0) plane.normal = -plane.normal;
  plane.offset = plane.normal.dot(mean);
  plane.deviation = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  return plane;
}

/// Returns the sides layer by layer, row by row.
std::vector<Side> sides_of(const StateVolume& volume, const Executor& executor) {
  const Index3 size = volume.box().size();
  std::vector<std::vector<Side>> found(static_cast<std::size_t>(size.z));
  executor.parallel_for(found.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) {
      for (std::int32_t y = 1; y + 1 < size.y; ++y) {
        const VoxelState* row = volume.data() + static_cast<std::ptrdiff_t>(z) * volume.layer() + y * volume.row();
        if (!any_occupied(row, static_cast<std::size_t>(size.x))) continue;
        for (std::int32_t x = 1; x + 1 < size.x; ++x) {
          if (row[x] != VoxelState::occupied) continue;
          const auto empty = [&](std::ptrdiff_t step) { return row[x + step] == VoxelState::empty ? 1.0F : 0.0F; };
          const Eigen::Vector2f out{empty(1) - empty(-1), empty(volume.row()) - empty(-volume.row())};
          if (out.squaredNorm() == 0.0F) continue;
          found[z].push_back({{static_cast<float>(x), static_cast<float>(y)}, static_cast<std::int32_t>(z), out});
        }
      }
    }
  });
  std::vector<Side> sides;
  for (const std::vector<Side>& some : found) sides.insert(sides.end(), some.begin(), some.end());
  return sides;
}

std::vector<SideSum> tiles_of(std::span<const Side> sides, std::int32_t width) {
  std::vector<SideSum> tiles;
  for (const Side& side : sides) {
    const auto row = static_cast<std::int32_t>(side.at.y()) / kWallTile * (width / kWallTile + 1);
    const auto tile = static_cast<std::size_t>(row + static_cast<std::int32_t>(side.at.x()) / kWallTile);
    if (tile >= tiles.size()) tiles.resize(tile + 1);
    tiles[tile].add(side);
  }
  std::erase_if(tiles, [](const SideSum& tile) {
    return tile.weight < kLeastOfTile || upright_plane(tile).deviation > kThin_vox;
  });
  return tiles;
}

/// Returns the plane supported by most tiles, nullopt without tiles.
std::optional<UprightPlane> best_upright_plane(std::span<const SideSum> tiles) {
  std::optional<UprightPlane> best;
  double most{0.0};
  const std::size_t stride = tiles.size() / kMaxWallSeeds + 1;
  for (std::size_t seed = 0; seed < tiles.size(); seed += stride) {
    UprightPlane plane = upright_plane(tiles[seed]);
    double weight{0.0};
    for (int round = 0; round < 4; ++round) {
      const double per_vox = round == 0 ? 0.05 : 0.0;  // the direction of one tile is accurate to a few degrees
      SideSum inliers;
      for (const SideSum& tile : tiles) {
        const double far_vox = (tile.mean() - tiles[seed].mean()).norm();
        if (tile.out.dot(plane.normal) <= 0.0) continue;
        if (std::abs(plane.distance(tile.mean())) <= kBesideWall_vox + per_vox * far_vox) inliers.add(tile);
      }
      weight = inliers.weight;
      if (weight == 0.0) break;
      plane = upright_plane(inliers);
    }
    if (weight <= most) continue;
    most = weight;
    best = plane;
  }
  return best;
}

bool is_beside(const UprightPlane& plane, const Side& side) {
  return std::abs(plane.distance(side.at.cast<double>())) <= kBesideWall_vox &&
         plane.normal.dot(side.out.cast<double>()) > 0.0;
}

Wall wall_of(const StateVolume& volume, const UprightPlane& plane, std::span<const Side> sides) {
  constexpr double kFar{std::numeric_limits<double>::infinity()};
  const double voxel_m = volume.voxel_size_m();
  const Index3 low = volume.box().lo;
  Wall wall;
  wall.normal = plane.normal;
  // The wall's surface lies half a voxel in front of the centres of its voxels.
  wall.offset_m = (plane.offset + plane.normal.dot(Eigen::Vector2d{low.x + 0.5, low.y + 0.5}) + 0.5) * voxel_m;
  wall.area_m2 = static_cast<double>(sides.size()) * voxel_m * voxel_m;
  wall.begin_m = wall.low_m = kFar;
  wall.end_m = wall.high_m = -kFar;
  for (const Side& side : sides) {
    const double along = wall.along_m((side.at.cast<double>() + Eigen::Vector2d{low.x + 0.5, low.y + 0.5}) * voxel_m);
    const double z = (low.z + side.layer) * voxel_m;
    wall.begin_m = std::min(wall.begin_m, along - kEdge_vox * voxel_m);
    wall.end_m = std::max(wall.end_m, along + kEdge_vox * voxel_m);
    wall.low_m = std::min(wall.low_m, z + (0.5 - kEdge_vox) * voxel_m);
    wall.high_m = std::max(wall.high_m, z + (0.5 + kEdge_vox) * voxel_m);
  }
  return wall;
}

/// Returns the known share of the voxels behind a wall and slightly around it.
double known_behind(const StateVolume& volume, const Wall& wall) {
  const double voxel_m = volume.voxel_size_m();
  const Eigen::Vector2d tangent{-wall.normal.y(), wall.normal.x()};
  std::size_t all{0};
  std::size_t known{0};
  const double around_m = 4.0 * voxel_m;
  for (double z = wall.low_m - around_m; z < wall.high_m + around_m; z += 2.0 * voxel_m) {
    for (double along = wall.begin_m - around_m; along < wall.end_m + around_m; along += 2.0 * voxel_m) {
      for (double depth = kBehindFrom_vox; depth < kBehindTo_vox; depth += 2.0) {
        const Eigen::Vector2d p = tangent * along + wall.normal * (wall.offset_m - depth * voxel_m);
        const Index3 voxel = voxel_at({p.x(), p.y(), z}, voxel_m);
        if (!volume.box().contains(voxel)) continue;
        ++all;
        if (volume[volume.index(voxel)] != VoxelState::unknown) ++known;
      }
    }
  }
  return all == 0 ? 0.0 : static_cast<double>(known) / static_cast<double>(all);
}

}  // namespace

std::vector<Wall> find_walls(const StateVolume& volume, double min_area_m2, const Executor& executor) {
  std::vector<Wall> walls;
  std::vector<Side> sides = sides_of(volume, executor);
  std::vector<SideSum> tiles = tiles_of(sides, static_cast<std::int32_t>(volume.row()));
  const double voxel_m = volume.voxel_size_m();
  while (const std::optional<UprightPlane> plane = best_upright_plane(tiles)) {
    std::vector<Side> of_plane;
    std::copy_if(sides.begin(), sides.end(), std::back_inserter(of_plane),
                 [&](const Side& side) { return is_beside(*plane, side); });
    if (static_cast<double>(of_plane.size()) * voxel_m * voxel_m < min_area_m2) break;
    std::erase_if(sides, [&](const Side& side) { return is_beside(*plane, side); });
    const std::size_t before = tiles.size();
    std::erase_if(tiles, [&](const SideSum& tile) {
      return tile.out.dot(plane->normal) > 0.0 && std::abs(plane->distance(tile.mean())) <= 1.5 * kBesideWall_vox;
    });
    const Wall wall = wall_of(volume, *plane, of_plane);
    if (known_behind(volume, wall) <= kMaxKnownBehind) walls.push_back(wall);
    if (tiles.size() == before) break;
  }
  std::stable_sort(walls.begin(), walls.end(), [](const Wall& a, const Wall& b) { return a.area_m2 > b.area_m2; });
  return walls;
}

}  // namespace saccade
