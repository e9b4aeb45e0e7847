// SPDX-License-Identifier: Apache-2.0
#pragma once
// smallest_eigenvectors: the vector kernel that finds the direction in which points vary least.

#include <array>
#include <cstddef>

namespace saccade {

/// Symmetric matrices (xx, xy, xz, yy, yz, zz of each), one per lane of the widest instruction set.
struct Covariances {
  static constexpr std::size_t kCount{8};
  alignas(64) std::array<std::array<float, kCount>, 6> entries;
};
struct Directions {
  alignas(64) std::array<std::array<float, Covariances::kCount>, 3> xyz;
};

/// Returns unit eigenvectors for the smallest eigenvalues, of arbitrary sign; zero where a matrix is zero or not
/// finite. The instruction set never changes the result.
[[nodiscard]] Directions smallest_eigenvectors(const Covariances& covariances);

}  // namespace saccade
