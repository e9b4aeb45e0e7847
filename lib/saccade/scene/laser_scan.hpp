// SPDX-License-Identifier: Apache-2.0
#pragma once
// LaserScan: the cloud of a simulated laser scanner on a tripod, with the true segment of every point.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/result.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// Scanner that turns about the vertical while its mirror turns about a horizontal axis: rays at equal steps of azimuth
/// and elevation.
struct LaserScanConfig {
  std::vector<Eigen::Vector3d> stations_m{};  ///< places of the scanner, world frame
  double step_rad{0.0043633};                 ///< between rays, both ways; 0.25°
  double lowest_rad{-1.0472};                 ///< the tripod hides what is steeper below; −60°
  double min_range_m{0.3};
  double max_range_m{80.0};
  double range_noise_m{0.003};  ///< standard deviation along the ray
  double color_noise{0.02};     ///< standard deviation of a channel within [0, 1]
  double beam_rad{0.0003};      ///< width of the beam; where it meets two surfaces less than half a metre apart, the
                                ///< range is between them
  std::uint64_t seed{1};

  /// Answers invalid_argument without a station, for one that is not finite, more than 64 of them, steps outside 0.01°
  /// and 10°, an empty range, and noise that is negative or not finite.
  [[nodiscard]] Status validate() const;
};

struct LaserScan {
  PointCloud cloud;                   ///< with colours, without normals
  std::vector<std::uint32_t> labels;  ///< per point, as SegmentTable numbers segments
  std::vector<std::string> names;     ///< by label; 0 is nothing
};

/// Scans a scene: station after station, column after column. Errors: those of validate; cancelled, tested between
/// columns. The thread count never changes the result. O(rays · log triangles).
[[nodiscard]] Result<LaserScan> scan_by_laser(const RayScene& scene, const LaserScanConfig& config,
                                              const Executor& executor = {}, const Progress& progress = {});

}  // namespace saccade
