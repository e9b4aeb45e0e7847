// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/salient_objects.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace saccade {
namespace {

bool is_scrap(const SegmentMeasures& measures, double scrap_length_m) {
  return measures.sizes_m.maxCoeff() <= scrap_length_m;
}

/// Returns segments by decreasing saliency, scraps after all others.
std::vector<std::uint32_t> by_saliency(std::span<const SegmentMeasures> measures, std::span<const Saliency> saliency,
                                       double scrap_length_m) {
  std::vector<std::uint32_t> order(measures.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const bool is_last = is_scrap(measures[b], scrap_length_m);
    if (is_scrap(measures[a], scrap_length_m) != is_last) return is_last;
    return saliency[a].value > saliency[b].value;
  });
  return order;
}

}  // namespace

Status SalientObjectsConfig::validate() const {
  SACCADE_CHECK(segments.validate());
  SACCADE_CHECK(measures.validate());
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "object attention"}; };
  if (!saliency) return fail("a heuristic of saliency is needed");
  if (!(scrap_length_m >= 0.0 && std::isfinite(scrap_length_m))) return fail("the length of scraps is not negative");
  if (!(reach_m > 0.0 && std::isfinite(reach_m))) return fail("the reach around a segment must be positive");
  return {};
}

Sphere SalientSurface::surroundings(std::uint32_t segment, double reach_m) const {
  SACCADE_EXPECTS(!points.points_of(segment).empty());
  Sphere sphere{0.5 * (measures[segment].lowest_m + measures[segment].highest_m), 0.0};
  for (const Eigen::Vector3f& p : points.points_of(segment)) {
    sphere.radius_m = std::max(sphere.radius_m, (p.cast<double>() - sphere.center).norm());
  }
  sphere.radius_m += reach_m;
  return sphere;
}

SalientObjects::SalientObjects(SalientObjectsConfig config) : config_{std::move(config)} {
  SACCADE_EXPECTS(config_.validate().ok());
}

Result<SegmentedPoints> SalientObjects::segment(const PlanningContext& context) {
  const std::optional<Box>& workspace = context.map.config.workspace;
  const std::optional<Box>& followed = config_.segments.within;
  const bool same = workspace.has_value() == followed.has_value() &&
                    (!workspace || (workspace->min == followed->min && workspace->max == followed->max));
  if (!segments_ || !same) {
    config_.segments.within = workspace;
    SACCADE_TRY(segments_, LiveSegments::create(config_.segments));
  }
  segments_->update(context.map, context.executor);
  const VoxelSegments voxels = segments_->voxels(context.executor);
  return SegmentedPoints::create(voxels.positions_m, voxels.labels, voxels.segments);
}

Result<std::shared_ptr<const SalientSurface>> SalientObjects::look(const PlanningContext& context) {
  SACCADE_TRY(SegmentedPoints points, context.measure(Phase::segmentation, [&] { return segment(context); }));
  SACCADE_TRY(std::vector<SegmentMeasures> measures, measure_segments(points, config_.measures, context.executor));
  std::vector<Saliency> saliency = config_.saliency({points, measures, config_.measures});
  if (saliency.size() != measures.size()) {
    return Error{Errc::size_mismatch, "a heuristic of saliency must return one value per segment", "object attention"};
  }
  std::vector<std::uint32_t> order = by_saliency(measures, saliency, config_.scrap_length_m);
  const auto scraps = static_cast<std::size_t>(std::count_if(
      measures.begin(), measures.end(), [&](const SegmentMeasures& m) { return is_scrap(m, config_.scrap_length_m); }));
  return std::make_shared<const SalientSurface>(
      SalientSurface{std::move(points), std::move(measures), std::move(saliency), std::move(order), scraps});
}

Result<std::vector<RegionOfInterest>> SalientWorkspace::regions(const PlanningContext& context) {
  SACCADE_TRY(std::vector<RegionOfInterest> regions, workspace_.regions(context));
  SACCADE_TRY(regions.front().surface, objects_.look(context));
  regions.front().segment = RegionOfInterest::kAllSegments;
  return regions;
}

Result<std::vector<RegionOfInterest>> SalientObjects::regions(const PlanningContext& context) {
  SACCADE_TRY(const std::shared_ptr<const SalientSurface> surface, look(context));
  std::vector<RegionOfInterest> regions;
  for (std::size_t rank = 0; rank < surface->order.size(); ++rank) {
    const std::uint32_t segment = surface->order[rank];
    if (surface->points.points_of(segment).empty()) continue;
    RegionOfInterest& region = regions.emplace_back();
    region.bounds = surface->surroundings(segment, config_.reach_m);
    region.saliency = surface->saliency[segment].value;
    region.origin = AttentionOrigin::segment;
    region.why = surface->saliency[segment].why;
    region.rival = rank + surface->scraps < surface->order.size();
    region.surface = surface;
    region.segment = segment;
  }
  return regions;
}

}  // namespace saccade
