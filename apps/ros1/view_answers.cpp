// SPDX-License-Identifier: Apache-2.0
// Answers that view the map through a camera.

#include <cmath>
#include <limits>

#include "map_answers.hpp"
#include "plain_types.hpp"
#include "saccade/map/ray_walk.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/views/sensor_rays.hpp"

namespace saccade::ros1 {
namespace {

constexpr std::size_t kMostViews{100'000};

/// Casts rays according to one request.
class RayCaster {
 public:
  RayCaster(const Source& source, const MapRequest& request)
      : map_{source.map},
        sectors_{source.map.grid},
        filter_{request},
        filtered_{filter_.any()},
        skip_{request.skip_unknown_outside_filter && filtered_},
        emitter_x_{request.emitter_x} {
    if (request.view_box) view_voxels_ = voxels_with_center_in(to_box(*request.view_box), map_.config.voxel_size_m);
  }

  /// Returns the counted voxel that stops a pixel's ray; nullopt where there is none.
  [[nodiscard]] std::optional<VoxelHit> cast(const SensorRays& rays, const PinholeCamera& camera,
                                             const Pose& T_world_camera, int u, int v) const {
    const LatticeRay ray = pixel_ray(rays, camera, u, v);
    const std::optional<VoxelHit> hit = walk(ray, camera.min_range_m, camera.max_range_m);
    if (!hit || (filtered_ && !counts(hit->voxel))) return std::nullopt;
    if (emitter_x_ && in_shadow(*hit, camera, T_world_camera, u, v)) return std::nullopt;
    return hit;
  }

 private:
  [[nodiscard]] bool counts(const Index3& voxel) const {
    return filter_(voxel_center(voxel, map_.config.voxel_size_m));
  }

  [[nodiscard]] std::optional<VoxelHit> walk(const LatticeRay& ray, double from, double to) const {
    RaySpan span{after_depth(static_cast<float>(from)), after_depth(static_cast<float>(to))};
    if (from <= 0.0) span.enter = kRayStart;
    if (view_voxels_) {
      if (view_voxels_->empty()) return std::nullopt;
      const RaySpan inside = clip(ray, *view_voxels_);
      if (inside.empty()) return std::nullopt;
      span = RaySpan{before(span.enter, inside.enter) ? inside.enter : span.enter, span.exit}.until(inside.exit);
    }
    if (span.empty()) return std::nullopt;
    if (!skip_) return first_voxel(ray, span, sectors_);
    std::optional<VoxelHit> hit;
    const auto enter_sector = [](const Index3&, const Sector*, const RaySpan&) { return true; };
    walk_map(ray, span, sectors_, enter_sector,
             [&](const Index3&, const Sector* sector, int child, const RaySpan& in_brick) {
               if (sector != nullptr && !sector->has_unknown.test(child) && !sector->has_occupied.test(child))
                 return false;
               return walk_cells<kVoxelLevel>(ray, in_brick, [&](const Index3& voxel, const RaySpan& in_voxel) {
                 const VoxelState state =
                     sector == nullptr
                         ? VoxelState::unknown
                         : state_of(sector->bricks[static_cast<std::size_t>(child)].voxel(child_index(voxel)));
                 if (state == VoxelState::empty || (state == VoxelState::unknown && !counts(voxel))) return false;
                 hit = VoxelHit{voxel, state, in_voxel.enter.t};
                 return true;
               });
             });
    return hit;
  }

  /// Tells whether something blocks the light to a voxel.
  [[nodiscard]] bool in_shadow(const VoxelHit& hit, const PinholeCamera& camera, const Pose& T_world_camera, int u,
                               int v) const {
    const double voxel_m = map_.config.voxel_size_m;
    const Eigen::Vector3d light = T_world_camera * Eigen::Vector3d{*emitter_x_, 0.0, 0.0};
    const Eigen::Vector3d target =
        T_world_camera * Eigen::Vector3d{camera.ray(u, v) * (static_cast<double>(hit.t) + 0.25 * voxel_m)};
    const Eigen::Vector3d from = light / voxel_m;
    const Eigen::Vector3f way = ((target - light) / voxel_m).cast<float>();
    if (way.norm() < 1e-3F) return false;
    const LatticeRay ray = make_lattice_ray(lattice_point(from.x(), from.y(), from.z()), way.x(), way.y(), way.z());
    const double length_vox = way.norm();
    const double start = camera.min_range_m / std::max(camera.min_range_m, (target - light).norm());
    const std::optional<VoxelHit> first = walk(ray, start, 1.0);
    if (!first || first->voxel == hit.voxel) return false;
    return static_cast<double>(first->t) * length_vox < length_vox - 2.0;
  }

  const TsdfSnapshot& map_;
  SectorTable sectors_;
  Filter filter_;
  bool filtered_;
  bool skip_;
  std::optional<IndexBox> view_voxels_;
  std::optional<double> emitter_x_;
};

Result<PinholeCamera> camera_for(const Source& source, const MapRequest& request) {
  if (!request.camera && !source.sensor) {
    return Error{Errc::invalid_argument, "no frame came yet: ask with intrinsics (request_camera_intrinsics)", {}};
  }
  PinholeCamera camera = request.camera ? to_camera(*request.camera, 1e-6, source.max_range_m) : *source.sensor;
  camera.min_range_m = std::max(1e-6, request.camera ? request.min_range : 0.0);
  if (camera.width > 8192 || camera.height > 8192)
    return Error{Errc::invalid_argument, "the image is wider or higher than 8192 pixels", {}};
  SACCADE_CHECK(camera.validate());
  return camera;
}

Result<Pose> pose_for(const MapRequest& request) {
  return request.transformation ? to_pose(*request.transformation) : Result<Pose>{Pose::Identity()};
}

/// Numbers of occupied and unknown pixels of a view, and sums of their weights.
struct ViewSums {
  std::uint64_t occupied{0}, unknown{0};
  double score{0.0};
};

double weight_of(const MapRequest& request, const VoxelHit& hit, double distance_m) {
  const bool unknown = hit.state == VoxelState::unknown;
  const double of_distance =
      (unknown ? request.unknown_distance_weight : request.occupied_distance_weight) * distance_m;
  return (unknown ? request.unknown_weight : request.occupied_weight) + of_distance * of_distance;
}

Result<ViewSums> sum_view(const Source& source, const MapRequest& request, const RayCaster& caster,
                          const PinholeCamera& camera, const Pose& T_world_camera) {
  const SensorRays rays = sensor_rays(T_world_camera, source.map.config.voxel_size_m);
  std::vector<ViewSums> rows(static_cast<std::size_t>(camera.height));
  source.executor.parallel_for(rows.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end && !source.cancelled; ++row) {
      ViewSums& sums = rows[row];
      const int v = static_cast<int>(row);
      for (int u = 0; u < camera.width; ++u) {
        const std::optional<VoxelHit> hit = caster.cast(rays, camera, T_world_camera, u, v);
        if (!hit) continue;
        ++(hit->state == VoxelState::unknown ? sums.unknown : sums.occupied);
        sums.score += weight_of(request, *hit, camera.ray(u, v).norm() * static_cast<double>(hit->t));
      }
    }
  });
  SACCADE_CHECK(source.go_on());
  ViewSums total;
  for (const ViewSums& row : rows) {
    total.occupied += row.occupied;
    total.unknown += row.unknown;
    total.score += row.score;
  }
  return total;
}

/// Counts the voxels of the filter, without a view.
Result<ViewSums> count_voxels(const Source& source, const MapRequest& request) {
  const Filter filter{request};
  if (!filter.any())
    return Error{
        Errc::invalid_argument, "without views, voxels are counted in a bounding box or a sphere: give one", {}};
  if (filter.box) SACCADE_CHECK(validate(Region{*filter.box}));
  if (filter.sphere) SACCADE_CHECK(validate(Region{*filter.sphere}));
  constexpr std::int32_t kFar{1 << 29};
  const IndexBox voxels = filter.voxels({{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}}, source.map.config.voxel_size_m);
  ViewSums total;
  if (voxels.empty()) return total;
  if (voxels.count() > 4e9)
    return Error{Errc::invalid_argument, "the filter holds more than 4 thousand million voxels", {}};
  for (std::int32_t z = voxels.lo.z; z < voxels.hi.z; ++z) {
    SACCADE_CHECK(source.go_on());
    voxels.layer(static_cast<std::size_t>(z - voxels.lo.z)).for_each([&](const Index3& voxel) {
      if (!filter(voxel_center(voxel, source.map.config.voxel_size_m))) return;
      const VoxelState state = source.map.grid.state(voxel);
      total.occupied += state == VoxelState::occupied ? 1 : 0;
      total.unknown += state == VoxelState::unknown ? 1 : 0;
    });
  }
  return total;
}

}  // namespace

Result<MapAnswer> view_answer(const Source& source, const MapRequest& request) {
  SACCADE_TRY(const PinholeCamera camera, camera_for(source, request));
  SACCADE_TRY(const Pose T_world_camera, pose_for(request));
  SACCADE_TRY(const SurfaceView view, raycast(source.map, camera, T_world_camera, source.executor));
  SACCADE_CHECK(source.go_on());
  MapAnswer answer;
  answer.width = static_cast<std::uint32_t>(camera.width);
  answer.height = static_cast<std::uint32_t>(camera.height);
  answer.rgb.resize(3 * view.depth.size());
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (!(view.depth(u, v) > 0.0F)) continue;
      const float facing =
          -view.normals(u, v).dot(camera.ray(u, v).cast<float>().normalized());  // light from the camera
      const auto shade = static_cast<std::uint8_t>(std::lround(40.0F + 200.0F * std::clamp(facing, 0.0F, 1.0F)));
      std::fill_n(&answer.rgb[3 * (static_cast<std::size_t>(v) * answer.width + static_cast<std::size_t>(u))], 3,
                  shade);
    }
  }
  return answer;
}

Result<MapAnswer> view_cloud_answer(const Source& source, const MapRequest& request) {
  SACCADE_TRY(const PinholeCamera camera, camera_for(source, request));
  SACCADE_TRY(const Pose T_world_camera, pose_for(request));
  SACCADE_TRY(const SurfaceView surface, raycast(source.map, camera, T_world_camera, source.executor));
  SACCADE_CHECK(source.go_on());
  const RayCaster caster{source, request};
  const SensorRays rays = sensor_rays(T_world_camera, source.map.config.voxel_size_m);
  const auto near_m = static_cast<float>(source.map.config.truncation_m());
  MapAnswer answer;
  PlainCloud& cloud = answer.cloud;
  cloud.fields = {"x", "y", "z", "intensity", "normal_x", "normal_y", "normal_z"};
  cloud.width = static_cast<std::uint32_t>(camera.width);
  cloud.height = static_cast<std::uint32_t>(camera.height);
  cloud.values.resize(std::size_t{cloud.width} * cloud.height * 7);
  source.executor.parallel_for(cloud.height, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end && !source.cancelled; ++row) {
      const int v = static_cast<int>(row);
      for (int u = 0; u < camera.width; ++u) {
        float* point = &cloud.values[(row * cloud.width + static_cast<std::size_t>(u)) * 7];
        const std::optional<VoxelHit> hit = caster.cast(rays, camera, T_world_camera, u, v);
        if (!hit) {
          std::fill_n(point, 3, std::numeric_limits<float>::quiet_NaN());
          continue;
        }
        const bool occupied = hit->state == VoxelState::occupied;
        const float at_surface = surface.depth(u, v);
        const bool has_surface = occupied && at_surface > 0.0F && std::abs(at_surface - hit->t) < near_m;
        const float depth = has_surface && request.accurate_surface ? at_surface : hit->t;
        const Eigen::Vector3d p_camera = camera.ray(u, v) * static_cast<double>(depth);
        const Eigen::Vector3f p = (T_world_camera * p_camera).cast<float>();
        const Eigen::Vector3f n = has_surface
                                      ? Eigen::Vector3f{T_world_camera.linear().cast<float>() * surface.normals(u, v)}
                                      : Eigen::Vector3f::Zero();
        const auto distance = static_cast<float>(p_camera.norm());
        const std::array<float, 7> values{p.x(), p.y(), p.z(), occupied ? distance : -distance, n.x(), n.y(), n.z()};
        std::copy(values.begin(), values.end(), point);
      }
    }
  });
  SACCADE_CHECK(source.go_on());
  return answer;
}

Result<MapAnswer> views_answer(const Source& source, const MapRequest& request) {
  std::vector<ViewSums> sums;
  if (request.views || request.question == Question::view_score) {
    SACCADE_TRY(const PinholeCamera camera, camera_for(source, request));
    const std::vector<PlainPose> views =
        request.views ? *request.views : std::vector{request.transformation.value_or(PlainPose{})};
    if (views.size() > kMostViews) return Error{Errc::invalid_argument, "there are more than 100000 view poses", {}};
    const RayCaster caster{source, request};
    for (std::size_t i = 0; i < views.size(); ++i) {
      const Result<Pose> pose = to_pose(views[i]);
      if (!pose) return Error{pose.error().code, pose.error().message, "view pose " + std::to_string(i)};
      SACCADE_TRY(const ViewSums sum, sum_view(source, request, caster, camera, *pose));
      sums.push_back(sum);
    }
  } else {
    SACCADE_TRY(const ViewSums sum, count_voxels(source, request));
    sums.push_back(sum);
  }
  MapAnswer answer;
  const auto count = static_cast<std::uint32_t>(sums.size());
  if (request.question == Question::voxel_count) {
    for (const ViewSums& sum : sums) answer.counts.insert(answer.counts.end(), {sum.occupied, sum.unknown});
    answer.dimensions = {{"Voxel type", 2, 2}, {"View count", count, 2 * count}};
  } else {
    for (const ViewSums& sum : sums)
      answer.floats.insert(answer.floats.end(), {float(sum.score), float(sum.occupied), float(sum.unknown)});
    answer.dimensions = {{"Score, occupied, unknown", 3, 3}, {"View count", count, 3 * count}};
  }
  return answer;
}

}  // namespace saccade::ros1
