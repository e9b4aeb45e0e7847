// SPDX-License-Identifier: Apache-2.0
// Spheres of views around what is missing, behind the views of contours.
#include "saccade/views/surface_views.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/half_seen_box.hpp"

namespace saccade {
namespace {

RegionOfInterest everywhere() {
  RegionOfInterest region;
  region.bounds = Box{{-5.0, -5.0, -5.0}, {5.0, 5.0, 5.0}};
  return region;
}

ViewCandidates views_of(const TsdfSnapshot& map, const RegionOfInterest& region,
                        const SurfaceViewsConfig& config = {}) {
  const Executor executor;
  SurfaceViews views{std::make_shared<ContourViews>(), config};
  return views.views({map, executor}, region).value();
}

TEST(SurfaceViews, LookAtWhatIsMissingFromAllAround) {
  const TsdfSnapshot map = test::half_seen_box();
  const Executor executor;
  const ViewCandidates contours = ContourViews{}.views({map, executor}, everywhere()).value();
  const ViewCandidates found = views_of(map, everywhere());
  const std::size_t of_contours = contours.T_world_camera.size();
  ASSERT_GT(of_contours, 0U);
  const std::size_t of_spheres = found.T_world_camera.size() - of_contours;
  const std::size_t a_sphere = view_sphere({0.0, 0.0, 0.0}, SurfaceViewsConfig{}.sphere)->size();
  EXPECT_GT(of_spheres, 0U);
  EXPECT_EQ(of_spheres % a_sphere, 0U);
  EXPECT_EQ(found.in_all, contours.in_all + of_spheres);
  const ExpectedSurface surface = expected_surface(map, {}, executor).value();
  bool from_behind = false;
  for (std::size_t i = 0; i < found.T_world_camera.size(); ++i) {
    const Pose& pose = found.T_world_camera[i];
    if (i < of_contours) {
      EXPECT_EQ(pose.matrix(), contours.T_world_camera[i].matrix());
      continue;
    }
    const Eigen::Vector3d center = pose * Eigen::Vector3d{0.0, 0.0, 0.8};
    EXPECT_TRUE(std::any_of(surface.points.begin(), surface.points.end(), [&](const ExpectedPoint& point) {
      return (point.position_m.cast<double>() - center).norm() < 0.15;
    })) << center.transpose();
    from_behind |= pose.translation().x() > 0.5;
  }
  EXPECT_TRUE(from_behind);
}

TEST(SurfaceViews, AreOfTheRegionAlone) {
  const TsdfSnapshot map = test::half_seen_box();
  const Executor executor;
  RegionOfInterest elsewhere;
  elsewhere.bounds = Box{{3.0, 3.0, 3.0}, {4.0, 4.0, 4.0}};
  const std::size_t of_contours = ContourViews{}.views({map, executor}, elsewhere).value().T_world_camera.size();
  EXPECT_EQ(views_of(map, elsewhere).T_world_camera.size(), of_contours);
  SurfaceViewsConfig large;
  large.least_cm2 = 1e6;
  EXPECT_EQ(views_of(map, everywhere(), large).T_world_camera.size(), of_contours) << "no cell misses as much";
}

TEST(SurfaceViews, RefuseABadConfiguration) {
  SurfaceViewsConfig config;
  EXPECT_TRUE(config.validate().ok());
  config.cell_m = 0.0;
  EXPECT_FALSE(config.validate().ok());
  config = {};
  config.least_cm2 = -1.0;
  EXPECT_FALSE(config.validate().ok());
  config = {};
  config.sphere.radii_m = {};
  EXPECT_EQ(config.validate().ok(), ViewSphereConfig{.radii_m = {}}.validate().ok());
}

}  // namespace
}  // namespace saccade
