// SPDX-License-Identifier: Apache-2.0
#include "view_json.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/explore/object_attention.hpp"
#include "saccade/io/json_io.hpp"
#include "saccade/robot/arm_mesh.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// Gains are counts as a rule, and read better as such.
json gain_json(double gain) {
  constexpr double kExact{9007199254740992.0};
  return gain >= 0.0 && gain < kExact && gain == std::floor(gain) ? json(static_cast<std::uint64_t>(gain)) : json(gain);
}

double length_m(const std::vector<Eigen::Vector3d>& path) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum_m += (path[i] - path[i - 1]).norm();
  return sum_m;
}

}  // namespace

json configuration_json(const std::optional<Configuration>& q) {
  return q ? json(std::vector<double>(q->begin(), q->end())) : json(nullptr);
}

json refused_json(const RefusalCounts& refused) { return refusals_to_json(refused); }

json view_json(const ExploredView& view, std::size_t index) {
  return {{"index", index},
          {"region", view.region},
          {"gain", gain_json(view.gain)},
          {"candidates", view.candidates},
          {"evaluated", view.evaluated},
          {"refused", refused_json(view.refused)},
          {"frames", view.frames},
          {"frames_on_way", view.frames_on_way},
          {"tilt_rad", {view.tilt.least_rad, view.tilt.greatest_rad}},
          {"T_world_camera", pose_to_json(view.T_world_camera)},
          {"unknown_left", nullptr},
          {"unknown_near_objects", nullptr},
          {"points_at_object", nullptr},
          {"looks_at_object", nullptr},
          {"coverage", nullptr},
          {"q", configuration_json(view.q)},
          {"motion_s", view.motion_s},
          {"retreat_s", view.retreat_s},
          {"path_m", length_m(view.path)},
          {"ms",
           {{"planner_map", view.planner_map_ms},
            {"candidates", view.candidates_ms},
            {"segmentation", view.segmentation_ms},
            {"saliency", view.saliency_ms},
            {"reachability", view.reachability_ms},
            {"evaluation", view.evaluation_ms},
            {"planning", view.planning_ms},
            {"motion", view.motion_ms},
            {"fusion", view.fusion_ms}}}};
}

json attention_json(const Proposals& proposals) {
  if (!proposals.attention || !proposals.segment) return nullptr;
  const ObjectAttention& attention = *proposals.attention;
  const std::uint32_t segment = *proposals.segment;
  const auto contours = std::count(attention.segment_of_contour.begin(), attention.segment_of_contour.end(), segment);
  const auto rank = std::find(attention.order.begin(), attention.order.end(), segment) - attention.order.begin();
  return {{"segments", attention.saliency.size()},
          {"contours", attention.contours.size()},
          {"segment", segment},
          {"rank", rank},
          {"saliency", attention.saliency[segment].value},
          {"why", attention.saliency[segment].why},
          {"contours_of_segment", contours}};
}

std::optional<RobotDrawing> drawing_of(const ArmModel* arm, const std::optional<Configuration>& q,
                                       const std::vector<Eigen::Vector3d>& path) {
  if (arm == nullptr || !q) return std::nullopt;
  constexpr double kTall_m{0.9};  // an arm rises about so far above its first joint
  const Eigen::Vector3d p_base = (arm->T_world_base() * arm->joint(0).T_parent_joint).translation();
  return RobotDrawing{arm_mesh(*arm, *q), path, p_base, {p_base + kTall_m * Eigen::Vector3d::UnitZ()}};
}

}  // namespace saccade::cli
