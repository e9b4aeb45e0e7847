// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewGenerator: candidate view poses of a region; SphereViews and ContourViews.

#include <memory>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/attention/region_of_interest.hpp"
#include "saccade/views/contours.hpp"
#include "saccade/views/view_sphere.hpp"

namespace saccade {

/// Contour points of a map, and their segments.
struct ContourSet {
  std::vector<ContourPoint> points;
  /// Segment of the surface point nearest to each; kUnlabelled: no surface is near. Empty without segments.
  std::vector<std::uint32_t> segment_of_point;

  /// Returns the indices of the points of each of `segments` segments, in their order.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> points_of_segments(std::size_t segments) const;
};
/// Finds the segment of each point. O(points · log surface).
[[nodiscard]] ContourSet contours_of(std::vector<ContourPoint> points, const SalientSurface& surface,
                                     const Executor& executor);

/// View poses, and data about them for the record of a view.
struct ViewCandidates {
  std::vector<Pose> T_world_camera;
  std::size_t in_all{0};                         ///< poses of all regions of the map, where known
  std::shared_ptr<const ContourSet> contours{};  ///< contours that the poses look at; nullptr: none
};

/// Generator of views. One caller at a time; the views depend on the context and the region alone.
class ViewGenerator {
 public:
  virtual ~ViewGenerator() = default;
  /// @return poses from which the region might be visible, whether the robot can reach them or not.
  [[nodiscard]] virtual Result<ViewCandidates> views(const PlanningContext& context,
                                                     const RegionOfInterest& region) = 0;
};

/// View sphere around the centre of the region's box. Thesis §2.2.3, Fig. 2.5.
class SphereViews final : public ViewGenerator {
 public:
  explicit SphereViews(ViewSphereConfig sphere = {}) : sphere_{std::move(sphere)} {}
  /// Errors of view_sphere.
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& context, const RegionOfInterest& region) override;

 private:
  ViewSphereConfig sphere_;
};

/// Views of the contours nearest to the region's segment (thesis §3.1, Algorithm 4, lines 8 and 9), or of all contours
/// of the map for a region without a segment. Follows the map from call to call.
class ContourViews final : public ViewGenerator {
 public:
  /// Expects valid configurations.
  explicit ContourViews(ContourViewConfig views = {}, const ContourConfig& contours = {});
  /// Errors of contour_views.
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& context, const RegionOfInterest& region) override;

 private:
  void follow(const PlanningContext& context, const std::shared_ptr<const SalientSurface>& surface);

  ContourViewConfig views_;
  LiveContours contours_;
  std::shared_ptr<const ContourSet> set_;          ///< contours of the last map seen
  std::shared_ptr<const SalientSurface> surface_;  ///< surface that set_ belongs to
  std::vector<std::vector<std::uint32_t>> of_segment_;
};

}  // namespace saccade
