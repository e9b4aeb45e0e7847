// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/surfel_sight.hpp"

#include "saccade/views/internal/depth_panorama.hpp"
#include "saccade/views/internal/disc_blocks.hpp"
#include "saccade/views/internal/surfel_frontier.hpp"

namespace saccade {
namespace {

/// Surfels and points of one state of the map, which its places share.
struct SurfelScene {
  std::shared_ptr<const ExpectedSurface> surface;
  DiscBlocks seen;
  DiscBlocks unknown;
  std::vector<std::uint8_t> is_seen;  ///< per voxel of the surface's volume
  int edge_px{0};
};

class SurfelOutlook final : public Outlook {
 public:
  /// @param points_m those that are asked about
  SurfelOutlook(const SurfelScene& scene, const Eigen::Vector3f& camera_m, std::span<const Eigen::Vector3f> points_m)
      : scene_{&scene}, seen_{camera_m, scene.edge_px, points_m}, unknown_{camera_m, scene.edge_px, points_m} {
    const float two_pixels_rad = 4.0F / static_cast<float>(scene.edge_px);  // a face's pixels are largest in its middle
    const ViewCone cone = ViewCone::around(camera_m, points_m, two_pixels_rad);
    scene.seen.for_each_in(cone, [&](std::span<const SurfelDisc> discs) { seen_.add(discs); });
    scene.unknown.for_each_in(cone, [&](std::span<const SurfelDisc> discs) { unknown_.add(discs); });
  }
  [[nodiscard]] bool sees(const ExpectedPoint& point, double through_m) const override {
    if (scene_->is_seen[point.voxel] != 0) return false;
    const auto voxel_m = static_cast<float>(scene_->surface->volume->voxel_size_m());
    const float depth_m = seen_.depth_m(point.position_m);
    return depth_m <= seen_.nearest_m(point.position_m) + voxel_m &&
           depth_m <= unknown_.nearest_m(point.position_m) + static_cast<float>(through_m) + voxel_m;
  }

 private:
  const SurfelScene* scene_;
  DepthPanorama seen_;
  DepthPanorama unknown_;
};

class SurfelSight final : public LinesOfSight {
 public:
  explicit SurfelSight(SurfelScene scene) : scene_{std::move(scene)} {}
  [[nodiscard]] std::unique_ptr<const Outlook> from(const Eigen::Vector3d& camera_m,
                                                    std::span<const ExpectedPoint* const> points) const override {
    std::vector<Eigen::Vector3f> points_m;
    for (const ExpectedPoint* point : points) points_m.push_back(point->position_m);
    return std::make_unique<const SurfelOutlook>(scene_, camera_m.cast<float>(), points_m);
  }

 private:
  SurfelScene scene_;
};

}  // namespace

Status SurfelSightConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "surfel sight"}; };
  if (edge_px < 1 || edge_px > 4096) return fail("the edge of a panorama has 1 to 4096 pixels");
  if (!(cell_share > 0.0 && cell_share <= 1.0)) return fail("the share of a voxel lies above 0, at most 1");
  return unknown.validate();
}

MakeSight surfel_sight(const SurfelMap& surfels, const SurfelSightConfig& config) {
  // Two passes over the views of one choice share their sight.
  struct Latest {
    std::weak_ptr<const ExpectedSurface> surface;
    std::weak_ptr<const LinesOfSight> sight;
  };
  const auto latest = std::make_shared<Latest>();
  return [&surfels, config, latest](std::shared_ptr<const ExpectedSurface> surface,
                                    const Executor& executor) -> Result<std::shared_ptr<const LinesOfSight>> {
    constexpr double kVoxelsPerBlock{5.0};
    SACCADE_CHECK(config.validate());
    std::shared_ptr<const LinesOfSight> sight = latest->sight.lock();
    if (sight && latest->surface.lock() == surface) return sight;
    const double voxel_m = surface->volume->voxel_size_m();
    SurfelScene scene;
    scene.edge_px = config.edge_px;
    scene.is_seen = seen_voxels(*surface->volume, surfels, config.unknown);
    scene.unknown = DiscBlocks{frontier_discs(*surface->volume, scene.is_seen, executor), kVoxelsPerBlock * voxel_m};
    scene.seen = DiscBlocks{thinned_discs(surfels, config.unknown.min_weight, config.cell_share * voxel_m),
                            kVoxelsPerBlock * voxel_m};
    latest->surface = surface;
    scene.surface = std::move(surface);
    sight = std::make_shared<const SurfelSight>(std::move(scene));
    latest->sight = sight;
    return sight;
  };
}

}  // namespace saccade
