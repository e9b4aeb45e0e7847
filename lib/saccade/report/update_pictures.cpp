// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/update_pictures.hpp"

#include <algorithm>

#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/view_picture.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kRegionColor{214, 92, 22};  // that of their outlines

/// Returns the viewpoint that both pictures of a task share.
Viewpoint viewpoint_of(const TaskScene& task, const TaskPictureConfig& config) {
  std::vector<Eigen::Vector3d> shown = corners_of(task.workspace);
  const auto show = [&](const std::vector<Eigen::Vector3d>& points) {
    shown.insert(shown.end(), points.begin(), points.end());
  };
  show(attention_points(task.trajectory, task.findings, config.region_radius_m));
  for (const Region& region : task.regions) show(corners_of(bounds(region)));
  const Eigen::Vector3d middle = 0.5 * (task.workspace.min + task.workspace.max);
  return overview_with(config.robot, std::move(shown), middle, config.overview);
}

Canvas draw_map(const TsdfSnapshot& map, const TaskScene& task, std::vector<Region> unknown_within,
                const Executor& executor, const TaskPictureConfig& config) {
  TernaryPictureConfig ternary;
  ternary.unknown_within = std::move(unknown_within);
  ternary.crop = Box{task.workspace.min.array() - config.margin_m, task.workspace.max.array() + config.margin_m};
  ternary.samples = config.samples;
  Canvas canvas = draw_ternary(map, viewpoint_of(task, config), executor, ternary);
  if (config.robot != nullptr) draw_robot(canvas, *config.robot, executor);
  return canvas;
}

}  // namespace

ColorImage task_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                        const TaskPictureConfig& config) {
  Canvas canvas = draw_map(map, task, {}, executor, config);
  const AttentionLegend legend = draw_attention(canvas, task.trajectory, task.findings, config.region_radius_m);
  if (!legend.time) return canvas.finish();
  return with_scale(canvas.finish(), depth_colors(), *legend.time, TernaryPictureConfig{}.background);
}

ColorImage forgotten_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                             const TaskPictureConfig& config) {
  Canvas canvas = draw_map(map, task, {task.regions.begin(), task.regions.end()}, executor, config);
  for (std::size_t i = 0; i < task.regions.size(); ++i) {
    const Box around = bounds(task.regions[i]);
    const Eigen::Vector3d top{0.5 * (around.min.x() + around.max.x()), 0.5 * (around.min.y() + around.max.y()),
                              around.max.z()};
    canvas.label(top, std::to_string(i + 1), kRegionColor, 15.0);
  }
  return canvas.finish();
}

}  // namespace saccade
