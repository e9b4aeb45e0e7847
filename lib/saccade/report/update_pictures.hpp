// SPDX-License-Identifier: Apache-2.0
#pragma once
// task_picture, forgotten_picture: a user's task in the map, and what was forgotten after it. Thesis Fig. 2.16.

#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/report/attention_picture.hpp"
#include "saccade/report/robot_drawing.hpp"

namespace saccade {

/// A user's task in the map; world frame.
struct TaskScene {
  Box workspace;
  std::span<const HandSample> trajectory;
  const AttentionFindings& findings;
  std::span<const Region> regions;  ///< regions of interest
};

struct TaskPictureConfig {
  OverviewConfig overview{.width = 720, .height = 540};
  double margin_m{0.1};                ///< part of the map shown around the workspace
  int samples{1};                      ///< rays per pixel and direction
  double region_radius_m{0.2};         ///< radius of the spheres around points of interest
  const RobotDrawing* robot{nullptr};  ///< drawn into the map; not owned
};

/// Fig. 2.16 left and centre: the map before the task, unknown nearly black, with the hand's way coloured by time on a
/// scale below, the Gaussians, if any, and the points of interest with their numbers. The thread count does not change
/// the picture.
[[nodiscard]] ColorImage task_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                                      const TaskPictureConfig& config = {});

/// Fig. 2.16 right: the map after the task from the same place, unknown black in the regions alone; they are outlined
/// and have their numbers, from 1.
[[nodiscard]] ColorImage forgotten_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                                           const TaskPictureConfig& config = {});

}  // namespace saccade
