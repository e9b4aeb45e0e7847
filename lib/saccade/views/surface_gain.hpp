// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceGain: a view is worth the surface that it is expected to show.

#include "saccade/views/expected_surface.hpp"
#include "saccade/views/gain.hpp"

namespace saccade {

struct SurfaceGainConfig {
  PinholeCamera sensor{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 6.0};  ///< field of view and range
  double tilt_rad{0.0};  ///< the real sensor is tilted by ± this angle: see widened_vertically
  /// A view that is expected to show less than this share of the surface that was seen so far is not worth going to.
  double least_share{0.005};
  /// Share of their area that points behind unknown space count for once the other promises are not worth going to or
  /// were broken; 0: none. So a thing without a table or walls behind it is seen from all sides, although no return
  /// tells that the space around it is empty.
  double doubtful_share{0.1};
  /// Only the best roll of each camera centre is ranked, before the robot's own body is heeded: for a choice among many
  /// places (Foresight).
  bool one_roll{false};
  ExpectedSurfaceConfig surface{};

  /// invalid_argument for a bad sensor, tilt or share; errors of the surface's configuration.
  [[nodiscard]] Status validate() const;
};

/// Gains are in cm² of expected surface within the region that lies in the camera's field of view and range, that
/// ExpectedSurface::is_visible from it, and that the robot's own body does not hide. Surface that an earlier view
/// promised and failed to show counts less from about there: by the share that the earlier view kept of its promise.
/// Where all of that is not worth a view, a view kept less than a quarter of its promise, or the last one less than
/// half, best() also counts what is behind unknown space (doubtful_share).
class SurfaceGain final : public Gain {
 public:
  /// Expects a valid configuration.
  explicit SurfaceGain(const SurfaceGainConfig& config);
  /// @return invalid_argument for a pose that is not finite, with its index; errors of expected_surface.
  /// O(voxels of the workspace + camera centres · points · voxels between).
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// The best that were not attempted, exactly, and those that were: lines of sight are followed where the bound, the
  /// area in the field of view that faces the camera, comes up to the best. With one_roll, a view for each of `count`
  /// camera centres.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  [[nodiscard]] Result<RankedViews> ranked(const PlanningContext& context, const RegionOfInterest& region,
                                           std::span<const Pose> T_world_camera, std::size_t count,
                                           double doubtful_share) const;

  SurfaceGainConfig config_;
  PinholeCamera widened_;
};

}  // namespace saccade
