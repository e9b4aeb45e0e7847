// SPDX-License-Identifier: Apache-2.0
#pragma once
// ObjectAttention: contours and salient segments of a map, and which belong together; LiveObjectAttention: those of a
// map that goes on changing. Thesis §3.1, Algorithm 4, lines 1 to 6 and 8.

#include <memory>
#include <vector>

#include "saccade/attention/saliency.hpp"
#include "saccade/segment/live_segments.hpp"
#include "saccade/view/contour_views.hpp"
#include "saccade/view/live_contours.hpp"

namespace saccade {

struct ObjectAttentionConfig {
  /// Nothing is known that was not observed W_th times: a view needs as many frames, or what it saw has no contour.
  ContourConfig contours;
  MapSegmentsConfig segments;  ///< `within` is the map's workspace, where it has one
  MeasureConfig measures;
  SaliencyHeuristic saliency{objectness()};
  /// Segments that are no longer than this come last, whatever their saliency: scraps at the border of what was seen
  /// stand alone and look round.
  double scrap_length_m{0.03};
  double reach_m{0.2};  ///< unknown space counts within the segment's bounding sphere enlarged by this; thesis §3.1
  /// Among segments at least so salient, as a share of the most salient that has a view worth going to, the view that
  /// gains most is next. Thesis Algorithm 4 takes the most salient segment alone: 1. Decision 11.
  double rival_share{0.5};

  /// invalid_argument unless lengths are positive and finite and there is a heuristic; errors of the parts.
  [[nodiscard]] Status validate() const;
};

/// What there is to look at.
struct ObjectAttention {
  std::vector<ContourPoint> contours;
  std::vector<std::uint32_t> segment_of_contour;  ///< owner of the nearest surface point; kUnlabelled: no surface
  SegmentedPoints surface;                        ///< means of the surface's voxels
  std::vector<SegmentMeasures> measures;          ///< one per segment, as the next
  std::vector<Saliency> saliency;
  std::vector<std::uint32_t> order;  ///< segments, the most salient first, scraps last, ties by index
  std::size_t scraps{0};             ///< how many of these, at the end, are scraps
  double contours_ms{0.0};
  double segmentation_ms{0.0};
  double saliency_ms{0.0};

  /// Contour points of each segment, in their order.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> contours_of_segments() const;
  /// The ball around the box of a segment's points, larger by `reach_m`. Expects a segment with points.
  [[nodiscard]] Sphere surroundings(std::uint32_t segment, double reach_m) const;
};

/// Follows a map; what it sees depends on the map alone. Surface outside the workspace draws no attention. One thread
/// at a time.
class LiveObjectAttention {
 public:
  /// Errors of ObjectAttentionConfig::validate.
  [[nodiscard]] static Result<LiveObjectAttention> create(const ObjectAttentionConfig& config = {});

  /// A map without a surface has no segment. O(what changed since the last call + surface voxels + contour points).
  [[nodiscard]] Result<ObjectAttention> look(const TsdfSnapshot& map, const Executor& executor);

 private:
  LiveObjectAttention(ObjectAttentionConfig config, LiveContours contours)
      : config_{std::move(config)}, contours_{std::move(contours)} {}
  [[nodiscard]] Status follow_segments(const TsdfSnapshot& map, const Executor& executor);

  ObjectAttentionConfig config_;
  LiveContours contours_;
  std::optional<LiveSegments> segments_;  ///< within config_.segments.within
};

}  // namespace saccade
