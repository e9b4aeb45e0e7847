// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/view_generator.hpp"

#include "saccade/attention/salient_objects.hpp"
#include "saccade/attention/segmented_points.hpp"

namespace saccade {

std::vector<std::vector<std::uint32_t>> ContourSet::points_of_segments(std::size_t segments) const {
  std::vector<std::vector<std::uint32_t>> of_segments(segments);
  for (std::size_t i = 0; i < segment_of_point.size(); ++i) {
    if (segment_of_point[i] != kUnlabelled) of_segments[segment_of_point[i]].push_back(static_cast<std::uint32_t>(i));
  }
  return of_segments;
}

ContourSet contours_of(std::vector<ContourPoint> points, const SalientSurface& surface, const Executor& executor) {
  std::vector<Eigen::Vector3d> places_m;
  places_m.reserve(points.size());
  for (const ContourPoint& point : points) places_m.push_back(point.position_m);
  std::vector<std::uint32_t> segments = nearest_segments(surface.points, places_m, executor);
  return {std::move(points), std::move(segments)};
}

Result<ViewCandidates> SphereViews::views(const PlanningContext& /*context*/, const RegionOfInterest& region) {
  const Box around = bounds(region.bounds);
  SACCADE_TRY(const std::vector<ViewCandidate> candidates, view_sphere(0.5 * (around.min + around.max), sphere_));
  return ViewCandidates{poses_of(candidates)};
}

ContourViews::ContourViews(ContourViewConfig views, const ContourConfig& contours)
    : views_{std::move(views)}, contours_{LiveContours::create(contours).value()} {
  SACCADE_EXPECTS(views_.validate().ok());
}

void ContourViews::follow(const PlanningContext& context, const std::shared_ptr<const SalientSurface>& surface) {
  if (surface && surface == surface_) return;  // a surface belongs to one state of the map
  contours_.update(context.map, context.executor);
  set_ = std::make_shared<const ContourSet>(surface ? contours_of(contours_.points(), *surface, context.executor)
                                                    : ContourSet{contours_.points(), {}});
  surface_ = surface;
  of_segment_.clear();
  if (surface) of_segment_ = set_->points_of_segments(surface->points.segments());
}

Result<ViewCandidates> ContourViews::views(const PlanningContext& context, const RegionOfInterest& region) {
  follow(context, region.surface);
  ViewCandidates found{{}, set_->points.size() * views_.views_per_point(), set_};
  std::vector<ContourPoint> chosen;
  const bool of_segment = region.surface && region.segment != RegionOfInterest::kAllSegments;
  if (of_segment) {
    for (const std::uint32_t point : of_segment_[region.segment]) chosen.push_back(set_->points[point]);
  }
  SACCADE_TRY(found.T_world_camera, contour_views(of_segment ? chosen : set_->points, views_));
  return found;
}

}  // namespace saccade
