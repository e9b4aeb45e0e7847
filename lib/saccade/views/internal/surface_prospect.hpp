// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceProspect: what cameras are expected to see of a region's surface, from where.

#include <memory>
#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/views/expected_surface.hpp"
#include "saccade/views/internal/credit.hpp"
#include "saccade/views/promise.hpp"

namespace saccade {

/// Immutable; safe for concurrent use, where the context's own body is.
class SurfaceProspect {
 public:
  /// Where the region comes with the saliency of all segments, each point counts by that of the segment nearest to it,
  /// as a share of the most salient one's.
  /// @param sensor with the rows that tilting adds.
  /// @param doubtful_share of their area that points count for behind unknown space; 0: there they are not visible.
  /// Errors: those of PlanningContext::own_body.
  [[nodiscard]] static Result<SurfaceProspect> create(const PlanningContext& context, const RegionOfInterest& region,
                                                      std::shared_ptr<const ExpectedSurface> surface,
                                                      const PinholeCamera& sensor, double doubtful_share);

  /// A point of the surface, and how much of its area is promised to a camera.
  struct Sight {
    const ExpectedPoint* point;
    double area_cm2;
    std::size_t number;  ///< among the points of the region
  };
  /// Points within range that face a place and are not behind a support.
  [[nodiscard]] std::vector<Sight> facing(const Eigen::Vector3d& camera_m) const;
  /// Those with a line of sight that lie in a picture, with the credit that they have from there. The poses share their
  /// place, and are one at least.
  [[nodiscard]] std::vector<Sight> visible(std::span<const Pose> T_world_camera) const;
  /// Area of the points that lie in the picture, cm².
  [[nodiscard]] double area_in_picture(std::span<const Sight> sights, const Pose& T_world_camera) const;
  /// Area of visible points in the picture that the robot's own body does not hide; their voxels.
  [[nodiscard]] Promise promise(const Pose& T_world_camera) const;

  [[nodiscard]] const ExpectedSurface& surface() const { return *surface_; }
  [[nodiscard]] bool knows_body() const { return static_cast<bool>(own_body_); }

 private:
  SurfaceProspect(std::shared_ptr<const ExpectedSurface> surface, const PinholeCamera& sensor)
      : surface_{std::move(surface)}, sensor_{sensor} {}
  /// The share of a point's area that lines of sight leave: all of it, doubtful_share, or nothing.
  [[nodiscard]] double in_sight(const ExpectedPoint& point, const Eigen::Vector3d& camera_m) const;
  template <class Visit>
  void for_each_in_picture(std::span<const Sight> sights, const Pose& T_world_camera, const Visit& visit) const;

  std::shared_ptr<const ExpectedSurface> surface_;  ///< never null
  PinholeCamera sensor_;
  double doubtful_share_{0.0};
  [[nodiscard]] double weighed_cm2(std::size_t i) const {
    const double area_cm2 = static_cast<double>(surface_->points[points_[i]].area_cm2);
    return weights_.empty() ? area_cm2 : weights_[i] * area_cm2;
  }

  std::vector<std::size_t> points_;        ///< those of the region
  std::vector<double> weights_;            ///< by saliency, one for each of these; empty: all count alike
  std::vector<Credit::InSight> in_sight_;  ///< one for each of these; empty: all promises were kept
  std::shared_ptr<const Credit> credit_;
  OwnBody own_body_;
};

}  // namespace saccade
