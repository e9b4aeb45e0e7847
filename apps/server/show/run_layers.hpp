// SPDX-License-Identifier: Apache-2.0
#pragma once
// Layers of one view of an exploration: its alternatives and its results.

#include "saccade/arm/arm_model.hpp"
#include "saccade/explore/view_record.hpp"
#include "server/show/map_layers.hpp"

namespace saccade::server {

/// Returns the poses and their gains.
[[nodiscard]] Layer candidates_layer(std::span<const RankedView> candidates, const std::array<double, 2>& fov_rad,
                                     std::size_t step);
/// Returns the ends of the view's rays in the map before it, by what they count for.
[[nodiscard]] Layer hits_layer(const TsdfSnapshot& before, const ViewChoice& choice, const Pose& T_world_camera,
                               std::size_t step, const Executor& executor);
/// Returns the edges of the region that the gain refers to; hidden at first.
[[nodiscard]] Layer region_layer(const Region& region, std::size_t step);
/// Returns the path of the camera's centre, for one step or the whole run. Expects at least two points.
[[nodiscard]] Layer path_layer(std::span<const Eigen::Vector3d> path, std::optional<std::size_t> step);
/// Returns the arm's bodies. Expects one value per joint.
[[nodiscard]] Layer arm_layer(const ArmModel& arm, const Configuration& q, std::size_t step);

}  // namespace saccade::server
