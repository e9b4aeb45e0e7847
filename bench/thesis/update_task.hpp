// SPDX-License-Identifier: Apache-2.0
#pragma once
// UpdateTask: the task of thesis §2.4.4: a table that is known, and a region on it where the user put something down.

#include <vector>

#include "saccade/core/progress.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade::thesis {

struct UpdateTask {
  std::string scene;
  std::size_t frames{0};          ///< fused into the map
  TsdfSnapshot map;               ///< the region forgotten; the workspace is the volume
  Region region;                  ///< S(POI): a sphere of 0.2 m on top of a box
  IndexBox volume_bricks;         ///< 512³ voxels around it, as large as KinFu's
  PinholeCamera sensor;           ///< sensor of the views
  std::vector<Pose> view_sphere;  ///< the 960 poses of §2.2.3
  PinholeCamera camera;
  Frame next_frame;  ///< a frame of the region, not fused yet

  /// `count` poses, evenly spread; 0: all.
  [[nodiscard]] std::vector<Pose> some_poses(std::size_t count) const;
};

/// Fuses simulated frames of the scene bottle-before, seen from all around. Seconds. `seed` is that of the noise; the
/// same task for every thread count.
[[nodiscard]] Result<UpdateTask> make_update_task(std::uint64_t seed, const Executor& executor,
                                                  const Progress& progress = {});

}  // namespace saccade::thesis
