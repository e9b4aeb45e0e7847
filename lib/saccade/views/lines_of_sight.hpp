// SPDX-License-Identifier: Apache-2.0
#pragma once
// LinesOfSight: which expected points a place has in sight. The seam between the gain by expected surface and the map
// that it looks through: voxels (voxel_sight) or surfels (surfel_sight).

#include <functional>
#include <memory>
#include <span>

#include "saccade/views/expected_surface.hpp"

namespace saccade {

/// Points in sight from one place. Immutable.
class Outlook {
 public:
  virtual ~Outlook() = default;
  /// Tells whether nothing hides a point of the expected surface from the place.
  /// @param through_m the line may begin at the point with unknown space over this length
  [[nodiscard]] virtual bool sees(const ExpectedPoint& point, double through_m) const = 0;
};

/// Lines of sight in one state of the map. Immutable; safe for concurrent use.
class LinesOfSight {
 public:
  virtual ~LinesOfSight() = default;
  /// @param points those that the outlook will be asked about
  [[nodiscard]] virtual std::unique_ptr<const Outlook> from(const Eigen::Vector3d& camera_m,
                                                            std::span<const ExpectedPoint* const> points) const = 0;
};

/// Makes the lines of sight to the points of a surface, which they share.
using MakeSight = std::function<Result<std::shared_ptr<const LinesOfSight>>(
    std::shared_ptr<const ExpectedSurface> surface, const Executor& executor)>;

/// Returns lines along the voxels of the surface's volume: known empty ones, and unknown ones over through_m.
[[nodiscard]] std::shared_ptr<const LinesOfSight> voxel_sight(std::shared_ptr<const ExpectedSurface> surface);

}  // namespace saccade
