// SPDX-License-Identifier: Apache-2.0
#pragma once
// SalientObjects: attention to segments that look like objects. SalientSurface: the segmented surface. Thesis §3.1,
// Algorithm 4, lines 3 to 6.

#include <memory>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/segment/live_segments.hpp"

namespace saccade {

struct SalientObjectsConfig {
  MapSegmentsConfig segments;  ///< `within` is the map's workspace, where it has one
  MeasureConfig measures;
  SaliencyHeuristic saliency{objectness()};
  /// Length up to which segments are scraps and come last, whatever their saliency: scraps at the border of seen space
  /// are isolated and look round.
  double scrap_length_m{0.03};
  double reach_m{0.2};  ///< enlargement of the segment's bounding sphere within which unknown space counts; thesis §3.1

  /// Answers invalid_argument unless lengths are positive and finite and there is a heuristic; errors of the parts.
  [[nodiscard]] Status validate() const;
};

/// Segmented surface of a map, with the saliency of its segments.
struct SalientSurface {
  SegmentedPoints points;                 ///< means of the surface's voxels
  std::vector<SegmentMeasures> measures;  ///< one per segment, as the next
  std::vector<Saliency> saliency;
  std::vector<std::uint32_t> order;  ///< segments, most salient first, scraps last, ties by index
  std::size_t scraps{0};             ///< number of scraps, at the end of `order`

  /// Returns the ball around the box of a segment's points, enlarged by `reach_m`. Expects a segment with points.
  [[nodiscard]] Sphere surroundings(std::uint32_t segment, double reach_m) const;
};

/// Segments of the map's surface by saliency. A region is the surroundings of one segment; all have index 0, and scraps
/// are not rivals. Follows the map from call to call; surface outside the workspace is ignored.
class SalientObjects final : public AttentionSource {
 public:
  /// Expects a valid configuration.
  explicit SalientObjects(SalientObjectsConfig config = {});

  /// O(changes since the last call + surface voxels). Errors of the heuristic: size_mismatch when it does not return
  /// one value per segment.
  [[nodiscard]] Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) override;
  /// Returns only the surface. A map without a surface has no segment.
  [[nodiscard]] Result<std::shared_ptr<const SalientSurface>> look(const PlanningContext& context);

 private:
  [[nodiscard]] Result<SegmentedPoints> segment(const PlanningContext& context);

  SalientObjectsConfig config_;
  std::optional<LiveSegments> segments_;  ///< within config_.segments.within
};

/// The map's workspace as one region, with the saliency of all segments in it.
class SalientWorkspace final : public AttentionSource {
 public:
  /// Creates the source. Expects a valid configuration.
  explicit SalientWorkspace(SalientObjectsConfig config = {}) : objects_{std::move(config)} {}
  /// Errors of WholeWorkspace and SalientObjects.
  [[nodiscard]] Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) override;

 private:
  SalientObjects objects_;
  WholeWorkspace workspace_;
};

}  // namespace saccade
