// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/surface_gain.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace saccade {
namespace {

/// Points of the surface that a camera sees from a place, however it is turned.
std::vector<const ExpectedPoint*> visible_from(const ExpectedSurface& surface,
                                               std::span<const ExpectedPoint* const> points,
                                               const Eigen::Vector3d& camera_m, double max_range_m) {
  std::vector<const ExpectedPoint*> visible;
  const Eigen::Vector3f center = camera_m.cast<float>();
  const auto reach_m = static_cast<float>(max_range_m);
  for (const ExpectedPoint* point : points) {
    if ((point->position_m - center).squaredNorm() > 4.0F * reach_m * reach_m) continue;  // no field of view is so wide
    if (surface.is_visible(*point, camera_m)) visible.push_back(point);
  }
  return visible;
}

double area_in_image(std::span<const ExpectedPoint* const> points, const Pose& T_world_camera,
                     const PinholeCamera& camera) {
  const Eigen::Isometry3f T_camera_world = T_world_camera.inverse(Eigen::Isometry).cast<float>();
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto left = static_cast<float>(-0.5 - camera.cx);
  const auto right = static_cast<float>(camera.width - 0.5 - camera.cx);
  const auto top = static_cast<float>(-0.5 - camera.cy);
  const auto bottom = static_cast<float>(camera.height - 0.5 - camera.cy);
  double area_cm2{0.0};
  for (const ExpectedPoint* point : points) {
    const Eigen::Vector3f p = T_camera_world * point->position_m;
    if (p.z() < static_cast<float>(camera.min_range_m) || p.z() > static_cast<float>(camera.max_range_m)) continue;
    const float u = fx * p.x();
    const float v = fy * p.y();
    if (u < left * p.z() || u >= right * p.z() || v < top * p.z() || v >= bottom * p.z()) continue;
    area_cm2 += static_cast<double>(point->area_cm2);
  }
  return area_cm2;
}

}  // namespace

Status SurfaceGainConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "surface gain"}; };
  SACCADE_CHECK(sensor.validate());
  if (!(tilt_rad >= 0.0 && std::isfinite(tilt_rad))) return fail("the tilt must not be negative");
  return surface.validate();
}

SurfaceGain::SurfaceGain(const SurfaceGainConfig& config)
    : config_{config}, widened_{widened_vertically(config_.sensor, config_.tilt_rad)} {
  SACCADE_EXPECTS(config_.validate().ok());
}

Result<std::vector<double>> SurfaceGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                  std::span<const Pose> T_world_camera) {
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (T_world_camera[i].matrix().allFinite()) continue;
    return Error{Errc::invalid_argument, "pose " + std::to_string(i) + " contains NaN or infinity", "surface gain"};
  }
  SACCADE_TRY(const ExpectedSurface surface, expected_surface(context.map, config_.surface, context.executor));
  std::vector<const ExpectedPoint*> points;
  for (const ExpectedPoint& point : surface.points) {
    if (contains(region.bounds, point.position_m.cast<double>())) points.push_back(&point);
  }
  const std::vector<std::size_t> starts = starts_of_centers(T_world_camera);
  std::vector<double> gains(T_world_camera.size());
  context.executor.parallel_for(starts.size() - 1, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3d center = T_world_camera[starts[s]].translation();
      const auto visible = visible_from(surface, points, center, widened_.max_range_m);
      for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
        gains[i] = area_in_image(visible, T_world_camera[i], widened_);
      }
    }
  });
  return gains;
}

}  // namespace saccade
