// SPDX-License-Identifier: Apache-2.0
#pragma once
// CredibleRays: how much of the unknown space that a view looks at it will make known.

#include <memory>
#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/attention/region_of_interest.hpp"
#include "saccade/views/gain.hpp"
#include "saccade/views/internal/credit.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

/// A few hundred rays of a sensor. A ray that first meets unknown space of a region is a promise. It is not believed
/// where it passes a support from below, or meets the underside of one; where the robot's own body is before it; where
/// nothing that is known lies behind it within the sensor's range, so that no return will come; and not more than
/// Credit allows. Immutable; safe for concurrent use.
class CredibleRays {
 public:
  /// Whether the map's workspace is small enough to be looked through: StateVolume::kMostVoxels. Where it is not, gains
  /// are believed as they are.
  [[nodiscard]] static bool can_look_through(const TsdfSnapshot& map);
  /// @param sensor with the rows that tilting adds. @param trust blind: everything is believed.
  /// Errors: a workspace of too many voxels; those of PlanningContext::own_body. O(voxels of the workspace).
  [[nodiscard]] static Result<CredibleRays> create(const PlanningContext& context, const RegionOfInterest& region,
                                                   const PinholeCamera& sensor, UnknownOutside outside, Trust trust);

  struct Look {
    Promise promise;    ///< rays that are believed, the voxels in which they end
    double share{1.0};  ///< promised by them, of what all rays promise; 1: none promises anything
    /// The share that rays are believed of those that might be kept at all; 0: none of those that promise anything may.
    double credit{1.0};
  };
  /// O(rays · voxels along them).
  [[nodiscard]] Look from(const Pose& T_world_camera) const;

  /// A quick look by fewer rays, past the robot's own body.
  struct Glance {
    double credible{0.0};  ///< share of all rays that are believed
    double credit{1.0};    ///< as of a Look
  };
  /// Glances one by one for each pose; the thread count never changes a bit.
  [[nodiscard]] std::vector<Glance> glances(std::span<const Pose> T_world_camera, const Executor& executor) const;
  /// A Look from each pose.
  [[nodiscard]] std::vector<Look> looks(std::span<const Pose> T_world_camera, const Executor& executor) const;

 private:
  struct Scene;
  explicit CredibleRays(std::shared_ptr<const Scene> scene) : scene_{std::move(scene)} {}
  std::shared_ptr<const Scene> scene_;
};

}  // namespace saccade
