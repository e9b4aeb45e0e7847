// SPDX-License-Identifier: Apache-2.0
#pragma once
// PointCloud: the input of segmentation.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Label of a point that belongs to no segment.
inline constexpr std::uint32_t kUnlabelled{std::numeric_limits<std::uint32_t>::max()};

/// Points of one frame, in any order, organised or not.
struct PointCloud {
  std::vector<Eigen::Vector3f> positions_m;  ///< entries that are not finite are not points
  std::vector<Eigen::Vector3f> normals;      ///< one per position, or none; zero or not finite where unknown
  std::vector<Eigen::Vector3f> colors;       ///< one per position, red, green, blue in [0, 1], or none

  std::vector<float> radii_m{};  ///< surfel radii: one per position, or none

  /// Place of the origin of positions_m in the file's coordinates: a place there is positions_m[i] + offset_m. Not zero
  /// for clouds far from their origin, as in map coordinates, where floats would be too coarse.
  Eigen::Vector3d offset_m{0.0, 0.0, 0.0};

  /// @return size_mismatch unless normals, colours and radii are empty or have one entry per position; invalid_argument
  /// for more points than labels, or a colour that is not finite.
  [[nodiscard]] Status validate() const;
};

}  // namespace saccade
