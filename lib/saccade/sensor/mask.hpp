// SPDX-License-Identifier: Apache-2.0
#pragma once
// Pixels that must not count: masks from polygons, applied to depth, and depths outside the camera's range.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Closed polygon in image coordinates; the last vertex is joined to the first.
using PixelPolygon = std::vector<Eigen::Vector2d>;

/// Makes a mask that ignores (0) the pixels whose centres lie inside the polygons and uses (255) all others. Even-odd
/// over all polygons together, so that a polygon within another is a hole. A centre on an edge belongs to the right and
/// lower side. Answers invalid_argument for fewer than 3 vertices, a coordinate that is not finite, or an image without
/// pixels.
[[nodiscard]] Result<MaskImage> mask_from_polygons(int width, int height, std::span<const PixelPolygon> ignored);

/// Sets the ignored pixels to 0 (no return), free claims (d < 0) included: the camera's own robot neither occupies nor
/// frees space. Answers size_mismatch when the sizes differ.
[[nodiscard]] Status apply_mask(const MaskImage& mask, DepthImage& depth);

/// Sets returns outside [min_range_m, max_range_m], NaN and infinity to 0 (no return). Shortens free claims (d < 0)
/// beyond the maximum to it; nearer than the minimum they become 0.
void clip_to_range(const PinholeCamera& camera, DepthImage& depth);

}  // namespace saccade
