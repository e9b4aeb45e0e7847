// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceViews: views of contours, and spheres of views around what is expected to be missing.

#include "saccade/views/expected_surface.hpp"
#include "saccade/views/view_generator.hpp"

namespace saccade {

struct SurfaceViewsConfig {
  /// Around each cell; coarser than a sphere that stands alone, since cells lie side by side.
  ViewSphereConfig sphere{.latitude_step_rad = 15_deg, .roll_step_rad = 90_deg};
  double cell_m{0.15};
  double least_cm2{5.0};  ///< cells where less surface is expected get no sphere
  ExpectedSurfaceConfig surface{};

  /// invalid_argument for a cell or an area that is not positive and finite; errors of its parts.
  [[nodiscard]] Status validate() const;
};

/// Contours lie where the seen surface ends, and views of them come from where it faces. A sphere looks at what is
/// missing from all around: over a rim, or between two things.
class SurfaceViews final : public ViewGenerator {
 public:
  /// Expects a valid configuration.
  SurfaceViews(std::shared_ptr<ViewGenerator> contours, const SurfaceViewsConfig& config = {});
  /// Views of contours first, then a sphere about the mean of the expected points in each cell of the workspace.
  /// Errors of both, and of expected_surface.
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& context, const RegionOfInterest& region) override;

 private:
  std::shared_ptr<ViewGenerator> contours_;
  SurfaceViewsConfig config_;
};

}  // namespace saccade
