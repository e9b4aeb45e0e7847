// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/gain_problem.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

constexpr double kFarthest_vox{1 << 28};  // limit of coordinates of poses and regions
constexpr double kLongestRay_vox{1 << 22};

Error invalid(std::string what) { return {Errc::invalid_argument, std::move(what), std::string{kEvaluation}}; }

Status check_poses(std::span<const Pose> poses, double voxel_size_m) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Matrix3d R = poses[i].linear();
    if (!poses[i].matrix().allFinite()) return invalid("pose " + std::to_string(i) + " contains NaN or infinity");
    if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > kRotationTolerance || R.determinant() <= 0.0) {
      return invalid("pose " + std::to_string(i) + " is not a rotation");
    }
    if (poses[i].translation().cwiseAbs().maxCoeff() / voxel_size_m > kFarthest_vox) {
      return invalid("pose " + std::to_string(i) + " lies too far from the origin");
    }
  }
  return {};
}

Status check_region(const Region& region, double voxel_size_m) {
  SACCADE_CHECK(validate(region));
  const Box box = bounds(region);
  if (std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()) / voxel_size_m > kFarthest_vox) {
    return invalid("the region reaches too far from the origin");
  }
  return {};
}

/// Rays of poses within reach of the region, and the space around them up to the region.
struct Views {
  std::vector<std::size_t> poses;
  std::vector<SensorRays> rays;
  IndexBox domain;
};

Views views_within_reach(std::span<const Pose> poses, const IndexBox& region, double reach, double voxel_size_m) {
  Views views{{}, {}, region};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const SensorRays rays = sensor_rays(poses[i], voxel_size_m);
    const Index3& voxel = rays.origin.voxel;
    if (!within_reach(voxel, region, reach)) continue;
    views.poses.push_back(i);
    views.rays.push_back(rays);
    views.domain = views.domain.hull(IndexBox::cube(voxel, 1));
  }
  return views;
}

void make_jobs(const Views& views, const Region& region, const GainSavings& savings, GainProblem& problem) {
  const StopGrid& grid = problem.grid;
  std::vector<GainJob>& jobs = problem.jobs;
  std::unordered_map<LatticeKey, std::size_t, LatticeHash> lattices;
  for (std::size_t i = 0; i < views.poses.size(); ++i) {
    const SensorRays& rays = views.rays[i];
    if (savings.blocked_camera && grid.stops(rays.origin.voxel)) continue;
    const PixelAxes& pixels = problem.axes[static_cast<std::size_t>(rays.quarter_turns)];
    CastWindow window = savings.region_rays
                            ? window_of(rays, pixels, grid.scoring_voxels(), region, problem.voxel_size_m)
                            : whole_image(rays, pixels);
    if (window.empty()) continue;
    const auto [lattice, is_new] = lattices.try_emplace(key_of(rays), problem.lattices.size());
    if (is_new) problem.lattices.emplace_back();
    std::vector<std::size_t>& same = problem.lattices[lattice->second];
    const auto shared =
        std::find_if(same.begin(), same.end(), [&](std::size_t job) { return jobs[job].window.same_rays(window); });
    if (savings.shared_lattice && shared != same.end()) {
      jobs[*shared].poses.push_back(views.poses[i]);
      continue;
    }
    if (savings.region_rays) window.columns = column_ranges(window, region, problem.voxel_size_m);
    same.push_back(jobs.size());
    jobs.push_back({std::move(window), {views.poses[i]}});
  }
}

}  // namespace

LatticeKey key_of(const SensorRays& rays) {
  LatticeKey key{std::bit_cast<std::uint32_t>(rays.origin.voxel.x), std::bit_cast<std::uint32_t>(rays.origin.voxel.y),
                 std::bit_cast<std::uint32_t>(rays.origin.voxel.z)};
  for (std::size_t i = 0; i < 3; ++i) {
    key[3 + i] = std::bit_cast<std::uint32_t>(rays.origin.fraction[i]);
    key[6 + i] = std::bit_cast<std::uint32_t>(rays.x[i]);
    key[9 + i] = std::bit_cast<std::uint32_t>(rays.y[i]);
    key[12 + i] = std::bit_cast<std::uint32_t>(rays.z[i]);
  }
  return key;
}

double longest_ray_vox(const PinholeCamera& camera, double voxel_size_m) {
  const Eigen::Vector3d corner{std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx,
                               std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy, 1.0};
  return camera.max_range_m * corner.norm() / voxel_size_m + 2.0;
}

IndexBox region_in_workspace(const Region& region, const TsdfConfig& config) {
  const IndexBox box = voxels_around(region, config.voxel_size_m);
  return config.workspace ? box.intersection(voxels_with_center_in(*config.workspace, config.voxel_size_m)) : box;
}

bool within_reach(const Index3& voxel, const IndexBox& box, double reach) {
  const auto near = [reach](std::int32_t x, std::int32_t lo, std::int32_t hi) {
    return static_cast<double>(lo) - x <= reach && static_cast<double>(x) - hi <= reach;
  };
  return near(voxel.x, box.lo.x, box.hi.x) && near(voxel.y, box.lo.y, box.hi.y) && near(voxel.z, box.lo.z, box.hi.z);
}

Status GainConfig::validate() const {
  SACCADE_CHECK(sensor.validate());
  if (!(tilt_rad >= 0.0)) return invalid("the tilt must not be negative");
  const double half_rad =
      std::max(std::atan((sensor.cy + 0.5) / sensor.fy), std::atan((sensor.height - 0.5 - sensor.cy) / sensor.fy));
  if (!(half_rad + tilt_rad < 0.49 * std::numbers::pi)) return invalid("the tilt opens the view to 180 degrees");
  return {};
}

Status check_evaluation(const TsdfConfig& map, const Region& region, std::span<const Pose> T_world_camera,
                        const GainConfig& config) {
  SACCADE_CHECK(map.validate());
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(check_region(region, map.voxel_size_m));
  SACCADE_CHECK(check_poses(T_world_camera, map.voxel_size_m));
  const PinholeCamera sensor = widened_vertically(config.sensor, config.tilt_rad);
  SACCADE_CHECK(sensor.validate());
  if (longest_ray_vox(sensor, map.voxel_size_m) > kLongestRay_vox) {
    return invalid("the sensor's range spans too many voxels; shorten it");
  }
  return {};
}

Result<GainProblem> GainProblem::prepare(const TsdfSnapshot& map, const Region& region,
                                         std::span<const Pose> T_world_camera, const GainConfig& config,
                                         const Executor& executor, const Progress& progress) {
  Stopwatch clock;
  const auto check_cancelled = [&]() -> Status {
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", std::string{kEvaluation}};
    return {};
  };
  const double voxel_size_m = map.config.voxel_size_m;
  SACCADE_CHECK(check_evaluation(map.config, region, T_world_camera, config));
  const PinholeCamera sensor = widened_vertically(config.sensor, config.tilt_rad);
  const double reach = longest_ray_vox(sensor, voxel_size_m);

  GainProblem problem;
  problem.limits = {static_cast<float>(sensor.min_range_m), static_cast<float>(sensor.max_range_m), config.savings};
  problem.voxel_size_m = voxel_size_m;
  problem.rays_total = std::uint64_t{T_world_camera.size()} * static_cast<std::uint64_t>(sensor.width) *
                       static_cast<std::uint64_t>(sensor.height);
  const IndexBox region_voxels = region_in_workspace(region, map.config);
  if (region_voxels.empty()) return problem;
  const Views views = views_within_reach(T_world_camera, region_voxels, reach, voxel_size_m);
  if (views.poses.empty()) return problem;
  SACCADE_CHECK(check_cancelled());
  SACCADE_TRY(problem.grid, StopGrid::build(map, region, config.unknown_outside, views.domain,
                                            config.savings.exposed_voxels, executor));
  SACCADE_CHECK(check_cancelled());
  if (config.savings.footprints) problem.faces = EntryFaces{problem.grid, executor};
  SACCADE_CHECK(check_cancelled());
  for (int turns = 0; turns < 4; ++turns) problem.axes[static_cast<std::size_t>(turns)] = pixel_axes(sensor, turns);
  if (!problem.grid.scoring_voxels().empty()) make_jobs(views, region, config.savings, problem);
  problem.prepare_ms = clock.lap_ms();
  return problem;
}

}  // namespace saccade
