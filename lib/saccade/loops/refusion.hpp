// SPDX-License-Identifier: Apache-2.0
#pragma once
// TrackedFrame: a frame that can be read again, and its pose; fuse_along: a map of such frames.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "saccade/core/progress.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// Reads a frame of the source again, ready to be fused (its gaps filled as when it was tracked).
using ReadFrame = std::function<Result<Frame>(std::size_t index)>;

struct TrackedFrame {
  std::size_t index{0};  ///< in the source
  Pose T_world_camera{Pose::Identity()};
};

/// Fuses the frames along their poses into a map, in their order. Errors: those of reading and of integrate.
/// O(frames · pixels). The thread count changes no bit of the result.
[[nodiscard]] Status fuse_along(TsdfMap& map, const PinholeCamera& camera, std::span<const TrackedFrame> frames,
                                const ReadFrame& read, const Executor& executor);

/// Moves a trajectory along with some of its poses that were corrected, such as those of keyframes. Between two
/// corrected poses, a pose is carried along from both, and the two results are blended by the number of frames in
/// between; before the first and after the last it is carried by one.
/// @param corrected  positions in `T_world_camera`, ascending, and their new poses, as many.
/// Expects at least one corrected pose. O(frames).
[[nodiscard]] std::vector<Pose> carried_along(std::span<const Pose> T_world_camera,
                                              std::span<const std::size_t> corrected,
                                              std::span<const Pose> T_world_corrected);

}  // namespace saccade
