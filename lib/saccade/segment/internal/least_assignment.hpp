// SPDX-License-Identifier: Apache-2.0
#pragma once
// least_assignment: rows to columns at the least cost.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace saccade {

/// The Hungarian method with potentials: for every row a column of its own, at the least sum of costs. Expects costs
/// that are finite and not negative, and as many columns as rows or more. O(rows² · columns), one thread.
[[nodiscard]] std::vector<std::size_t> least_assignment(const Eigen::MatrixXd& costs);

}  // namespace saccade
