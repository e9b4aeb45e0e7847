// SPDX-License-Identifier: Apache-2.0
#pragma once
// morton_order: the finite points of a cloud along a Morton curve through the cube around them.

#include <Eigen/Geometry>
#include <cstdint>
#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/core/uninitialized_vector.hpp"

namespace saccade::internal {

inline constexpr unsigned kMortonBits{21};  ///< bits of a code along each axis

struct MortonPoint {
  std::uint64_t code;
  std::uint32_t point;
};

struct MortonOrder {
  UninitializedVector<MortonPoint> points;  ///< ascending by code, then by number
  Eigen::Vector3d origin_m{0.0, 0.0, 0.0};  ///< least corner of the cube
  double edge_m{1.0};                       ///< edge of the cube
};

/// O(n log n). The thread count never changes the result.
[[nodiscard]] MortonOrder morton_order(std::span<const Eigen::Vector3f> positions_m, const Executor& executor);

}  // namespace saccade::internal
