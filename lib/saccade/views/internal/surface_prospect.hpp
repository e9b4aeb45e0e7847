// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceProspect: the surface of a region that cameras are expected to see.

#include <memory>
#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/views/expected_surface.hpp"
#include "saccade/views/internal/credit.hpp"
#include "saccade/views/lines_of_sight.hpp"
#include "saccade/views/promise.hpp"

namespace saccade {

class ViewDevice;

/// Visible surface of a region. Immutable; safe for concurrent use if the context's own body is.
class SurfaceProspect {
 public:
  /// Creates the prospect. Where the region carries the saliency of all segments, each point is weighted by that of the
  /// nearest segment, relative to the most salient one.
  /// @param sight lines of sight to the points of the surface
  /// @param sensor with the rows added by tilting.
  /// @param doubtful_share share of their area that points behind unknown space count; 0: they are not visible.
  /// Errors: those of PlanningContext::own_body.
  [[nodiscard]] static Result<SurfaceProspect> create(const PlanningContext& context, const RegionOfInterest& region,
                                                      std::shared_ptr<const ExpectedSurface> surface,
                                                      std::shared_ptr<const LinesOfSight> sight,
                                                      const PinholeCamera& sensor, double doubtful_share);

  /// Point of the surface, and the share of its area promised to a camera.
  struct TileVisibility {
    const ExpectedPoint* point;
    double area_cm2;
    std::size_t number;  ///< index among the points of the region
  };
  /// Returns the points within range that face a place and are not behind a support.
  [[nodiscard]] std::vector<TileVisibility> facing(const Eigen::Vector3d& camera_m) const;
  /// Returns those with a line of sight that lie in an image, with their credit from there. The poses, at least one,
  /// share their place.
  [[nodiscard]] std::vector<TileVisibility> visible(std::span<const Pose> T_world_camera) const;
  /// Returns the visible points of several places, the poses of each of which share it. A device traces lines of
  /// sight; nullptr, or an error of the device: the CPU does.
  [[nodiscard]] std::vector<std::vector<TileVisibility>> visible(std::span<const std::span<const Pose>> places,
                                                                 const Executor& executor, ViewDevice* device) const;
  /// Returns the area of the points that lie in the image, cm².
  [[nodiscard]] double area_in_picture(std::span<const TileVisibility> sights, const Pose& T_world_camera) const;
  /// Returns the promise of a pose: visible points in the image that the robot's own body does not hide.
  [[nodiscard]] Promise promise(const Pose& T_world_camera) const;

  [[nodiscard]] const ExpectedSurface& surface() const { return *surface_; }
  [[nodiscard]] bool knows_body() const { return static_cast<bool>(own_body_); }

 private:
  SurfaceProspect(std::shared_ptr<const ExpectedSurface> surface, std::shared_ptr<const LinesOfSight> sight,
                  const PinholeCamera& sensor)
      : surface_{std::move(surface)}, sight_{std::move(sight)}, sensor_{sensor} {}
  /// Returns the share of a point's area that lines of sight leave visible: 1, doubtful_share, or 0.
  [[nodiscard]] double in_sight(const ExpectedPoint& point, const Outlook& outlook) const;
  /// Returns the points that face the place of some poses and lie in one of their images.
  [[nodiscard]] std::vector<TileVisibility> in_pictures(std::span<const Pose> T_world_camera) const;
  /// Returns the shares of in_sight() for the sights of several places, as the device finds them.
  [[nodiscard]] Result<std::vector<double>> shares_on(ViewDevice& device,
                                                      std::span<const std::vector<TileVisibility>> sights,
                                                      std::span<const Eigen::Vector3d> cameras_m) const;
  /// Keeps the sights whose share is not 0, with that share of their area and their credit.
  void keep_visible(std::vector<TileVisibility>& sights, std::span<const double> shares,
                    const Eigen::Vector3d& camera_m) const;
  template <class Visit>
  void for_each_in_picture(std::span<const TileVisibility> sights, const Pose& T_world_camera,
                           const Visit& visit) const;

  std::shared_ptr<const ExpectedSurface> surface_;  ///< never null
  std::shared_ptr<const LinesOfSight> sight_;       ///< never null
  PinholeCamera sensor_;
  double doubtful_share_{0.0};
  [[nodiscard]] double weighed_cm2(std::size_t i) const {
    const double area_cm2 = static_cast<double>(surface_->points[points_[i]].area_cm2);
    return weights_.empty() ? area_cm2 : weights_[i] * area_cm2;
  }

  std::vector<std::size_t> points_;        ///< points of the region
  std::vector<double> weights_;            ///< per point, by saliency; empty: all count alike
  std::vector<Credit::InSight> in_sight_;  ///< per point; empty: all promises were kept
  std::shared_ptr<const Credit> credit_;
  OwnBody own_body_;
};

}  // namespace saccade
