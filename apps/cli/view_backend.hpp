// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewBackend: where a command evaluates views.

#include <cstdint>
#include <span>

#include "saccade/core/names.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade::cli {

enum class ViewBackend : std::uint8_t {
  automatic,  ///< on the GPU where one is there and can, else on the CPU
  cpu,
  cuda,
};
inline constexpr auto kViewBackendNames =
    make_names<ViewBackend>({{ViewBackend::automatic, "auto"}, {ViewBackend::cpu, "cpu"}, {ViewBackend::cuda, "cuda"}});

/// Computes the gains of saccade::evaluate_views. Errors are those of the back end that was asked for.
[[nodiscard]] Result<GainResult> evaluate_views_on(ViewBackend backend, const TsdfSnapshot& map, const Region& region,
                                                   std::span<const Pose> T_world_camera, const GainConfig& config,
                                                   const Executor& executor, const Progress& progress);

}  // namespace saccade::cli
