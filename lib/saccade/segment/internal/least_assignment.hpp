// SPDX-License-Identifier: Apache-2.0
#pragma once
// least_assignment: assignment of rows to columns at minimal cost.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace saccade {

/// Assigns each row a column of its own, with a minimal sum of costs: the Hungarian method with potentials. Expects
/// costs that are finite and not negative, and at least as many columns as rows. O(rows² · columns), one thread.
[[nodiscard]] std::vector<std::size_t> least_assignment(const Eigen::MatrixXd& costs);

}  // namespace saccade
