// SPDX-License-Identifier: Apache-2.0
#pragma once
// Configuration: where the joints of an arm are.

#include <Eigen/Core>

namespace saccade {

/// Joints that an arm has at most. Arms have six or seven, a rail or a torso under them adds one or two; with a bound,
/// configurations and Jacobians need no heap.
constexpr int kMaxJoints{12};

/// One value per joint, base first: radians, for prismatic joints metres. Eigen's dynamic vector in its own storage:
/// copying one, or a vector of them, allocates nothing per element.
using Configuration = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;

}  // namespace saccade
