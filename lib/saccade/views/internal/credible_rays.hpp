// SPDX-License-Identifier: Apache-2.0
#pragma once
// CredibleRays: estimates how much of the unknown space that a view looks at it will make known.

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
/// where it passes a support from below or meets its underside, where the robot's own body blocks it, or where no known
/// voxel lies behind it within the sensor's range, so that no return will come. Credit limits it further. Immutable;
/// safe for concurrent use.
class CredibleRays {
 public:
  /// Tells whether the map's workspace is small enough for the test: StateVolume::kMostVoxels. In larger ones, gains
  /// are believed unchanged.
  [[nodiscard]] static bool can_look_through(const TsdfSnapshot& map);
  /// @param sensor with the rows added by tilting. @param trust blind: everything is believed.
  /// Errors: a workspace of too many voxels; those of PlanningContext::own_body. O(voxels of the workspace).
  [[nodiscard]] static Result<CredibleRays> create(const PlanningContext& context, const RegionOfInterest& region,
                                                   const PinholeCamera& sensor, UnknownOutside outside, Trust trust);

  struct Look {
    Promise promise;    ///< believed rays: the voxels in which they end
    double share{1.0};  ///< worth of the believed rays relative to all rays; 1: no ray promises anything
    /// Share of their worth that believed rays are credited; 0: no ray that promises anything is believed.
    double credit{1.0};
  };
  /// Casts the rays from a pose. O(rays · voxels along them).
  [[nodiscard]] Look from(const Pose& T_world_camera) const;

  /// Quick look with fewer rays, ignoring the robot's own body.
  struct Glance {
    double credible{0.0};  ///< believed share of all rays
    double credit{1.0};    ///< as in Look
  };
  /// Computes a glance for each pose; the thread count never changes a bit.
  [[nodiscard]] std::vector<Glance> glances(std::span<const Pose> T_world_camera, const Executor& executor) const;
  /// Computes a Look from each pose.
  [[nodiscard]] std::vector<Look> looks(std::span<const Pose> T_world_camera, const Executor& executor) const;

 private:
  struct Scene;
  explicit CredibleRays(std::shared_ptr<const Scene> scene) : scene_{std::move(scene)} {}
  std::shared_ptr<const Scene> scene_;
};

}  // namespace saccade
