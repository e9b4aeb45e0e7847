// SPDX-License-Identifier: Apache-2.0
#pragma once
// split_polygon: triangles of a face with any number of corners.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace saccade {

/// Most corners of a face that is not convex. Cutting its ears takes their square, and more for hostile shapes.
inline constexpr std::size_t kMostConcaveCorners{1000};

/// Appends the triangles of a face, in its order of corners: a fan where it is convex, otherwise by cutting ears in the
/// plane of its Newell normal. What crosses itself is cut as far as it has ears, and the rest becomes a fan. Faces of
/// fewer than three corners add nothing.
/// @return false, adding nothing, for a face that is not convex and has more than kMostConcaveCorners corners.
[[nodiscard]] bool split_polygon(std::span<const Eigen::Vector3f> vertices, std::span<const std::uint32_t> corners,
                                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace saccade
