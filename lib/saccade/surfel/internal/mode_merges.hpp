// SPDX-License-Identifier: Apache-2.0
#pragma once
// ModeMerges: modes and the pixels merged into them, side by side. merge_pixels: Thesis §4.1.1, Algorithm 6, line 20
// (eq. 4.4 to 4.6). DepthSteps: movement of points with their depths. For mode_update.cpp and mode_filter.cpp.

#include <array>
#include <cstddef>
#include <cstdint>

#include "saccade/surfel/mode_store.hpp"
#include "saccade/surfel/surfel_association.hpp"

namespace saccade {

/// Colours in ColorUnits.
struct ModeMerges {
  static constexpr std::size_t kMost{64};
  template <class T>
  using Each = std::array<T, kMost>;

  struct {
    Each<std::int32_t> r{}, g{}, b{};
    Each<ModePlace> places{};
  } mode;  ///< before the merge, then after it
  struct {
    Each<std::int32_t> r{}, g{}, b{};
    Each<float> u{}, v{}, depth_m{}, weight{};
  } pixel;
};

/// Computes weighted means and sums of weights of the first `count`. Expects positive sums. simd_target() changes
/// nothing.
void merge_pixels(const BackProjection& back_project, std::size_t count, ModeMerges& merges);

struct DepthSteps {
  static constexpr std::size_t kMost{64};

  std::array<float, kMost> u{}, v{}, from_m{}, to_m{};
  std::array<float, kMost> x_m{}, y_m{}, z_m{};  ///< displacement of the point; world frame
};

/// Computes the displacements of the first `count`. simd_target() changes nothing.
void find_ways(const BackProjection& back_project, std::size_t count, DepthSteps& steps);

}  // namespace saccade
