// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/surface_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/map/surface_cells.hpp"

namespace saccade {
namespace {

/// Slack of the conservative tests: far above the rounding of the floats, far below a voxel or a pixel.
constexpr float kTileSlackM{1e-4F};
constexpr float kSlackPx{0.1F};
/// Smallest distance from the camera's plane for projection; nearer bricks are on the list of every tile.
constexpr float kNearestZ{0.02F};

/// A brick's rectangle of blocks, and its nearest depth.
struct Footprint {
  SurfaceTiles::Brick brick;
  std::int16_t u0, v0, u1, v1;  // blocks, inclusive
  float nearest_m;
};

/// Projector of bricks; one per frame.
class BrickProjector {
 public:
  BrickProjector(const PinholeCamera& camera, const Pose& T_world_camera, double voxel_size_m)
      : camera_{camera},
        T_camera_world_{T_world_camera.inverse()},
        columns_{camera.fx, camera.cx, camera.width},
        rows_{camera.fy, camera.cy, camera.height},
        voxel_size_m_{voxel_size_m},
        last_u_{(camera.width - 1) / SurfaceTiles::kBlockPx},
        last_v_{(camera.height - 1) / SurfaceTiles::kBlockPx},
        step_{(T_camera_world_.linear() * voxel_size_m).cast<float>()} {}

  /// Tells whether anything of a sector, or of the cells that begin in it, can be in the image.
  [[nodiscard]] bool may_see_sector(const Index3& sector) const {
    const double sector_m = kSectorVoxelEdge * voxel_size_m_;
    return may_see(voxel_center(sector, sector_m), (0.5 * sector_m + voxel_size_m_) * std::sqrt(3.0));
  }

  /// Tells whether a ball can be in the image at all.
  [[nodiscard]] bool may_see(const Eigen::Vector3d& center_world, double radius_m) const {
    const Eigen::Vector3d c = T_camera_world_ * center_world;
    if (c.z() + radius_m < 0.0 || c.z() - radius_m > camera_.max_range_m) return false;
    return columns_.beside(c.x(), c.z()) < radius_m && rows_.beside(c.y(), c.z()) < radius_m;
  }

  /// Returns false when the box of cells is not in the image.
  [[nodiscard]] bool project(Footprint& out) const {
    // Cells reach from the centre of their first voxel to that of the voxel beyond their last.
    const IndexBox& box = out.brick.box;
    const Eigen::Vector3f lo =
        (T_camera_world_ * voxel_center(out.brick.index * kBrickEdge + box.lo, voxel_size_m_)).cast<float>();
    const Eigen::Vector3f along_x = step_.col(0) * static_cast<float>(box.hi.x - box.lo.x);
    const Eigen::Vector3f along_y = step_.col(1) * static_cast<float>(box.hi.y - box.lo.y);
    const Eigen::Vector3f along_z = step_.col(2) * static_cast<float>(box.hi.z - box.lo.z);
    std::array<float, 8> x;
    std::array<float, 8> y;
    std::array<float, 8> z;
    for (std::size_t i = 0; i < 8; ++i) {
      Eigen::Vector3f corner = lo;
      if ((i & 1) != 0) corner += along_x;
      if ((i & 2) != 0) corner += along_y;
      if ((i & 4) != 0) corner += along_z;
      x[i] = corner.x();
      y[i] = corner.y();
      z[i] = corner.z();
    }
    const auto [nearest, farthest] = std::minmax_element(z.begin(), z.end());
    if (*farthest < 0.0F || *nearest > static_cast<float>(camera_.max_range_m)) return false;
    out.nearest_m = *nearest - kTileSlackM;
    if (*nearest < kNearestZ) {
      out.u0 = out.v0 = 0;
      out.u1 = static_cast<std::int16_t>(last_u_);
      out.v1 = static_cast<std::int16_t>(last_v_);
      return true;
    }
    std::array<float, 8> u;
    std::array<float, 8> v;
    const auto fx = static_cast<float>(camera_.fx);
    const auto fy = static_cast<float>(camera_.fy);
    for (std::size_t i = 0; i < 8; ++i) {
      const float inv_z = 1.0F / z[i];
      u[i] = fx * (x[i] * inv_z);
      v[i] = fy * (y[i] * inv_z);
    }
    const auto [u_min, u_max] = std::minmax_element(u.begin(), u.end());
    const auto [v_min, v_max] = std::minmax_element(v.begin(), v.end());
    return blocks(*u_min, *u_max, camera_.cx, camera_.width, out.u0, out.u1) &&
           blocks(*v_min, *v_max, camera_.cy, camera_.height, out.v0, out.v1);
  }

 private:
  /// Two planes that bound the image on an axis.
  struct Sides {
    double low;
    double high;
    double low_scale;
    double high_scale;

    Sides(double focal, double principal, int size)
        : low{(-0.5 - principal) / focal},
          high{(size - 0.5 - principal) / focal},
          low_scale{1.0 / std::hypot(1.0, low)},
          high_scale{1.0 / std::hypot(1.0, high)} {}
    /// Returns how far a point lies outside the nearer plane; negative inside.
    [[nodiscard]] double beside(double x, double z) const {
      return std::max((low * z - x) * low_scale, (x - high * z) * high_scale);
    }
  };

  static bool blocks(float lo, float hi, double principal, int size, std::int16_t& first, std::int16_t& last) {
    const float from = lo + static_cast<float>(principal) - kSlackPx;
    const float to = hi + static_cast<float>(principal) + kSlackPx;
    if (to < 0.0F || from > static_cast<float>(size - 1)) return false;
    const float last_px = std::min(to, static_cast<float>(size - 1));
    first = static_cast<std::int16_t>(static_cast<int>(std::max(from, 0.0F)) / SurfaceTiles::kBlockPx);
    last = static_cast<std::int16_t>(static_cast<int>(last_px) / SurfaceTiles::kBlockPx);
    return true;
  }

  PinholeCamera camera_;
  Pose T_camera_world_;
  Sides columns_;
  Sides rows_;
  double voxel_size_m_;
  int last_u_;
  int last_v_;
  Eigen::Matrix3f step_;  ///< one voxel along each axis, camera frame, metres
};

}  // namespace

std::vector<Index3> sectors_cast_through(const TsdfGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
                                         double voxel_size_m) {
  const BrickProjector projector{camera, T_world_camera, voxel_size_m};
  const std::vector<Index3> known = grid.sorted_sectors();
  std::vector<Index3> keys;
  for (const Index3& key : known) {
    if (!projector.may_see_sector(key)) continue;
    IndexBox::cube(key, 1).grown(1).for_each([&](const Index3& near) { keys.push_back(near); });
  }
  std::sort(keys.begin(), keys.end(), zyx_less);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::erase_if(keys, [&](const Index3& key) { return !grid.holds(key); });
  return keys;
}

SurfaceTiles::SurfaceTiles(const TsdfGrid& grid, const SectorTable& sectors, const PinholeCamera& camera,
                           const Pose& T_world_camera, double voxel_size_m, const Executor& executor)
    : width_{(camera.width + kTilePx - 1) / kTilePx}, height_{(camera.height + kTilePx - 1) / kTilePx} {
  const BrickProjector projector{camera, T_world_camera, voxel_size_m};
  const double brick_m = kBrickEdge * voxel_size_m;
  const double brick_radius_m = (0.5 * brick_m + voxel_size_m) * std::sqrt(3.0);
  const std::vector<Index3> keys = grid.sorted_sectors();
  std::vector<std::vector<Footprint>> seen(keys.size());
  executor.parallel_for(keys.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      if (!projector.may_see_sector(keys[s])) continue;
      const Mask512 bricks = bricks_with_occupied_corner(sectors, keys[s]);
      bricks.for_each([&](std::size_t child) {
        Footprint footprint;
        footprint.brick.index = keys[s] * kSectorEdge + child_offset(static_cast<int>(child));
        if (!projector.may_see(voxel_center(footprint.brick.index, brick_m), brick_radius_m)) return;
        footprint.brick.cells = crossed_cells(sectors, footprint.brick.index);
        if (footprint.brick.cells.none()) return;
        footprint.brick.box = bounds_of(footprint.brick.cells);
        if (projector.project(footprint)) seen[s].push_back(footprint);
      });
    }
  });

  first_entry_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1);
  // Calls body(tile, blocks of the tile in the footprint).
  const auto for_each_tile = [&](const Footprint& footprint, const auto& body) {
    const auto halves = [](int tile, int first, int last) {
      return (2 * tile >= first ? 1 : 0) | (2 * tile + 1 <= last ? 2 : 0);
    };
    for (int v = footprint.v0 / 2; v <= footprint.v1 / 2; ++v) {
      const int rows = halves(v, footprint.v0, footprint.v1);
      for (int u = footprint.u0 / 2; u <= footprint.u1 / 2; ++u) {
        const int columns = halves(u, footprint.u0, footprint.u1);
        const int blocks = ((rows & 1) != 0 ? columns : 0) | ((rows & 2) != 0 ? columns << 2 : 0);
        body(static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u),
             static_cast<std::uint8_t>(blocks));
      }
    }
  };
  for (const auto& sector : seen) {
    for (const Footprint& footprint : sector)
      for_each_tile(footprint, [&](std::size_t tile, std::uint8_t) { ++first_entry_[tile + 1]; });
  }
  for (std::size_t tile = 1; tile < first_entry_.size(); ++tile) first_entry_[tile] += first_entry_[tile - 1];
  entries_.resize(first_entry_.back());
  std::vector<std::size_t> next{first_entry_.begin(), first_entry_.end() - 1};
  for (const auto& sector : seen) {
    for (const Footprint& footprint : sector) {
      const auto brick = static_cast<std::uint32_t>(bricks_.size());
      bricks_.push_back(footprint.brick);
      for_each_tile(footprint, [&](std::size_t tile, std::uint8_t blocks) {
        entries_[next[tile]++] = {footprint.nearest_m, brick, blocks};
      });
    }
  }
}

}  // namespace saccade
