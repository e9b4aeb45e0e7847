// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewBackend: where a command evaluates views.

#include <cstdint>
#include <memory>
#include <span>

#include "saccade/core/names.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/views/surface_device.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade::cli {

enum class ViewBackend : std::uint8_t {
  automatic,  ///< on the GPU where one is there and can, else on the CPU
  cpu,
  cuda,
};
inline constexpr auto kViewBackendNames =
    make_names<ViewBackend>({{ViewBackend::automatic, "auto"}, {ViewBackend::cpu, "cpu"}, {ViewBackend::cuda, "cuda"}});

/// Opens the GPU for the expected surface of a map with this configuration; null: the CPU computes it. Answers
/// unavailable, with the reason, where the GPU was asked for and none is there.
[[nodiscard]] Result<std::unique_ptr<SurfaceDevice>> surface_device_on(ViewBackend backend, const TsdfConfig& config);

/// Computes the gains of saccade::evaluate_views. Errors are those of the back end that was asked for.
[[nodiscard]] Result<GainResult> evaluate_views_on(ViewBackend backend, const TsdfSnapshot& map, const Region& region,
                                                   std::span<const Pose> T_world_camera, const GainConfig& config,
                                                   const Executor& executor, const Progress& progress);

}  // namespace saccade::cli
