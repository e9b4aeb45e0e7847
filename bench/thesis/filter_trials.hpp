// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two experiments on the Kinect v2 depth filter of thesis §3.2.3, in simulation: a bar before a wall (Fig. 3.24,
// Table 3.5) and a table with planar things on it (Fig. 3.23, Table 3.4).

#include <array>
#include <span>

#include "saccade/scene/simulated_camera.hpp"

namespace saccade::thesis {

constexpr std::array<double, 3> kBarWidths_m{0.04, 0.08, 0.16};
constexpr std::array<int, 5> kBarAngles_deg{-60, -30, 0, 30, 60};
constexpr double kPlaneDistance_m{0.03};  ///< what lies farther from every plane is an outlier
constexpr int kAveragedFrames{30};

/// A scene, and where the camera looks at it from. All its bodies are boxes.
struct FilterScene {
  RayScene scene;
  Pose T_world_camera{Pose::Identity()};
  Box workspace;  ///< only points in here count
};

/// A square bar, 2 m high on the ground, 1.5 m before a wall. The camera is 1 m above the ground and 1 m before the
/// bar, level, and looks at it; it goes around the bar's axis, at 0 straight before the wall, at positive angles to its
/// right.
[[nodiscard]] Result<FilterScene> bar_before_wall(double width_m, double angle_rad);

/// A table with a box and a board, seen from 1.1 m above the table, 35° downwards; the box is about 1 m away.
[[nodiscard]] Result<FilterScene> planar_table();

/// Score of the points of one image.
struct FilterScore {
  std::size_t points{0};
  std::size_t removed{0};
  std::size_t good_removed{0};
  std::size_t wrong{0};  ///< in the emitter's shadow, or veil
  std::size_t wrong_kept{0};
  std::size_t outliers{0};  ///< farther than kPlaneDistance_m from every plane
  std::size_t outliers_kept{0};

  /// Share of the removed points that were good; 0 where none was removed.
  [[nodiscard]] double false_discovery_rate() const {
    return removed > 0 ? static_cast<double>(good_removed) / static_cast<double>(removed) : 0.0;
  }
};

/// Expects images of the camera's size. A point is removed where `pixels` says so.
[[nodiscard]] FilterScore score_filter(const FilterScene& scene, const PinholeCamera& camera,
                                       const TimeOfFlightFrame& frame, const Image<FilteredPixel>& pixels);

/// Metres from the nearest face of the scene's boxes.
[[nodiscard]] double distance_from_planes(const FilterScene& scene, const Eigen::Vector3d& p_world);

struct AverageScore {
  std::size_t measurements{0};
  std::size_t outliers{0};
};

/// Table 3.4: the mean depth of the frames that have a return, at pixels where half of them have one; it counts where
/// it lies in the workspace.
[[nodiscard]] AverageScore score_average(const FilterScene& scene, const PinholeCamera& camera,
                                         std::span<const DepthImage> frames);

}  // namespace saccade::thesis
