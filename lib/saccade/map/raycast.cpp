// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/raycast.hpp"

#include <cmath>

#include "saccade/map/ray_walk.hpp"
#include "saccade/map/surface_table.hpp"
#include "saccade/map/tile_depths.hpp"
#include "saccade/map/voxel_reader.hpp"

namespace saccade {
namespace {

/// Casts rays against the cells of one map. One per thread.
class SurfaceCaster {
 public:
  SurfaceCaster(const SurfaceTable& surface, const LatticePoint& origin)
      : surface_{&surface}, reader_{surface.sectors()}, origin_{origin} {
    const IndexBox& sectors = surface.sectors().box();
    voxels_ = {sectors.lo * kSectorVoxelEdge, sectors.hi * kSectorVoxelEdge};
  }

  /// First crossing between the depths t_min and t_max.
  [[nodiscard]] std::optional<CellHit> cast(const Eigen::Vector3f& direction, float t_min, float t_max) {
    const LatticeRay ray = make_lattice_ray(origin_, direction.x(), direction.y(), direction.z());
    RaySpan span = clip(ray, voxels_).until(after_depth(t_max));
    if (before(span.enter, {t_min, kBeforeCrossings})) span.enter = {t_min, kBeforeCrossings};
    std::optional<CellHit> hit;
    Index3 sector{};
    const SurfaceTable::SectorSurface* surface{nullptr};
    bool known_sector{false};
    walk_cells<kBrickLevel>(ray, span, [&](const Index3& brick, const RaySpan& in_brick) {
      if (!known_sector || !(parent(brick) == sector)) {
        sector = parent(brick);
        surface = surface_->find(sector);
        known_sector = true;
      }
      const int i = child_index(brick);
      return surface != nullptr && surface->bricks.test(i) && cast_in_brick(ray, in_brick, surface->of_brick(i), hit);
    });
    return hit;
  }

  /// ∇v at a hit, from the differences over two voxels; the cell's own gradient where a neighbour is unknown.
  [[nodiscard]] Eigen::Vector3f gradient(const CellHit& hit, const Cell& cell) {
    Eigen::Vector3f result;
    const auto value_at = [&](const Index3& base) -> std::optional<float> {
      const std::optional<Cell> neighbour = reader_.cell(base);
      if (!neighbour) return std::nullopt;
      return neighbour->at(hit.fraction[0], hit.fraction[1], hit.fraction[2]);
    };
    constexpr Index3 kSteps[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; ++axis) {
      const auto ahead = value_at(hit.cell + kSteps[axis]);
      const auto behind = value_at(hit.cell - kSteps[axis]);
      if (ahead && behind) {
        result[axis] = 0.5F * (*ahead - *behind);
      } else {
        std::array<float, 3> low = hit.fraction;
        std::array<float, 3> high = hit.fraction;
        low[static_cast<std::size_t>(axis)] = 0.0F;
        high[static_cast<std::size_t>(axis)] = 1.0F;
        result[axis] = cell.at(high[0], high[1], high[2]) - cell.at(low[0], low[1], low[2]);
      }
    }
    return result;
  }

  [[nodiscard]] VoxelReader& reader() { return reader_; }

 private:
  /// Stops at the first crossing; a surface seen from behind stops the ray without a hit.
  bool cast_in_brick(const LatticeRay& ray, const RaySpan& span, const Mask512& cells, std::optional<CellHit>& hit) {
    return walk_cells<kVoxelLevel>(ray, span, [&](const Index3& index, const RaySpan& in_cell) {
      if (!cells.test(child_index(index))) return false;
      const std::optional<Cell> cell = reader_.cell(index);
      if (!cell) return false;
      CellHit found;
      const CellCrossing crossing = cross_cell(ray, index, *cell, in_cell, found);
      if (crossing == CellCrossing::front) hit = found;
      return crossing != CellCrossing::none;
    });
  }

  static constexpr int kBeforeCrossings{-1};
  const SurfaceTable* surface_;
  VoxelReader reader_;
  LatticePoint origin_;
  IndexBox voxels_;
};

Rgb8 color_at(VoxelReader& reader, const CellHit& hit) {
  const Index3 nearest{hit.cell.x + (hit.fraction[0] > 0.5F ? 1 : 0), hit.cell.y + (hit.fraction[1] > 0.5F ? 1 : 0),
                       hit.cell.z + (hit.fraction[2] > 0.5F ? 1 : 0)};
  if (const auto color = reader.color(nearest)) return *color;
  for (int i = 0; i < 8; ++i) {
    if (const auto color = reader.color(hit.cell + Index3{i & 1, (i >> 1) & 1, (i >> 2) & 1})) return *color;
  }
  constexpr std::uint8_t kGrey{128};
  return {kGrey, kGrey, kGrey};
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
  const Eigen::Vector3d origin_cells = T_world_camera.translation() / e - Eigen::Vector3d::Constant(0.5);
  const LatticePoint origin = lattice_point(origin_cells.x(), origin_cells.y(), origin_cells.z());
  const Eigen::Matrix3d R_world_camera = T_world_camera.linear();
  const Eigen::Matrix3f R_camera_world = R_world_camera.transpose().cast<float>();
  const SurfaceTable surface{map.grid, executor};
  const TileDepths tiles{surface, camera, T_world_camera, e};
  const auto max_range_m = static_cast<float>(camera.max_range_m);
  executor.parallel_for(static_cast<std::size_t>(camera.height), 8, [&](std::size_t begin, std::size_t end) {
    SurfaceCaster caster{surface, origin};
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const TileDepths::Interval& depths = tiles.at_pixel(u, v);
        if (depths.farthest_m < depths.nearest_m) continue;
        const Eigen::Vector3f direction = (R_world_camera * camera.ray(u, v) / e).cast<float>();
        const std::optional<CellHit> hit =
            caster.cast(direction, depths.nearest_m, std::min(depths.farthest_m, max_range_m));
        if (!hit || hit->t < static_cast<float>(camera.min_range_m)) continue;
        const std::optional<Cell> cell = caster.reader().cell(hit->cell);
        if (!cell) continue;
        const Eigen::Vector3f gradient = caster.gradient(*hit, *cell);
        const float norm = gradient.norm();
        if (!(norm > 0.0F)) continue;
        view.depth(u, v) = hit->t;
        view.normals(u, v) = R_camera_world * gradient / norm;
        if (config.colors) view.colors(u, v) = color_at(caster.reader(), *hit);
      }
    }
  });
  return view;
}

}  // namespace saccade
