// SPDX-License-Identifier: Apache-2.0
#pragma once
// to_points: a view of the mapped surface as a PointImage.

#include "saccade/core/executor.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/sensor/point_image.hpp"

namespace saccade {

/// A view of the mapped surface in planes, as it is. O(pixels).
[[nodiscard]] PointImage to_points(const SurfaceView& view, const Executor& executor);

}  // namespace saccade
