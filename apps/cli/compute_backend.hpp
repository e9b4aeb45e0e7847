// SPDX-License-Identifier: Apache-2.0
#pragma once
// ComputeBackend: where a command computes what a GPU could.

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>

#include "saccade/core/names.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/result.hpp"
#include "saccade/cuda/gpu_tracker.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade::cli {

enum class ComputeBackend : std::uint8_t {
  automatic,  ///< on the GPU where one is there and can, else on the CPU
  cpu,
  cuda,
};
inline constexpr auto kComputeBackendNames = make_names<ComputeBackend>(
    {{ComputeBackend::automatic, "auto"}, {ComputeBackend::cpu, "cpu"}, {ComputeBackend::cuda, "cuda"}});

/// Opens the GPU for views of a map with this configuration; null: the CPU does all. Answers unavailable, with the
/// reason, where the GPU was asked for and none is there.
/// @param problem  of a GPU that is there and cannot be used, where another back end will do
[[nodiscard]] Result<std::unique_ptr<GpuMap>> gpu_map_on(ComputeBackend backend, const TsdfConfig& config,
                                                         std::optional<Error>& problem);
/// As gpu_map_on, for tracking.
[[nodiscard]] Result<std::unique_ptr<GpuTracker>> gpu_tracker_on(ComputeBackend backend, const TsdfConfig& config,
                                                                 std::optional<Error>& problem);

/// `compute` of a result: what was wanted, what did the work, and the GPU's last problem.
/// @param gpu_worked  the GPU computed something
[[nodiscard]] nlohmann::json compute_json(ComputeBackend wanted, bool gpu_worked, const std::optional<Error>& problem);

/// Computes the gains of saccade::evaluate_views. Errors are those of the back end that was asked for.
/// @param problem  of a GPU that failed, where the CPU computed the gains instead
[[nodiscard]] Result<GainResult> evaluate_views_on(ComputeBackend backend, const TsdfSnapshot& map,
                                                   const Region& region, std::span<const Pose> T_world_camera,
                                                   const GainConfig& config, const Executor& executor,
                                                   const Progress& progress, std::optional<Error>& problem);

}  // namespace saccade::cli
