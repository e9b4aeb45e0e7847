// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/surface_views.hpp"

#include <cmath>
#include <map>

#include "saccade/map/voxel_index.hpp"

namespace saccade {

Status SurfaceViewsConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "surface views"}; };
  if (!(cell_m > 0.0 && std::isfinite(cell_m))) return fail("the cells of spheres must be positive and finite");
  if (!(least_cm2 > 0.0 && std::isfinite(least_cm2))) return fail("the least area of a cell must be positive");
  SACCADE_CHECK(sphere.validate());
  return surface.validate();
}

SurfaceViews::SurfaceViews(std::shared_ptr<ViewGenerator> contours, const SurfaceViewsConfig& config)
    : contours_{std::move(contours)}, config_{config} {
  SACCADE_EXPECTS(config_.validate().ok());
}

Result<ViewCandidates> SurfaceViews::views(const PlanningContext& context, const RegionOfInterest& region) {
  SACCADE_TRY(ViewCandidates found, contours_->views(context, region));
  SACCADE_TRY(const auto surface, expected_surface(context, config_.surface));
  struct Cell {
    Eigen::Vector3d weighed_m{Eigen::Vector3d::Zero()};
    double area_cm2{0.0};
  };
  const auto before = [](const Index3& a, const Index3& b) { return zyx_less(a, b); };
  std::map<Index3, Cell, decltype(before)> cells{before};
  for (const ExpectedPoint& point : surface->points) {
    const Eigen::Vector3d p = point.position_m.cast<double>();
    if (!contains(region.bounds, p)) continue;
    Cell& cell = cells[voxel_at(p, config_.cell_m)];
    const auto area_cm2 = static_cast<double>(point.area_cm2);
    cell.weighed_m += area_cm2 * p;
    cell.area_cm2 += area_cm2;
  }
  found.in_all = std::max(found.in_all, found.T_world_camera.size());
  for (const auto& [index, cell] : cells) {
    if (cell.area_cm2 < config_.least_cm2) continue;
    SACCADE_TRY(const std::vector<ViewCandidate> around, view_sphere(cell.weighed_m / cell.area_cm2, config_.sphere));
    const std::vector<Pose> poses = poses_of(around);
    found.T_world_camera.insert(found.T_world_camera.end(), poses.begin(), poses.end());
    found.in_all += poses.size();
  }
  return found;
}

}  // namespace saccade
