// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_orientation: the world's axes and a scale bar in the lower left corner of a picture.

#include "saccade/report/internal/canvas.hpp"

namespace saccade {

/// Axes x red, y green, z blue, as they are turned in the picture; and a bar of 1, 2 or 5 times a power of ten, as long
/// as that length is at the depth of `p_world_scale`. Without a bar where that point is behind the camera.
void draw_orientation(Canvas& canvas, const Eigen::Vector3d& p_world_scale);

/// The longest of 1, 2 and 5 times a power of ten that is at most `length_m`. Expects a length above 0.
[[nodiscard]] double round_length(double length_m);
/// "50 cm", "2 m", "5 mm".
[[nodiscard]] std::string length_text(double length_m);

}  // namespace saccade
