// SPDX-License-Identifier: Apache-2.0
#pragma once
// GainProblem: poses, region and map turned into the rays to cast and what they meet.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "saccade/views/internal/cast_window.hpp"
#include "saccade/views/internal/gain_caster.hpp"
#include "saccade/views/internal/stop_grid.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// Where errors and progress of an evaluation come from.
inline constexpr std::string_view kEvaluation{"view evaluation"};

/// Rays to cast, and the poses whose gain they are.
struct GainJob {
  CastWindow window;
  std::vector<std::size_t> poses;
};

/// Poses that are in no job gain nothing.
struct GainProblem {
  StopGrid grid;
  EntryFaces faces;               ///< only with footprints
  std::array<PixelAxes, 4> axes;  ///< of the sensor, by quarter turns
  std::vector<GainJob> jobs;
  std::vector<std::vector<std::size_t>> lattices;  ///< jobs whose windows have camera centre and axes in common
  CastLimits limits;
  double voxel_size_m{0.0};
  std::uint64_t rays_total{0};  ///< pixels of all poses
  double prepare_ms{0.0};

  /// Errors of evaluate_views.
  [[nodiscard]] static Result<GainProblem> prepare(const TsdfSnapshot& map, const Region& region,
                                                   std::span<const Pose> T_world_camera, const GainConfig& config,
                                                   const Executor& executor);
};

}  // namespace saccade
