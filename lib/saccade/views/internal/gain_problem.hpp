// SPDX-License-Identifier: Apache-2.0
#pragma once
// GainProblem: rays to cast and voxels they meet, derived from poses, region and map.

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "saccade/views/internal/cast_window.hpp"
#include "saccade/views/internal/gain_caster.hpp"
#include "saccade/views/internal/stop_grid.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// Context of errors and progress of an evaluation.
inline constexpr std::string_view kEvaluation{"view evaluation"};

/// Length of the sensor's longest ray in voxels, rounded up.
[[nodiscard]] double longest_ray_vox(const PinholeCamera& camera, double voxel_size_m);
/// Tells whether a voxel is no farther from the box than `reach` voxels along each axis.
[[nodiscard]] bool within_reach(const Index3& voxel, const IndexBox& box, double reach);
/// Voxels around the region that lie in the map's workspace.
[[nodiscard]] IndexBox region_in_workspace(const Region& region, const TsdfConfig& config);

/// Bits of a lattice of rays: equal where SensorRays::same_lattice holds.
using LatticeKey = std::array<std::uint32_t, 15>;
[[nodiscard]] LatticeKey key_of(const SensorRays& rays);
struct LatticeHash {
  [[nodiscard]] std::size_t operator()(const LatticeKey& key) const {
    std::uint64_t hash{0};
    for (const std::uint32_t word : key) hash = (std::rotl(hash, 5) ^ word) * 0x9E3779B97F4A7C15ULL;
    return static_cast<std::size_t>(hash ^ hash >> 32U);
  }
};

/// Answers the errors of evaluate_views.
[[nodiscard]] Status check_evaluation(const TsdfConfig& map, const Region& region, std::span<const Pose> T_world_camera,
                                      const GainConfig& config);

/// Rays to cast, and the poses whose gain they give.
struct GainJob {
  CastWindow window;
  std::vector<std::size_t> poses;
};

/// Evaluation problem. Poses in no job have gain 0.
struct GainProblem {
  StopGrid grid;
  EntryFaces faces;               ///< only with GainSavings::footprints
  std::array<PixelAxes, 4> axes;  ///< axes of the sensor, by quarter turns
  std::vector<GainJob> jobs;
  std::vector<std::vector<std::size_t>> lattices;  ///< jobs whose windows share camera centre and axes
  CastLimits limits;
  double voxel_size_m{0.0};
  std::uint64_t rays_total{0};  ///< pixels of all poses
  double prepare_ms{0.0};

  /// Prepares the problem. Errors of evaluate_views; cancelled between the parts of the work, where a large region
  /// takes most of the time.
  [[nodiscard]] static Result<GainProblem> prepare(const TsdfSnapshot& map, const Region& region,
                                                   std::span<const Pose> T_world_camera, const GainConfig& config,
                                                   const Executor& executor, const Progress& progress = {});
};

}  // namespace saccade
