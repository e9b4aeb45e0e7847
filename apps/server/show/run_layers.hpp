// SPDX-License-Identifier: Apache-2.0
#pragma once
// Layers of one view of an exploration: what it was chosen from and what came of it.

#include "saccade/arm/arm_model.hpp"
#include "saccade/explore/view_record.hpp"
#include "server/show/map_layers.hpp"

namespace saccade::server {

/// Poses and their gains.
[[nodiscard]] Layer candidates_layer(std::span<const RankedView> candidates, const std::array<double, 2>& fov_rad,
                                     std::size_t step);
/// Where the rays of the view end in the map as it was before, by what they count for.
[[nodiscard]] Layer hits_layer(const TsdfSnapshot& before, const ViewChoice& choice, const Pose& T_world_camera,
                               std::size_t step, const Executor& executor);
/// Edges of the region that the gain is of; hidden at first.
[[nodiscard]] Layer region_layer(const Region& region, std::size_t step);
/// The way of the camera's centre, on its way to a step or of the whole run. Expects two places or more.
[[nodiscard]] Layer path_layer(std::span<const Eigen::Vector3d> path, std::optional<std::size_t> step);
/// The arm's bodies. Expects a value per joint.
[[nodiscard]] Layer arm_layer(const ArmModel& arm, const Configuration& q, std::size_t step);

}  // namespace saccade::server
