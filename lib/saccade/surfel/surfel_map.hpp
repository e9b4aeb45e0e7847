// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelMap: small coloured discs on surfaces (surfels).

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "saccade/core/uninitialized_vector.hpp"

namespace saccade {

/// Number of a surfel in its map. It never changes, and no surfel is removed.
using SurfelId = std::uint32_t;
inline constexpr SurfelId kNoSurfel{std::numeric_limits<SurfelId>::max()};

/// Position and size of a surfel in the world frame. Half a cache line.
struct SurfelDisc {
  Eigen::Vector3f position_m;
  float radius_m{0.0F};
  Eigen::Vector3f normal;  ///< unit length, towards the cameras that saw it
  float weight{0.0F};      ///< w_s: sum of the weights of its observations
};

struct SurfelColor {
  Eigen::Vector3f color;  ///< red, green, blue in [0, 1]; black where the weight is 0
  float weight{0.0F};     ///< sum of the weights of the observations that had a colour
};

/// Disc on a surface (thesis §4.1.1).
struct Surfel {
  SurfelDisc disc;
  SurfelColor color;
};

/// Surfels by id; both arrays are equally long. 48 bytes per surfel.
struct SurfelMap {
  UninitializedVector<SurfelDisc> discs;
  UninitializedVector<SurfelColor> colors;

  [[nodiscard]] std::size_t size() const { return discs.size(); }
  [[nodiscard]] Surfel surfel(SurfelId id) const { return {discs[id], colors[id]}; }
  /// Changes the number of surfels. New surfels at the end have no value until they are set. Throws ContractViolation
  /// beyond the range of ids.
  void resize(std::size_t surfels);
  [[nodiscard]] std::size_t memory_bytes() const;
};

}  // namespace saccade
