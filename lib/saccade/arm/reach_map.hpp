// SPDX-License-Identifier: Apache-2.0
#pragma once
// ReachMap: for a grid of points of interest, the number of surrounding view poses that an arm can take, and why not
// more.

#include <cstddef>
#include <vector>

#include "saccade/arm/reachability.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/region.hpp"
#include "saccade/views/view_sphere.hpp"

namespace saccade {

/// Results of testing a number of poses.
struct ReachCounts {
  std::size_t reachable{0};
  std::size_t no_ik{0};
  std::size_t outside_limits{0};
  std::size_t goal_in_collision{0};

  void add(const std::optional<Refusal>& refusal);
  ReachCounts& operator+=(const ReachCounts& other);
  bool operator==(const ReachCounts&) const = default;
  [[nodiscard]] std::size_t poses() const { return reachable + no_ik + outside_limits + goal_in_collision; }
  /// Returns the share of poses that can be taken; 0 without any.
  [[nodiscard]] double share() const;
};

struct ReachMapConfig {
  Box workspace;            ///< the grid covers its area
  double height_m{0.0};     ///< world z of all points
  double step_m{0.05};      ///< edge of a grid square; the point is its middle
  ViewSphereConfig sphere;  ///< around each point

  static constexpr std::size_t kMostPoses{50'000'000};
  /// Answers invalid_argument for an empty workspace, a step that is not positive or larger than it, a bad sphere, or
  /// more than kMostPoses poses in all.
  [[nodiscard]] Status validate() const;
};

struct ReachPoint {
  Eigen::Vector3d p_world;
  ReachCounts counts;  ///< zero where the work was cancelled before
};

/// Poses of all points and rolls that look in one direction.
struct ReachDirection {
  double latitude_rad{0.0};
  double longitude_rad{0.0};
  ReachCounts counts;
};

struct ReachMap {
  std::size_t columns{0};  ///< along x
  std::size_t rows{0};     ///< along y
  std::size_t poses_per_point{0};
  std::size_t longitudes{0};
  std::vector<ReachPoint> points;          ///< x fastest; the grid is centred in the workspace
  std::vector<ReachDirection> directions;  ///< longitude fastest
  std::vector<ReachCounts> by_radius;      ///< one per radius
  std::size_t points_done{0};              ///< fewer than points when cancelled

  [[nodiscard]] ReachCounts total() const;
  /// Returns one entry per latitude, with an arbitrary longitude.
  [[nodiscard]] std::vector<ReachDirection> by_latitude() const;
  /// Return the index of the finished point with the largest or smallest share, the first at a tie. Expect one.
  [[nodiscard]] std::size_t best() const;
  [[nodiscard]] std::size_t worst() const;
};

/// Tests the poses of the view sphere around every point of the grid. When cancelled, returns the results so far.
/// Errors: those of ReachMapConfig::validate. Reports points. O(points · poses) of Reachability::test; the thread count
/// never changes the result.
[[nodiscard]] Result<ReachMap> reach_map(const Reachability& reachability, const Configuration& reference,
                                         const ObstacleMap& obstacles, const ReachMapConfig& config,
                                         const Executor& executor, const Progress& progress = {});

}  // namespace saccade
