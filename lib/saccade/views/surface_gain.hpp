// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceGain: values a view by the area of surface that it is expected to show.

#include "saccade/views/expected_surface.hpp"
#include "saccade/views/gain.hpp"
#include "saccade/views/lines_of_sight.hpp"

namespace saccade {

struct SurfaceGainConfig {
  PinholeCamera sensor{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 6.0};  ///< field of view and range
  double tilt_rad{0.0};  ///< the real sensor is tilted by ± this angle: see widened_vertically
  /// Views expected to show less than this share of the surface seen so far are not worth taking.
  double least_share{0.005};
  /// Share of their area that points behind unknown space count, once the other promises are too small or were broken;
  /// 0: none. It lets an object without a table or walls behind it be seen from all sides, although no return shows
  /// that the space around it is empty.
  double doubtful_share{0.1};
  /// Ranks only the best roll of each camera centre, before the robot's own body is considered: for a choice among many
  /// places (Foresight).
  bool one_roll{false};
  ExpectedSurfaceConfig surface{};

  /// Answers invalid_argument for a bad sensor, tilt or share; errors of the surface's configuration.
  [[nodiscard]] Status validate() const;
};

/// Gain in cm² of expected surface. It counts surface in the region that lies in the camera's field of view and range,
/// that is in the camera's line of sight (MakeSight), and that the robot's own body does not hide. Surface that an
/// earlier view promised but failed to show counts less from a similar direction: by the share of its promise that the
/// earlier view kept. best() also counts surface behind unknown space (doubtful_share) where no view is worth taking
/// otherwise, where a view kept less than a quarter of its promise, or the last one less than half.
class SurfaceGain final : public Gain {
 public:
  /// Expects a valid configuration.
  /// @param sight what hides surface; empty: the voxels of the map (voxel_sight)
  explicit SurfaceGain(const SurfaceGainConfig& config, MakeSight sight = {});
  /// @return invalid_argument for a pose that is not finite, with its index; errors of expected_surface.
  /// O(voxels of the workspace + camera centres · points · voxels between).
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// Returns the exact best poses that were not attempted, and those that were. Traces lines of sight only where the
  /// bound, the area in the field of view that faces the camera, reaches the best. With one_roll, returns one view for
  /// each of `count` camera centres.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  [[nodiscard]] Result<RankedViews> ranked(const PlanningContext& context, const RegionOfInterest& region,
                                           std::span<const Pose> T_world_camera, std::size_t count,
                                           double doubtful_share) const;

  [[nodiscard]] Result<std::shared_ptr<const LinesOfSight>> sight_to(std::shared_ptr<const ExpectedSurface> surface,
                                                                     const Executor& executor) const;

  SurfaceGainConfig config_;
  PinholeCamera widened_;
  MakeSight sight_;
};

}  // namespace saccade
