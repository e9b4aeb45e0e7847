// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewRecord: what is kept of one view; Measures: what a map is worth.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/phase_times.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/robot/refusal.hpp"
#include "saccade/robot/trajectory.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/views/gain.hpp"
#include "saccade/views/view_generator.hpp"

namespace saccade {

/// Measures of a map; definitions: docs/metrics.md. All but unknown_left need a ground truth.
struct Measures {
  std::optional<double> coverage{};
  std::size_t unknown_left{0};  ///< voxels of the workspace
  std::optional<std::size_t> unknown_near_objects{};
  std::optional<double> accuracy_m{};
  std::optional<double> chamfer_m{};
  std::optional<double> f_score{};

  [[nodiscard]] bool operator==(const Measures&) const = default;
};

/// How far the camera was tilted at a view, about its x axis.
struct Tilt {
  double least_rad{0.0};
  double greatest_rad{0.0};

  [[nodiscard]] bool operator==(const Tilt&) const = default;
};

/// How frames were tracked whose poses were not taken as the robot has them.
struct TrackedFrames {
  std::size_t tracked{0};
  std::size_t refused{0};    ///< ICP found no pose that can be believed
  double correction_m{0.0};  ///< mean distance of the tracked poses from those of the robot
  double correction_rad{0.0};
  std::string why{};  ///< the last refusal

  void add(const Pose& T_robot_tracked);
  void refuse(std::string reason);
  [[nodiscard]] bool operator==(const TrackedFrames&) const = default;
};

/// What a view was chosen from. The large part of a record, which is kept in a file of its own; world frame.
struct ViewChoice {
  Region region{};                         ///< that gains are of
  PinholeCamera sensor{};                  ///< virtual, whose rays gains count
  std::vector<RankedView> candidates{};    ///< NaN: not evaluated
  std::vector<double> saliency{};          ///< one per segment of the map before the view; none: there are no segments
  std::optional<std::uint32_t> segment{};  ///< that the view is of
  std::shared_ptr<const SalientSurface> surface{};  ///< those segments; nullptr where they were read from a file
  std::shared_ptr<const ContourSet> contours{};     ///< that candidates look at; nullptr: at none, or read from a file
};

/// The segment that drew the attention to a view.
struct ViewAttention {
  std::size_t segments{0};             ///< in the map
  std::size_t contours{0};             ///< contour points of the map
  std::uint32_t segment{0};            ///< that the view is of
  std::size_t rank{0};                 ///< its place by saliency, 0 for the most salient
  double saliency{0.0};                ///< the segment's
  std::string why{};                   ///< one line for people
  std::size_t contours_of_segment{0};  ///< contour points nearest to the segment

  [[nodiscard]] bool operator==(const ViewAttention&) const = default;
};

/// One view that was taken. The one struct that holds a view: files, tables, pages and pictures are made from it.
struct ViewRecord {
  std::size_t region{0};  ///< index of the region it was chosen for
  Pose T_world_camera{Pose::Identity()};
  std::optional<Configuration> q{};                                 ///< how an arm stands at the view
  double gain_predicted{std::numeric_limits<double>::quiet_NaN()};  ///< NaN: not evaluated
  /// What of gain_predicted became known at the view and on the way there, in the same unit. NaN: it was not checked.
  double gain_observed{std::numeric_limits<double>::quiet_NaN()};
  Measures measures{};                    ///< the map after the view
  std::optional<bool> reveals_object{};   ///< by what the view made known
  std::optional<bool> looks_at_object{};  ///< by its optical axis
  std::size_t candidates{0};              ///< poses it was chosen from, those that the robot cannot take included
  std::size_t evaluated{0};               ///< candidates whose gain was determined
  RefusalCounts refused{};                ///< candidates that the robot cannot take, and those without a path
  std::size_t frames{0};                  ///< fused at the view
  std::size_t frames_on_way{0};
  TrackedFrames tracking{};  ///< tracking of all these frames
  Tilt tilt{};               ///< ±oscillation_rad, or as far towards either end as the robot could
  PhaseTimes times{};
  double motion_s{0.0};                        ///< duration of motion and oscillation of a real arm; 0 where not known
  double retreat_s{0.0};                       ///< its share in which the arm backs out of a contact
  std::vector<Eigen::Vector3d> path{};         ///< the camera's centre on its way, where the robot knows it
  double path_m{0.0};                          ///< length of that way
  std::optional<ViewAttention> attention{};    ///< where the planner looks for objects
  std::shared_ptr<const ViewChoice> choice{};  ///< nullptr: not kept
};

/// Length of a polyline.
[[nodiscard]] inline double length_m(const std::vector<Eigen::Vector3d>& path) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum_m += (path[i] - path[i - 1]).norm();
  return sum_m;
}

}  // namespace saccade
