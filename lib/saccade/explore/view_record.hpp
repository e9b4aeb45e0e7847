// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewRecord: the record of one view. Measures: numbers about a map.

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

/// Measures of a map; definitions: docs/reference/metrics.md. All but unknown_left need a ground truth.
struct Measures {
  std::optional<double> coverage{};
  std::size_t unknown_left{0};  ///< voxels of the workspace
  std::optional<std::size_t> unknown_near_objects{};
  std::optional<double> accuracy_m{};
  std::optional<double> chamfer_m{};
  std::optional<double> f_score{};

  [[nodiscard]] bool operator==(const Measures&) const = default;
};

/// Tilt of the camera at a view, about its x axis.
struct Tilt {
  double least_rad{0.0};
  double greatest_rad{0.0};

  [[nodiscard]] bool operator==(const Tilt&) const = default;
};

/// Tracking of frames whose poses were not taken from the robot.
struct TrackedFrames {
  std::size_t tracked{0};
  std::size_t refused{0};    ///< ICP found no credible pose
  double correction_m{0.0};  ///< mean distance of the tracked poses from those of the robot
  double correction_rad{0.0};
  std::string why{};  ///< the last refusal

  void add(const Pose& T_robot_tracked);
  void refuse(std::string reason);
  [[nodiscard]] bool operator==(const TrackedFrames&) const = default;
};

/// Alternatives that a view was chosen from. The large part of a record, kept in its own file; world frame.
struct ViewChoice {
  Region region{};                         ///< region that the gains refer to
  PinholeCamera sensor{};                  ///< virtual sensor whose rays the gains count
  std::vector<RankedView> candidates{};    ///< NaN: not evaluated
  std::vector<double> saliency{};          ///< one per segment of the map before the view; empty without segments
  std::optional<std::uint32_t> segment{};  ///< segment that the view looks at
  std::shared_ptr<const SalientSurface> surface{};  ///< those segments; nullptr where they were read from a file
  std::shared_ptr<const ContourSet> contours{};     ///< contours of the candidates; nullptr: none, or read from a file
};

/// Segment that drew the attention to a view.
struct ViewAttention {
  std::size_t segments{0};             ///< number of segments in the map
  std::size_t contours{0};             ///< contour points of the map
  std::uint32_t segment{0};            ///< segment that the view looks at
  std::size_t rank{0};                 ///< rank by saliency, 0 for the most salient
  double saliency{0.0};                ///< saliency of the segment
  std::string why{};                   ///< one line for people
  std::size_t contours_of_segment{0};  ///< contour points nearest to the segment

  [[nodiscard]] bool operator==(const ViewAttention&) const = default;
};

/// Record of one view. The only struct that holds a view: files, tables, pages and pictures are made from it.
struct ViewRecord {
  std::size_t region{0};  ///< index of the region that it was chosen for
  Pose T_world_camera{Pose::Identity()};
  std::optional<Configuration> q{};                                 ///< configuration of an arm at the view
  double gain_predicted{std::numeric_limits<double>::quiet_NaN()};  ///< NaN: not evaluated
  /// Part of gain_predicted that became known at the view and during the motion, in its unit. NaN: not checked.
  double gain_observed{std::numeric_limits<double>::quiet_NaN()};
  Measures measures{};                    ///< the map after the view
  std::optional<bool> reveals_object{};   ///< judged by the voxels made known
  std::optional<bool> looks_at_object{};  ///< judged by the optical axis
  std::size_t candidates{0};              ///< poses it was chosen from, including unreachable ones
  std::size_t evaluated{0};               ///< candidates whose gain was computed
  RefusalCounts refused{};                ///< candidates that the robot cannot take or has no path to
  std::size_t frames{0};                  ///< fused at the view
  std::size_t frames_on_way{0};
  TrackedFrames tracking{};  ///< tracking of all these frames
  Tilt tilt{};               ///< ±oscillation_rad, or as far towards either end as the robot could tilt
  PhaseTimes times{};
  double motion_s{0.0};                        ///< duration of motion and oscillation on a real arm; 0 where unknown
  double retreat_s{0.0};                       ///< part of it in which the arm backs out of a contact
  std::vector<Eigen::Vector3d> path{};         ///< path of the camera's centre, where the robot knows it
  double path_m{0.0};                          ///< length of that path
  std::optional<ViewAttention> attention{};    ///< set where the planner searches for objects
  std::shared_ptr<const ViewChoice> choice{};  ///< nullptr: not kept
};

/// Returns the length of a polyline.
[[nodiscard]] inline double length_m(const std::vector<Eigen::Vector3d>& path) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum_m += (path[i] - path[i - 1]).norm();
  return sum_m;
}

}  // namespace saccade
