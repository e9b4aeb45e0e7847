// SPDX-License-Identifier: Apache-2.0
#pragma once
// FixedViews: a given set of candidate views, the same for every strategy. hemisphere_views, shell_views: the sets of
// published protocols.

#include <cstdint>
#include <memory>

#include "saccade/views/view_generator.hpp"

namespace saccade {

/// Returns `count` views spread evenly over the upper half of a sphere, from its top down to its equator, all looking
/// at `center`, image up as the world's. Positions follow the golden angle, so their number may be any. Expects a
/// positive count and radius. O(count).
[[nodiscard]] std::vector<Pose> hemisphere_views(const Eigen::Vector3d& center, double radius_m, std::size_t count);

struct ShellViewsConfig {
  double inner_half_edge_m{0.2};  ///< no view lies within this cube around the centre
  double outer_radius_m{0.4};     ///< nor beyond this sphere
  std::size_t count{5000};
  std::uint64_t seed{1};

  /// Answers invalid_argument for lengths that are not positive, a cube that leaves no room in the sphere, and no view.
  [[nodiscard]] Status validate() const;
};

/// Returns random views around an object, uniform over the volume between a cube and a sphere, all looking at `center`.
/// Equal for equal seeds on every platform. Errors: those of validate. O(count).
[[nodiscard]] Result<std::vector<Pose>> shell_views(const Eigen::Vector3d& center, const ShellViewsConfig& config);

/// Generator of one set of candidates, whatever the region and the map.
class FixedViews final : public ViewGenerator {
 public:
  /// Expects views.
  explicit FixedViews(std::shared_ptr<const std::vector<Pose>> T_world_camera)
      : T_world_camera_{std::move(T_world_camera)} {
    SACCADE_EXPECTS(T_world_camera_ && !T_world_camera_->empty());
  }
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& context, const RegionOfInterest& region) override;

 private:
  std::shared_ptr<const std::vector<Pose>> T_world_camera_;
};

}  // namespace saccade
