// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/fixed_views.hpp"

#include <cmath>
#include <numbers>

#include "saccade/core/seeded_random.hpp"

namespace saccade {

using Eigen::Vector3d;

std::vector<Pose> hemisphere_views(const Vector3d& center, double radius_m, std::size_t count) {
  SACCADE_EXPECTS(count > 0 && radius_m > 0.0);
  const double golden_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Pose> views;
  views.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    // Equal steps of height are equal areas of a sphere.
    const double height = 1.0 - (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double around = std::sqrt(1.0 - height * height);
    const double longitude_rad = static_cast<double>(i) * golden_rad;
    const Vector3d outward{around * std::cos(longitude_rad), around * std::sin(longitude_rad), height};
    views.push_back(look_at(center + radius_m * outward, center));
  }
  return views;
}

Status ShellViewsConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "shell of views"}; };
  if (!(std::isfinite(inner_half_edge_m) && inner_half_edge_m > 0.0)) return fail("the inner cube must be positive");
  if (!(std::isfinite(outer_radius_m) && outer_radius_m > 1.1 * inner_half_edge_m)) {
    return fail("the sphere must reach beyond the inner cube");
  }
  if (count == 0) return fail("at least one view is needed");
  return {};
}

Result<std::vector<Pose>> shell_views(const Vector3d& center, const ShellViewsConfig& config) {
  SACCADE_CHECK(config.validate());
  SeededRandom random{config.seed};
  std::vector<Pose> views;
  views.reserve(config.count);
  while (views.size() < config.count) {
    Vector3d offset{Vector3d::Zero()};
    for (double& coordinate : offset) coordinate = random.uniform(-config.outer_radius_m, config.outer_radius_m);
    if (offset.norm() > config.outer_radius_m || offset.cwiseAbs().maxCoeff() < config.inner_half_edge_m) continue;
    views.push_back(look_at(center + offset, center));
  }
  return views;
}

Result<ViewCandidates> FixedViews::views(const PlanningContext& /*context*/, const RegionOfInterest& /*region*/) {
  return ViewCandidates{*T_world_camera_, T_world_camera_->size()};
}

}  // namespace saccade
