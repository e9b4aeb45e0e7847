// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/view_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/map/ray_walk.hpp"
#include "saccade/report/internal/blend.hpp"
#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/internal/shading.hpp"

namespace saccade {
namespace {

/// Unknown faces across x, y, z: not the same, so that shapes can be seen. What lies behind shows through.
constexpr std::array<Rgb8, 3> kUnknownFaces{{{58, 64, 92}, {40, 45, 70}, {78, 86, 116}}};
constexpr double kUnknownOpacity{0.5};
constexpr LineStyle kRegionLine{{214, 92, 22}, 1.6, 0.35};
constexpr LineStyle kWorkspaceLine{{120, 128, 140}, 1.2, 0.25};

struct Hit {
  Index3 voxel;
  RayEvent enter{kRayStart};
};

/// Hits of a ray: the first unknown voxel that is drawn, if it comes before the surface; and the surface.
struct Hits {
  std::optional<Hit> unknown;
  std::optional<Hit> occupied;
};

class TernaryCaster {
 public:
  TernaryCaster(const TsdfSnapshot& map, const Viewpoint& view, const TernaryPictureConfig& config)
      : map_{map}, config_{config}, table_{map.grid}, voxel_size_m_{map.config.voxel_size_m} {
    IndexBox known = map.grid.known_bounds();
    if (!known.empty()) known = known.grown(1);  // beyond begins the unknown
    unknown_ = map.config.workspace ? voxels_with_center_in(*map.config.workspace, voxel_size_m_) : known;
    if (!config.unknown_within.empty()) {
      IndexBox inside;
      for (const Region& region : config.unknown_within) {
        inside = inside.hull(voxels_with_center_in(bounds(region), voxel_size_m_));
      }
      unknown_ = map.config.workspace ? unknown_.intersection(inside) : inside;
    }
    domain_ = known.hull(unknown_);
    if (config.crop) domain_ = domain_.intersection(voxels_with_center_in(*config.crop, voxel_size_m_));
    lamp_ = lamp_of(view);
    const Eigen::Vector3d center = view.T_world_camera.translation() / voxel_size_m_;
    origin_ = lattice_point(center.x(), center.y(), center.z());
  }

  [[nodiscard]] bool empty() const { return domain_.empty(); }

  /// direction: world, z = 1 in the camera.
  [[nodiscard]] Hits cast(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3f d = (direction / voxel_size_m_).cast<float>();
    const LatticeRay ray = make_lattice_ray(origin_, d.x(), d.y(), d.z());
    Hits hits;
    const auto enter_sector = [&](const Index3& index, const Sector* sector, const RaySpan&) {
      return sector != nullptr || IndexBox::cube(index * kSectorVoxelEdge, kSectorVoxelEdge).overlaps(unknown_);
    };
    const auto visit_brick = [&](const Index3& brick, const Sector* sector, int child, const RaySpan& span) {
      return cast_in_brick(ray, brick, sector, child, span, hits);
    };
    RaySpan span = clip(ray, domain_);
    const RayEvent start = after_depth(static_cast<float>(config_.start_m));
    if (before(span.enter, start)) span.enter = start;
    walk_map(ray, span, table_, enter_sector, visit_brick);
    return hits;
  }

  [[nodiscard]] Rgb8 unknown_over(const Hit& unknown, const Rgb8& behind) const {
    const int axis = unknown.enter.axis;
    const Rgb8& face = axis >= 0 && axis < 3 ? kUnknownFaces[static_cast<std::size_t>(axis)] : kUnknownFaces[1];
    return blend(behind, face, kUnknownOpacity);
  }

  [[nodiscard]] Rgb8 surface_color(const Hit& hit, const Eigen::Vector3d& direction) const {
    const int axis = hit.enter.axis;
    Eigen::Vector3d normal = gradient(hit.voxel);
    if (normal.isZero(0.0) && axis >= 0 && axis < 3) normal[axis] = direction[axis] > 0.0 ? -1.0 : 1.0;
    const std::optional<Rgb8> fused = map_.grid.color(hit.voxel);
    const bool colored = fused && *fused != Rgb8{};
    return shaded(colored ? *fused : kClay, normal, direction, lamp_, colored ? kColorLight : kClayLight);
  }

 private:
  [[nodiscard]] bool cast_in_brick(const LatticeRay& ray, const Index3& brick, const Sector* sector, int child,
                                   const RaySpan& span, Hits& hits) const {
    const bool unknown = (sector == nullptr || sector->has_unknown.test(child)) &&
                         IndexBox::cube(brick * kBrickEdge, kBrickEdge).overlaps(unknown_);
    const bool occupied = sector != nullptr && sector->has_occupied.test(child);
    if ((!unknown || hits.unknown) && !occupied) return false;
    const BrickRef* ref = sector == nullptr ? nullptr : &sector->bricks[static_cast<std::size_t>(child)];
    return walk_cells<kVoxelLevel>(ray, span, [&](const Index3& voxel, const RaySpan& in_voxel) {
      if (ref != nullptr && ((ref->nonempty_word(voxel.z & 7) >> (child_index(voxel) & 63)) & 1U) == 0) return false;
      const bool is_occupied = ref != nullptr && ref->voxel(child_index(voxel)).w > 0;
      if (is_occupied) hits.occupied = Hit{voxel, in_voxel.enter};
      if (!is_occupied && !hits.unknown && shown(voxel)) hits.unknown = Hit{voxel, in_voxel.enter};
      return is_occupied;
    });
  }

  /// Whether an unknown voxel is drawn.
  [[nodiscard]] bool shown(const Index3& voxel) const {
    const std::vector<Region>& regions = config_.unknown_within;
    const Eigen::Vector3d p = voxel_center(voxel, voxel_size_m_);
    return unknown_.contains(voxel) &&
           (regions.empty() ||
            std::any_of(regions.begin(), regions.end(), [&](const Region& r) { return contains(r, p); }));
  }

  [[nodiscard]] Voxel voxel(const Index3& index) const {
    const Index3 brick = parent(index);
    const Sector* sector = table_.find(parent(brick));
    return sector == nullptr ? Voxel{}
                             : sector->bricks[static_cast<std::size_t>(child_index(brick))].voxel(child_index(index));
  }

  /// Towards outside; differences over the known neighbours, two voxels to either side to smooth. Zero if there is
  /// none.
  [[nodiscard]] Eigen::Vector3d gradient(const Index3& at) const {
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    const double here = voxel(at).v;
    for (int axis = 0; axis < 3; ++axis) {
      for (int reach = 1; reach <= 2; ++reach) {
        const Index3 step{axis == 0 ? reach : 0, axis == 1 ? reach : 0, axis == 2 ? reach : 0};
        const Voxel ahead = voxel(at + step);
        const Voxel behind = voxel(at - step);
        g[axis] += ((ahead.w > 0 ? ahead.v : here) - (behind.w > 0 ? behind.v : here)) / reach;
      }
    }
    return g.stableNormalized();
  }

  const TsdfSnapshot& map_;
  const TernaryPictureConfig& config_;
  SectorTable table_;
  double voxel_size_m_;
  IndexBox unknown_;  ///< bounds of the unknown voxels that are drawn
  IndexBox domain_;   ///< where rays go at all
  LatticePoint origin_;
  Eigen::Vector3d lamp_;
};

}  // namespace

Canvas draw_ternary(const TsdfSnapshot& map, const Viewpoint& view, const Executor& executor,
                    const TernaryPictureConfig& config) {
  Canvas canvas{view, config.background, config.samples};
  const TernaryCaster caster{map, view, config};
  if (!caster.empty()) {
    const PinholeCamera& camera = canvas.sample_camera();
    constexpr std::size_t kRows{8};
    executor.parallel_for(static_cast<std::size_t>(camera.height), kRows, [&](std::size_t begin, std::size_t end) {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
        for (int u = 0; u < camera.width; ++u) {
          const Eigen::Vector3d direction = view.T_world_camera.linear() * camera.ray(u, v);
          const Hits hits = caster.cast(direction);
          Rgb8 color = hits.occupied ? caster.surface_color(*hits.occupied, direction) : config.background;
          if (hits.unknown) color = caster.unknown_over(*hits.unknown, color);
          if (!hits.occupied && !hits.unknown) continue;
          if (hits.occupied) {
            canvas.plot(u, v, hits.occupied->enter.t, color);
          } else {  // what is unknown hides nothing that is drawn later
            canvas.samples()(u, v) = color;
          }
        }
      }
    });
  }
  if (config.outline_workspace && map.config.workspace) canvas.outline(Region{*map.config.workspace}, kWorkspaceLine);
  for (const Region& region : config.unknown_within) canvas.outline(region, kRegionLine);
  return canvas;
}

ColorImage ternary_picture(const TsdfSnapshot& map, const Viewpoint& view, const Executor& executor,
                           const TernaryPictureConfig& config) {
  return draw_ternary(map, view, executor, config).finish();
}

ColorImage ternary_figure(const TsdfSnapshot& map, const Viewpoint& view, const Executor& executor,
                          const std::string& title, const TernaryPictureConfig& config) {
  return compose({title, {{ternary_picture(map, view, executor, config), {}, {}, {}, ternary_legend(config)}}, {}});
}

std::vector<LegendEntry> ternary_legend(const TernaryPictureConfig& config) {
  std::vector<LegendEntry> legend{{kClay, "occupied (grey or in colour)"},
                                  {blend(config.background, kUnknownFaces[0], kUnknownOpacity),
                                   config.unknown_within.empty() ? "unknown" : "unknown, in the region"},
                                  {config.background, "empty"}};
  if (!config.unknown_within.empty()) legend.push_back({kRegionLine.color, "region"});
  return legend;
}

}  // namespace saccade
