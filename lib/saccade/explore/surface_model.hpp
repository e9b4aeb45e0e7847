// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceModel: a model of surfaces that is fused beside the map. The seam through which a second kind of map takes
// part in an exploration.

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Model of surfaces. The map of an Explorer then says what is free; planner, recorders and caller may look at the
/// model. One caller at a time.
class SurfaceModel {
 public:
  virtual ~SurfaceModel() = default;
  /// Fuses a frame with its pose, which the map has fused already. An error ends the run.
  [[nodiscard]] virtual Status fuse(const Frame& frame, const PinholeCamera& camera, const Executor& executor) = 0;
};

}  // namespace saccade
