// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceViews: views of contours, and spheres of views around missing surface.

#include "saccade/views/expected_surface.hpp"
#include "saccade/views/view_generator.hpp"

namespace saccade {

struct SurfaceViewsConfig {
  /// Sphere around each cell; coarser than a single sphere, since cells are adjacent.
  ViewSphereConfig sphere{.latitude_step_rad = 15_deg, .roll_step_rad = 90_deg};
  double cell_m{0.15};
  double least_cm2{5.0};  ///< cells with less expected surface get no sphere
  ExpectedSurfaceConfig surface{};

  /// Answers invalid_argument for a cell or an area that is not positive and finite; errors of its parts.
  [[nodiscard]] Status validate() const;
};

/// Views of contours and spheres. Contours lie where the seen surface ends, and their views come from where it faces. A
/// sphere looks at missing surface from all around: over a rim, or between two objects.
class SurfaceViews final : public ViewGenerator {
 public:
  /// Expects a valid configuration.
  SurfaceViews(std::shared_ptr<ViewGenerator> contours, const SurfaceViewsConfig& config = {});
  /// Returns the views of contours first, then a sphere about the mean of the expected points in each cell of the
  /// workspace. Errors of both, and of expected_surface.
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& context, const RegionOfInterest& region) override;

 private:
  std::shared_ptr<ViewGenerator> contours_;
  SurfaceViewsConfig config_;
};

}  // namespace saccade
