// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/raycast.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "saccade/map/internal/raycast_kernels.hpp"
#include "saccade/map/internal/surface_tiles.hpp"
#include "saccade/map/internal/voxel_reader.hpp"
#include "saccade/map/ray_math.hpp"

namespace saccade {
namespace {

using tile_cast::kTileRays;
using tile_cast::SurfaceBrick;
using tile_cast::TileHits;
using tile_cast::TileRays;

constexpr int kTilePx{SurfaceTiles::kTilePx};
static_assert(kTilePx * kTilePx == kTileRays);

/// Pixel of a tile that a ray belongs to. Blocks of 4×4 keep together rays that meet the same bricks.
struct TilePixel {
  int u;
  int v;
};
constexpr TilePixel pixel_of_ray(int i) { return {(i & 3) | ((i >> 2) & 4), ((i >> 2) & 3) | ((i >> 3) & 4)}; }

/// Data shared by all tiles of one cast.
struct Cast {
  const PinholeCamera& camera;
  const SectorTable& sectors;
  const SurfaceTiles& tiles;
  LatticePoint origin;        ///< origin of the rays, in the lattice of the cells
  Eigen::Matrix3d per_cell;   ///< from camera directions to cells
  std::vector<double> ray_x;  ///< x of PinholeCamera::ray by column, up to the border of the last tile
  std::vector<double> ray_y;  ///< y by row
  Eigen::Matrix3f R_camera_world;
  bool colors;
};

/// Returns the corners of cells and their neighbours along the axes, for gradients.
IndexBox with_neighbours(const IndexBox& cells) { return {cells.lo - Index3{1, 1, 1}, cells.hi + Index3{2, 2, 2}}; }

/// Cache of the last few hundred unpacked bricks. One thread.
class SurfaceBricks {
 public:
  explicit SurfaceBricks(const Cast& cast) : cast_{&cast}, slot_of_(cast.tiles.bricks().size(), 0), slots_(kSlots) {}

  [[nodiscard]] const SurfaceBrick& get(std::uint32_t brick) {
    Slot& known = slots_[slot_of_[brick]];
    if (known.brick == brick) return known.surface;
    slot_of_[brick] = next_;
    Slot& slot = slots_[next_];
    next_ = static_cast<std::uint16_t>((next_ + 1) % kSlots);
    slot.brick = brick;
    const SurfaceTiles::Brick& known_cells = cast_->tiles.bricks()[brick];
    slot.surface.cells = known_cells.cells;
    slot.surface.box = known_cells.box;
    slot.surface.voxels.load(cast_->sectors, known_cells.index, 1, with_neighbours(known_cells.box));
    return slot.surface;
  }

 private:
  static constexpr std::uint16_t kSlots{512};
  struct Slot {
    std::uint32_t brick{~std::uint32_t{0}};
    SurfaceBrick surface;
  };
  const Cast* cast_;
  std::vector<std::uint16_t> slot_of_;
  std::vector<Slot> slots_;
  std::uint16_t next_{0};
};

/// Caster of tiles. One per thread.
class TileCaster {
 public:
  explicit TileCaster(const Cast& cast) : cast_{&cast}, bricks_{cast}, reader_{cast.sectors} {
    rays_.o = {cast.origin.fraction[0], cast.origin.fraction[1], cast.origin.fraction[2]};
    rays_.farthest_m = static_cast<float>(cast.camera.max_range_m);
  }

  void cast_tile(int tile_u, int tile_v, SurfaceView& view) {
    const auto entries = cast_->tiles.entries(tile_u, tile_v);
    if (entries.empty()) return;
    by_depth_.assign(entries.begin(), entries.end());
    std::sort(by_depth_.begin(), by_depth_.end(),
              [](const auto& a, const auto& b) { return a.nearest_m < b.nearest_m; });
    aim(tile_u * kTilePx, tile_v * kTilePx);
    hits_.clear();
    float farthest_end = HUGE_VALF;
    for (const SurfaceTiles::Entry& entry : by_depth_) {
      if (entry.nearest_m > farthest_end) break;  // every ray ended nearer
      const SurfaceBrick& surface = bricks_.get(entry.brick);
      const Index3 lo = cast_->tiles.bricks()[entry.brick].index * kBrickEdge - cast_->origin.voxel;
      farthest_end = tile_cast::cast_in_brick(rays_, lo, surface, entry, hits_);
    }
    write(tile_u * kTilePx, tile_v * kTilePx, view);
  }

 private:
  /// Aims the rays. Those of pixels beyond the image's border are cast as well, but not written.
  void aim(int u0, int v0) {
    const double* x = cast_->ray_x.data() + u0;
    const double* y = cast_->ray_y.data() + v0;
    for (int axis = 0; axis < 3; ++axis) {
      float* d = rays_.d[static_cast<std::size_t>(axis)].data();
      const double mx = cast_->per_cell(axis, 0);
      const double my = cast_->per_cell(axis, 1);
      const double mz = cast_->per_cell(axis, 2);
      for (int first = 0; first < kTileRays; first += 4) {  // four pixels of a row
        const auto [u, v] = pixel_of_ray(first);
        for (int i = 0; i < 4; ++i) d[first + i] = static_cast<float>((mx * x[u + i] + my * y[v]) + mz);
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < kTileRays; ++i) {
        const float d = rays_.d[axis][i];
        const bool parallel = std::fabs(d) < kParallel;
        rays_.d[axis][i] = parallel ? 0.0F : d;
        const float inv = 1.0F / (parallel ? 1.0F : d);
        rays_.inv[axis][i] = parallel ? HUGE_VALF : inv;
      }
    }
  }

  void write(int u0, int v0, SurfaceView& view) {
    const auto min_range_m = static_cast<float>(cast_->camera.min_range_m);
    for (std::size_t i = 0; i < kTileRays; ++i) {
      if (!(hits_.t[i] > 0.0F) || hits_.t[i] < min_range_m) continue;
      const auto [du, dv] = pixel_of_ray(static_cast<int>(i));
      const int u = u0 + du;
      const int v = v0 + dv;
      if (u >= view.depth.width() || v >= view.depth.height()) continue;
      const Eigen::Vector3f gradient{hits_.gradient[0][i], hits_.gradient[1][i], hits_.gradient[2][i]};
      const float norm = gradient.norm();
      if (!(norm > 0.0F)) continue;
      view.depth(u, v) = hits_.t[i];
      view.normals(u, v) = cast_->R_camera_world * gradient / norm;
      if (cast_->colors) view.colors(u, v) = color(i);
    }
  }

  /// Returns the colour of the voxel nearest to the hit, or of any voxel of the cell that has one.
  [[nodiscard]] Rgb8 color(std::size_t i) {
    const Index3 cell = cast_->tiles.bricks()[hits_.brick[i]].index * kBrickEdge + child_offset(hits_.cell[i]);
    const Index3 nearest{hits_.fraction[0][i] > 0.5F ? 1 : 0, hits_.fraction[1][i] > 0.5F ? 1 : 0,
                         hits_.fraction[2][i] > 0.5F ? 1 : 0};
    if (const auto found = reader_.color(cell + nearest)) return *found;
    for (int corner = 0; corner < 8; ++corner) {
      if (const auto found = reader_.color(cell + Index3{corner & 1, (corner >> 1) & 1, (corner >> 2) & 1}))
        return *found;
    }
    constexpr std::uint8_t kGrey{128};
    return {kGrey, kGrey, kGrey};
  }

  const Cast* cast_;
  SurfaceBricks bricks_;
  VoxelReader reader_;
  std::vector<SurfaceTiles::Entry> by_depth_;
  TileRays rays_;
  TileHits hits_;
};

template <class At>
std::vector<double> ray_coordinates(int count, const At& at) {
  std::vector<double> coordinates;
  for (int i = 0; i < count; ++i) coordinates.push_back(at(i));
  return coordinates;
}

/// Pool that lends casters to chunks of work, so that each thread has one, not each chunk.
class CasterPool {
 public:
  explicit CasterPool(const Cast& cast) : cast_{&cast} {}
  [[nodiscard]] std::unique_ptr<TileCaster> take() {
    const std::scoped_lock lock{mutex_};
    if (idle_.empty()) return std::make_unique<TileCaster>(*cast_);
    std::unique_ptr<TileCaster> caster = std::move(idle_.back());
    idle_.pop_back();
    return caster;
  }
  void give_back(std::unique_ptr<TileCaster> caster) {
    const std::scoped_lock lock{mutex_};
    idle_.push_back(std::move(caster));
  }

 private:
  const Cast* cast_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<TileCaster>> idle_;
};

/// Casts the view through a grid in which what it reads is in memory.
void cast_view(const TsdfGrid& grid, double e, const PinholeCamera& camera, const Pose& T_world_camera,
               const Executor& executor, const RaycastConfig& config, SurfaceView& view) {
  const Eigen::Vector3d origin = T_world_camera.translation() / e - Eigen::Vector3d::Constant(0.5);
  const SectorTable sectors{grid};
  const SurfaceTiles tiles{grid, sectors, camera, T_world_camera, e, executor};
  const Cast cast{camera,
                  sectors,
                  tiles,
                  lattice_point(origin.x(), origin.y(), origin.z()),
                  T_world_camera.linear() / e,
                  ray_coordinates(tiles.width() * kTilePx, [&](int u) { return camera.ray(u, 0.0).x(); }),
                  ray_coordinates(tiles.height() * kTilePx, [&](int v) { return camera.ray(0.0, v).y(); }),
                  T_world_camera.linear().transpose().cast<float>(),
                  config.colors};
  CasterPool casters{cast};
  executor.parallel_for(static_cast<std::size_t>(tiles.height()), 4, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<TileCaster> caster = casters.take();
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < tiles.width(); ++u) caster->cast_tile(u, v, view);
    }
    casters.give_back(std::move(caster));
  });
}

}  // namespace

Result<SurfaceView> raycast(const TsdfSnapshot& map, const PinholeCamera& camera, const Pose& T_world_camera,
                            const Executor& executor, const RaycastConfig& config) {
  SACCADE_CHECK(camera.validate());
  if (const auto checked = pose_from_matrix(T_world_camera.matrix()); !checked) return checked.error();
  SurfaceView view;
  view.depth = DepthImage{camera.width, camera.height};
  view.normals = Image<Eigen::Vector3f>{camera.width, camera.height, Eigen::Vector3f::Zero()};
  if (config.colors) view.colors = ColorImage{camera.width, camera.height};
  if (map.grid.empty()) return view;

  const double e = map.config.voxel_size_m;
  if (map.grid.all_in_memory()) {
    cast_view(map.grid, e, camera, T_world_camera, executor, config, view);
    return view;
  }
  const std::vector<Index3> read = sectors_cast_through(map.grid, camera, T_world_camera, e);
  if (std::none_of(read.begin(), read.end(), [&](const Index3& key) { return map.grid.is_away(key); })) {
    cast_view(map.grid, e, camera, T_world_camera, executor, config, view);
    return view;
  }
  SACCADE_TRY(const TsdfGrid part, with_in_memory(map.grid, read, executor));
  cast_view(part, e, camera, T_world_camera, executor, config, view);
  return view;
}

}  // namespace saccade
