// SPDX-License-Identifier: Apache-2.0
#pragma once
// TrackingDevice: the seam to a device that tracks frames, such as a GPU.

#include <optional>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/tracking/icp.hpp"

namespace saccade {

/// Device beside the CPU. What it returns equals the CPU's to the bit. One caller at a time. After an error the CPU
/// does the work: every caller goes on without the device for that call.
class TrackingDevice {
 public:
  virtual ~TrackingDevice() = default;
  /// Casts a ray per pixel to the surface of a map, as saccade::raycast does, but without colours. Parts of the map
  /// that did not change since the last call are not sent again. O(bricks that changed + pixels · bricks along the
  /// ray).
  [[nodiscard]] virtual Result<SurfaceView> raycast(const TsdfSnapshot& map, const PinholeCamera& camera,
                                                    const Pose& T_world_camera, const Executor& executor) = 0;
  /// Aligns measured points to a surface, as saccade::align does. O(pixels · iterations).
  [[nodiscard]] virtual Result<IcpResult> align(const PointImage& measured, const PointImage& model,
                                                const PinholeCamera& camera, const Pose& T_model_camera_start,
                                                const IcpConfig& config) = 0;
  /// Returns the last error after which the CPU had to go on, and forgets it; nullopt: there was none since the last
  /// call.
  [[nodiscard]] virtual std::optional<Error> take_problem() = 0;
};

}  // namespace saccade
