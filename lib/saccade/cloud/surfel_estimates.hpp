// SPDX-License-Identifier: Apache-2.0
#pragma once
// surfel_radii, surfel_normals: estimates of surfel properties that a cloud may lack.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"

namespace saccade {

/// Estimates a radius for each position from its ten nearest neighbours, as estimate_radii does; 0 where a position is
/// not finite. O(n log n). The thread count never changes a bit of the result.
[[nodiscard]] std::vector<float> surfel_radii(std::span<const Eigen::Vector3f> positions_m, const Executor& executor);

/// Estimates a normal for each position from its ten nearest neighbours and their neighbours, as estimate_normals does,
/// and turns it towards the viewpoint; zero where a position is not finite.
/// O(n log n). The thread count never changes a bit of the result.
[[nodiscard]] std::vector<Eigen::Vector3f> surfel_normals(std::span<const Eigen::Vector3f> positions_m,
                                                          const Eigen::Vector3d& viewpoint_m, const Executor& executor);

}  // namespace saccade
