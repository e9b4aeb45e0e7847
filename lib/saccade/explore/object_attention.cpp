// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/object_attention.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "saccade/attention/nearest_segment.hpp"
#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

bool is_scrap(const SegmentMeasures& measures, double scrap_length_m) {
  return measures.sizes_m.maxCoeff() <= scrap_length_m;
}

/// Segments by decreasing saliency, scraps behind all others.
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

Status ObjectAttentionConfig::validate() const {
  SACCADE_CHECK(contours.validate());
  SACCADE_CHECK(segments.validate());
  SACCADE_CHECK(measures.validate());
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "object attention"}; };
  if (!saliency) return fail("a heuristic of saliency is needed");
  if (!(scrap_length_m >= 0.0 && std::isfinite(scrap_length_m))) return fail("the length of scraps is not negative");
  if (!(reach_m > 0.0 && std::isfinite(reach_m))) return fail("the reach around a segment must be positive");
  if (!(rival_share > 0.0 && rival_share <= 1.0)) return fail("the share that makes a rival lies above 0, at most 1");
  return {};
}

std::vector<std::vector<std::uint32_t>> ObjectAttention::contours_of_segments() const {
  std::vector<std::vector<std::uint32_t>> contours_of(surface.segments());
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (segment_of_contour[i] != kUnlabelled)
      contours_of[segment_of_contour[i]].push_back(static_cast<std::uint32_t>(i));
  }
  return contours_of;
}

Sphere ObjectAttention::surroundings(std::uint32_t segment, double reach_m) const {
  SACCADE_EXPECTS(!surface.points_of(segment).empty());
  Sphere sphere{0.5 * (measures[segment].lowest_m + measures[segment].highest_m), 0.0};
  for (const Eigen::Vector3f& p : surface.points_of(segment)) {
    sphere.radius_m = std::max(sphere.radius_m, (p.cast<double>() - sphere.center).norm());
  }
  sphere.radius_m += reach_m;
  return sphere;
}

Result<LiveObjectAttention> LiveObjectAttention::create(const ObjectAttentionConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(LiveContours contours, LiveContours::create(config.contours));
  return LiveObjectAttention{config, std::move(contours)};
}

Status LiveObjectAttention::follow_segments(const TsdfSnapshot& map, const Executor& executor) {
  const std::optional<Box>& workspace = map.config.workspace;
  const std::optional<Box>& followed = config_.segments.within;
  const bool same = workspace.has_value() == followed.has_value() &&
                    (!workspace || (workspace->min == followed->min && workspace->max == followed->max));
  if (!segments_ || !same) {
    config_.segments.within = workspace;
    SACCADE_TRY(segments_, LiveSegments::create(config_.segments));
  }
  segments_->update(map, executor);
  return {};
}

Result<ObjectAttention> LiveObjectAttention::look(const TsdfSnapshot& map, const Executor& executor) {
  Stopwatch stopwatch;
  contours_.update(map, executor);
  std::vector<ContourPoint> contours = contours_.points();
  const double contours_ms = stopwatch.lap_ms();
  SACCADE_CHECK(follow_segments(map, executor));
  const VoxelSegments voxels = segments_->voxels(executor);
  SACCADE_TRY(SegmentedPoints surface, SegmentedPoints::create(voxels.positions_m, voxels.labels, voxels.segments));
  const double segmentation_ms = stopwatch.lap_ms();
  SACCADE_TRY(std::vector<SegmentMeasures> measures, measure_segments(surface, config_.measures, executor));
  std::vector<Saliency> saliency = config_.saliency({surface, measures, config_.measures});
  if (saliency.size() != measures.size()) {
    return Error{Errc::size_mismatch, "a heuristic of saliency must return one value per segment", "object attention"};
  }
  std::vector<std::uint32_t> order = by_saliency(measures, saliency, config_.scrap_length_m);
  const auto scraps = static_cast<std::size_t>(std::count_if(
      measures.begin(), measures.end(), [&](const SegmentMeasures& m) { return is_scrap(m, config_.scrap_length_m); }));
  std::vector<Eigen::Vector3d> places_m;
  for (const ContourPoint& contour : contours) places_m.push_back(contour.position_m);
  std::vector<std::uint32_t> owners = nearest_segments(surface, places_m, executor);
  return ObjectAttention{std::move(contours),
                         std::move(owners),
                         std::move(surface),
                         std::move(measures),
                         std::move(saliency),
                         std::move(order),
                         scraps,
                         contours_ms,
                         segmentation_ms,
                         stopwatch.lap_ms()};
}

}  // namespace saccade
