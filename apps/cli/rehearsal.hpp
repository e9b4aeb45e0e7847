// SPDX-License-Identifier: Apache-2.0
#pragma once
// rehearsal_camera: what a dry run sees, in which nothing moves.

#include <memory>
#include <optional>

#include "explore_options.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade::cli {

/// From where the camera stands a frame of its own; from anywhere else what is known of the cell beforehand: supports
/// and fixtures. Where nothing is, it sees nothing. Errors: those of RayScene::build and SimulatedCamera::create.
[[nodiscard]] Result<std::unique_ptr<Camera>> rehearsal_camera(std::unique_ptr<Camera> camera, const Scene& scene,
                                                               std::span<const Box> fixtures,
                                                               const std::optional<Pose>& T_world_standing);

}  // namespace saccade::cli
