// SPDX-License-Identifier: Apache-2.0
#pragma once
// frames(), warm_map(): the depth frames that the benchmarks of the map run on, and the map to begin with.

#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::bench {

struct Frames {
  bool recorded{false};  ///< Kinect frames; else rendered ones
  PinholeCamera camera;
  std::vector<DepthImage> depth;
  std::vector<Pose> T_world_camera;

  /// A point on a surface, near the middle of the first image; world frame.
  [[nodiscard]] Eigen::Vector3d seen_point() const;
};

/// 60 frames of 640×480: recorded ones where they are there, else of the sample scene. Loaded at the first call.
[[nodiscard]] const Frames& frames();

constexpr std::size_t kWarmFrames{40};  ///< fused before anything is timed

/// The map of the first kWarmFrames frames. Made at the first call.
[[nodiscard]] const TsdfSnapshot& warm_map();

}  // namespace saccade::bench
