// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelMap: small coloured discs on surfaces, one array per attribute; Surfel: one of them.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "saccade/core/unset_vector.hpp"

namespace saccade {

/// A surfel's number in its map. It never changes, and no surfel is removed.
using SurfelId = std::uint32_t;
inline constexpr SurfelId kNoSurfel{std::numeric_limits<SurfelId>::max()};

/// A disc on a surface (thesis §4.1.1), world frame.
struct Surfel {
  Eigen::Vector3f position_m;
  Eigen::Vector3f normal;  ///< unit length, towards the cameras that saw it
  Eigen::Vector3f color;   ///< red, green, blue in [0, 1]; black where color_weight is 0
  float radius_m{0.0F};
  float weight{0.0F};        ///< w_s: sum of the weights of its observations
  float color_weight{0.0F};  ///< of those that had a colour
};

/// Surfels by id, an array per attribute; all arrays are equally long. 48 bytes per surfel.
struct SurfelMap {
  UnsetVector<Eigen::Vector3f> positions_m;
  UnsetVector<Eigen::Vector3f> normals;
  UnsetVector<Eigen::Vector3f> colors;
  UnsetVector<float> radii_m;
  UnsetVector<float> weights;
  UnsetVector<float> color_weights;

  [[nodiscard]] std::size_t size() const { return positions_m.size(); }
  [[nodiscard]] Surfel surfel(SurfelId id) const;
  void set(SurfelId id, const Surfel& surfel);
  /// New surfels at the end have no value until they are set. ContractViolation for more than ids.
  void resize(std::size_t surfels);
  [[nodiscard]] std::size_t memory_bytes() const;
};

}  // namespace saccade
