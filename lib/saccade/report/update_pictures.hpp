// SPDX-License-Identifier: Apache-2.0
#pragma once
// task_picture, forgotten_picture, unknown_plot: a user's task in the map, what was forgotten after it, and how that
// became known again.

#include <span>
#include <string>
#include <vector>

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
  std::span<const Region> regions;  ///< of interest
};

struct TaskPictureConfig {
  OverviewConfig overview{.width = 720, .height = 540};
  double margin_m{0.1};                ///< of the map, shown around the workspace
  int samples{1};                      ///< per pixel and direction
  double region_radius_m{0.2};         ///< of the spheres around points of interest
  const RobotDrawing* robot{nullptr};  ///< drawn into the map; not owned
};

/// Fig. 2.16 left and centre: the map before the task, unknown nearly black, with the hand's way coloured by time on a
/// scale below, the Gaussians, if any, and the points of interest with their numbers. The same picture for every thread
/// count.
[[nodiscard]] ColorImage task_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                                      const TaskPictureConfig& config = {});

/// Fig. 2.16 right: the map after the task from the same place, unknown black in the regions alone; they are outlined
/// and have their numbers, from 1.
[[nodiscard]] ColorImage forgotten_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                                           const TaskPictureConfig& config = {});

/// Unknown voxels in a region.
struct RegionUnknown {
  std::string name;
  std::vector<std::size_t> unknown;  ///< after the user's task, then after each view
};
/// Fig. 2.20: one curve per region over the views, 0 being after the user's task, as SVG. Empty without regions.
[[nodiscard]] std::string unknown_plot(std::span<const RegionUnknown> regions, const std::string& title);

}  // namespace saccade
