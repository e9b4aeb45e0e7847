// SPDX-License-Identifier: Apache-2.0
#pragma once
// least_directions: the vector kernel that finds in which direction points vary least.

#include <array>
#include <cstddef>

namespace saccade {

/// Symmetric matrices, as many as a vector of the widest instruction set has lanes: xx, xy, xz, yy, yz, zz of each.
struct Covariances {
  static constexpr std::size_t kCount{8};
  alignas(64) std::array<std::array<float, kCount>, 6> entries;
};
struct Directions {
  alignas(64) std::array<std::array<float, Covariances::kCount>, 3> xyz;
};

/// Unit eigenvectors of the least eigenvalues, either of the two; zero where a matrix is zero or not finite. The same
/// on every instruction set.
[[nodiscard]] Directions least_directions(const Covariances& covariances);

}  // namespace saccade
