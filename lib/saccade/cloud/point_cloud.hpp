// SPDX-License-Identifier: Apache-2.0
#pragma once
// PointCloud: what segmentation reads.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// The label of a point that belongs to nothing.
inline constexpr std::uint32_t kUnlabelled{std::numeric_limits<std::uint32_t>::max()};

/// Points of one frame, in any order; organised or not makes no difference.
struct PointCloud {
  std::vector<Eigen::Vector3f> positions_m;  ///< one that is not finite is no point
  std::vector<Eigen::Vector3f> normals;      ///< one per position, or none; zero or not finite: not known there
  std::vector<Eigen::Vector3f> colors;       ///< one per position, red, green, blue in [0, 1], or none

  std::vector<float> radii_m{};  ///< one per position, or none: of surfels

  /// @return size_mismatch unless normals, colours and radii are none or one per position; invalid_argument for more
  /// points than labels, or a colour that is not finite.
  [[nodiscard]] Status validate() const;
};

}  // namespace saccade
