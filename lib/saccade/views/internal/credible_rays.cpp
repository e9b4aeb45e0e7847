// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/credible_rays.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/views/internal/find_supports.hpp"
#include "saccade/views/internal/sight_line.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr int kColumns{32};        // rays across the image
constexpr int kGlanceColumns{12};  // rays across the image for a quick look
constexpr double kSupportThickness_m{0.05};

double above_m(const Support& support, const Vector3d& p) { return p.z() - support.height_at(p.head<2>()); }

/// Returns the share of the ray at which it passes a support's plane, if it does.
std::optional<double> share_at(const Support& support, const SightRay& ray) {
  const double begin_m = above_m(support, ray.from_m);
  const double rise_m = above_m(support, ray.to_m) - begin_m;
  if (rise_m == 0.0) return std::nullopt;
  const double share = -begin_m / rise_m;
  return share >= 0.0 && share <= 1.0 ? std::optional{share} : std::nullopt;
}

/// Returns the box of all voxels with their centre in the region, grown by half a voxel, which exceeds any rounding.
Box grown_bounds(const Region& region, double voxel_size_m) {
  Box box = bounds(region);
  box.min.array() -= voxel_size_m;
  box.max.array() += voxel_size_m;
  return box;
}

}  // namespace

struct CredibleRays::Scene {
  StateVolume volume;
  std::vector<Support> supports;
  bool holds_surface;  ///< whether any voxel is occupied
  SightClasses classes;
  Box around_region;
  PinholeCamera sensor;
  Trust trust{Trust::credible};
  OwnBody own_body;
  Credit credit;

  Scene(StateVolume states, const PlanningContext& context, const Region& region, const PinholeCamera& looks,
        UnknownOutside unknown_outside)
      : volume{std::move(states)},
        supports{find_supports(context.map, volume, kMinSupport_m2, context.executor)},
        holds_surface{any_occupied(volume.data(), volume.size())},
        classes{volume, region, unknown_outside, context.executor},
        around_region{grown_bounds(region, volume.voxel_size_m())},
        sensor{looks},
        credit{context.checked, looks, volume, 1.5 * volume.voxel_size_m()} {}

  /// Returns the column of a place in the grid of a support; nullopt outside.
  [[nodiscard]] std::optional<std::size_t> column_of(const Vector3d& p) const {
    const auto x = static_cast<std::int32_t>(std::floor(p.x() / volume.voxel_size_m())) - volume.box().lo.x;
    const auto y = static_cast<std::int32_t>(std::floor(p.y() / volume.voxel_size_m())) - volume.box().lo.y;
    const Index3 size = volume.box().size();
    if (x < 0 || y < 0 || x >= size.x || y >= size.y) return std::nullopt;
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] bool is_over(const Support& support, const Vector3d& p) const {
    const std::optional<std::size_t> column = column_of(p);
    return column && support.columns[*column] != 0;
  }

  /// Tells whether a place below a support stands on another, as in a shelf.
  [[nodiscard]] bool is_over_another(const Support& support, const Vector3d& p) const {
    return std::any_of(supports.begin(), supports.end(), [&](const Support& other) {
      return &other != &support && above_m(other, p) > 0.0 && is_over(other, p);
    });
  }

  /// Tells whether the ray reaches its voxel through a support or from below one.
  [[nodiscard]] bool is_hidden(const SightRay& ray, double met) const {
    return std::any_of(supports.begin(), supports.end(), [&](const Support& support) {
      if (above_m(support, ray.from_m) >= 0.0) return false;
      const Vector3d p = ray.at(met);
      if (above_m(support, p) > 0.0) return is_over(support, ray.at(share_at(support, ray).value_or(met)));
      if (!is_over(support, p)) return false;
      return above_m(support, p) > -kSupportThickness_m || !is_over_another(support, p);
    });
  }

  /// Tells whether the ray reaches a support from above after its voxel.
  [[nodiscard]] bool ends_on_support(const SightRay& ray, double met) const {
    return std::any_of(supports.begin(), supports.end(), [&](const Support& support) {
      if (above_m(support, ray.from_m) <= 0.0) return false;
      const std::optional<double> passed = share_at(support, ray);
      return passed && *passed >= met && is_over(support, ray.at(*passed));
    });
  }

  /// Counts of a look's rays.
  struct Tally {
    std::size_t promise{0};  ///< rays that promise something
    std::size_t may{0};      ///< rays whose promise may be kept
    double worth{0.0};       ///< sum of their credits

    [[nodiscard]] double share() const { return promise > 0 ? worth / static_cast<double>(promise) : 1.0; }
    [[nodiscard]] double credit() const {
      if (promise == 0) return 1.0;
      return may > 0 ? worth / static_cast<double>(may) : 0.0;
    }
  };
  /// Calls believed(the voxel met, its credit) for the rays whose promise may be kept, except those for which
  /// is_behind_body(the voxel met, u, v) holds.
  template <class Believed, class IsBehindBody>
  Tally cast(const PinholeCamera& rays, const Pose& T_world_camera, const Believed& believed,
             const IsBehindBody& is_behind_body) const;

  [[nodiscard]] bool may_be_kept(const SightRay& ray, const MetVoxel& met) const {
    return trust == Trust::blind || (met.returns && !is_hidden(ray, met.share));
  }
  /// Returns the credit of a promise that may be kept, in [0, 1].
  [[nodiscard]] double worth(const SightRay& ray, const MetVoxel& met) const {
    if (trust == Trust::blind || credit.is_full()) return 1.0;
    return credit.of(ray.at(met.share), credit.seen_from(volume.index(classes.voxel(met.place))), ray.from_m);
  }
};

namespace {

IndexBox box_of(const TsdfSnapshot& map) {
  const TsdfConfig& config = map.config;
  return config.workspace ? voxels_with_center_in(*config.workspace, config.voxel_size_m) : map.grid.known_bounds();
}

}  // namespace

bool CredibleRays::can_look_through(const TsdfSnapshot& map) { return box_of(map).count() <= StateVolume::kMostVoxels; }

Result<CredibleRays> CredibleRays::create(const PlanningContext& context, const RegionOfInterest& region,
                                          const PinholeCamera& sensor, UnknownOutside outside, Trust trust) {
  SACCADE_TRY(StateVolume volume, StateVolume::read(context.map, box_of(context.map), context.executor));
  const PinholeCamera coarse = sensor.scaled_to_width(std::min(kColumns, sensor.width));
  auto scene = std::make_shared<Scene>(std::move(volume), context, region.bounds, coarse, outside);
  scene->trust = trust;
  if (context.own_body && trust == Trust::credible) {
    SACCADE_TRY(scene->own_body, context.own_body(coarse));
  }
  return CredibleRays{std::move(scene)};
}

template <class Believed, class IsBehindBody>
CredibleRays::Scene::Tally CredibleRays::Scene::cast(const PinholeCamera& rays, const Pose& T_world_camera,
                                                     const Believed& believed,
                                                     const IsBehindBody& is_behind_body) const {
  Tally tally;
  if (!T_world_camera.matrix().allFinite()) return tally;  // gains reject such a pose
  std::vector<SightRay> sight;
  sight.reserve(static_cast<std::size_t>(rays.width) * static_cast<std::size_t>(rays.height));
  for (int v = 0; v < rays.height; ++v) {
    for (int u = 0; u < rays.width; ++u) {
      const Vector3d end{(u - rays.cx) / rays.fx, (v - rays.cy) / rays.fy, 1.0};
      sight.push_back({T_world_camera.translation(), T_world_camera * (rays.max_range_m * end)});
    }
  }
  const double nearest = sensor.min_range_m / sensor.max_range_m;
  std::vector<std::optional<MetVoxel>> met_by_ray = met_voxels(classes, around_region, sight);
  for (std::size_t i = 0; i < sight.size(); ++i) {
    if (!met_by_ray[i] || met_by_ray[i]->share < nearest) continue;
    const SightRay& ray = sight[i];
    MetVoxel& met = *met_by_ray[i];
    ++tally.promise;
    if (!met.returns) met.returns = !holds_surface || ends_on_support(ray, met.share);
    if (!may_be_kept(ray, met)) continue;
    ++tally.may;
    if (is_behind_body(met, static_cast<int>(i) % rays.width, static_cast<int>(i) / rays.width)) continue;
    const double credited = worth(ray, met);
    tally.worth += credited;
    if (credited > 0.0) believed(met, credited);
  }
  return tally;
}

CredibleRays::Look CredibleRays::from(const Pose& T_world_camera) const {
  const PinholeCamera& sensor = scene_->sensor;
  std::optional<DepthImage> body;
  if (scene_->own_body) body = scene_->own_body(T_world_camera);
  SACCADE_EXPECTS(!body || (body->width() == sensor.width && body->height() == sensor.height));
  Look look;
  const auto is_behind_body = [&](const MetVoxel& met, int u, int v) {
    const double body_m = body ? static_cast<double>((*body)(u, v)) : 0.0;
    return body_m > 0.0 && body_m < met.share * sensor.max_range_m;
  };
  const auto believed = [&](const MetVoxel& met, double worth) {
    look.promise.voxels.push_back({scene_->classes.voxel(met.place), worth});
  };
  const Scene::Tally tally = scene_->cast(sensor, T_world_camera, believed, is_behind_body);
  look.share = tally.share();
  look.credit = tally.credit();
  return look;
}

std::vector<CredibleRays::Glance> CredibleRays::glances(std::span<const Pose> T_world_camera,
                                                        const Executor& executor) const {
  const PinholeCamera coarse = scene_->sensor.scaled_to_width(std::min(kGlanceColumns, scene_->sensor.width));
  const double rays = static_cast<double>(coarse.width) * static_cast<double>(coarse.height);
  std::vector<Glance> glances(T_world_camera.size());
  executor.parallel_for(glances.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Scene::Tally tally = scene_->cast(
          coarse, T_world_camera[i], [](const MetVoxel&, double) {}, [](const MetVoxel&, int, int) { return false; });
      glances[i] = {tally.worth / rays, tally.credit()};
    }
  });
  return glances;
}

std::vector<CredibleRays::Look> CredibleRays::looks(std::span<const Pose> T_world_camera,
                                                    const Executor& executor) const {
  std::vector<Look> looks(T_world_camera.size());
  executor.parallel_for(looks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) looks[i] = from(T_world_camera[i]);
  });
  return looks;
}

}  // namespace saccade
