// SPDX-License-Identifier: Apache-2.0
// Directions of contours after real views: Fig. 3.4 of the thesis, and what eq. 3.6 makes of saturated free space
// (docs/decisions/0009-contours.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <vector>

#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/noise.hpp"
#include "saccade/views/contours.hpp"
#include "saccade/views/view_gain.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr int kFrames{10};
const PinholeCamera kWide{320, 240, 262.5, 262.5, 159.5, 119.5, 0.3, 4.0};
const HalfSpace kWall{-Eigen::Vector3d::UnitX(), -1.2};

/// Ten frames of each view, with noise, turned by up to 5°; nothing is unknown farther than 0.25 m from the origin.
TsdfSnapshot seen_from(const AnalyticScene& scene, const std::vector<Pose>& views, double truncation_vox) {
  TsdfConfig config;
  config.color = false;
  config.truncation_vox = truncation_vox;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.25);
  config.workspace = Box{-half, half};
  TsdfMap map = TsdfMap::create(config).value();
  std::uint64_t number{0};
  for (const Pose& view : views) {
    for (int frame = 0; frame < kFrames; ++frame) {
      Pose T_world_camera = view;
      T_world_camera.rotate(Eigen::AngleAxisd{(2.0 * frame / (kFrames - 1) - 1.0) * 0.087, Eigen::Vector3d::UnitX()});
      const DepthImage depth = render(scene, kWide, T_world_camera).value().depth;
      EXPECT_TRUE(map.integrate(kWide, with_noise(depth, {}, number++), T_world_camera, {}).ok());
    }
  }
  return map.snapshot();
}

/// Eq. 3.5 with eq. 3.6 as printed.
Eigen::Vector3f normal_as_printed(const TsdfSnapshot& map, const Index3& e) {
  constexpr int kKnown{5};
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3i step{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    if (step.isZero()) continue;
    const Voxel voxel = map.grid.voxel(e + Index3{step.x(), step.y(), step.z()});
    const bool occupied = voxel.w >= kKnown && voxel.v <= 0;
    n += (occupied ? -kKnown : std::min(voxel.w - kKnown, kKnown)) * step.cast<double>().normalized();
  }
  return n.normalized().cast<float>();
}

struct Deviation {
  double mean_rad{0.0};
  double largest_rad{0.0};
};
template <class Ideal>
Deviation deviation(const TsdfSnapshot& map, const std::vector<ContourVoxel>& voxels, const Ideal& ideal) {
  Deviation of;
  for (const ContourVoxel& voxel : voxels) {
    const Eigen::Vector3d n = voxel.normal.cast<double>();
    const double cosine = n.dot(ideal(voxel_center(voxel.voxel, map.config.voxel_size_m)));
    const double angle_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
    of.mean_rad += angle_rad / static_cast<double>(voxels.size());
    of.largest_rad = std::max(of.largest_rad, angle_rad);
  }
  return of;
}

std::vector<ContourVoxel> contours_near_origin(const TsdfSnapshot& map) {
  std::vector<ContourVoxel> voxels = contour_voxels(map, {}, {}).value();
  std::erase_if(voxels, [&](const ContourVoxel& voxel) {
    return voxel_center(voxel.voxel, map.config.voxel_size_m).norm() > 0.2;
  });
  return voxels;
}
std::vector<ContourVoxel> as_printed(const TsdfSnapshot& map, std::vector<ContourVoxel> voxels) {
  for (ContourVoxel& voxel : voxels) voxel.normal = normal_as_printed(map, voxel.voxel);
  return voxels;
}

double degrees_of(double rad) { return rad * 180.0 / std::numbers::pi; }

std::vector<std::uint64_t> gains_of(const TsdfSnapshot& map, const std::vector<Pose>& views) {
  GainConfig config;
  config.sensor = {160, 120, 131.25, 131.25, 79.5, 59.5, 0.5, 6.0};
  return evaluate_views(map, Sphere{{0.0, 0.0, 0.0}, 0.25}, views, config, {}).value().gains;
}

/// The direct view of each contour point.
std::vector<Pose> direct_views(const TsdfSnapshot& map, const std::vector<ContourVoxel>& voxels) {
  std::vector<Pose> views;
  for (const ContourPoint& point : contour_points(voxels, map.config.voxel_size_m, {})) {
    views.push_back(look_at(point.position_m + 0.8 * point.normal, point.position_m));
  }
  return views;
}

double mean_gain(const TsdfSnapshot& map, const std::vector<ContourVoxel>& voxels) {
  const std::vector<std::uint64_t> gains = gains_of(map, direct_views(map, voxels));
  return static_cast<double>(std::accumulate(gains.begin(), gains.end(), std::uint64_t{0})) /
         static_cast<double>(gains.size());
}

TEST(ContourDirections, OfARoundThingPointAwayFromIt) {
  AnalyticScene scene;
  scene.objects = {{"ball", Sphere{{0.0, 0.0, 0.0}, 0.1}}, {"wall", kWall}};
  for (const double truncation_vox : {2.0, 4.0}) {
    const TsdfSnapshot map = seen_from(scene, {look_at({-0.9, 0.013, 0.007}, {0.0, 0.013, 0.007})}, truncation_vox);
    const std::vector<ContourVoxel> voxels = contours_near_origin(map);
    ASSERT_GT(voxels.size(), 100U);
    const auto outward = [](const Eigen::Vector3d& p) { return p.normalized(); };
    const Deviation ours = deviation(map, voxels, outward);
    const Deviation printed = deviation(map, as_printed(map, voxels), outward);
    std::printf("ball, truncation %.0f: %.1f deg, at most %.1f; as printed %.1f, at most %.1f\n", truncation_vox,
                degrees_of(ours.mean_rad), degrees_of(ours.largest_rad), degrees_of(printed.mean_rad),
                degrees_of(printed.largest_rad));
    EXPECT_LT(degrees_of(ours.mean_rad), 10.0);
    EXPECT_LT(degrees_of(ours.largest_rad), 25.0);
    EXPECT_LT(ours.mean_rad, 0.8 * printed.mean_rad);
  }
}

/// Fig. 3.4 b: the surface that was seen says nothing about where to look from; beyond its edge the frontier does.
TEST(ContourDirections, OfABoxSeenFromOneSideShowItsOtherSides) {
  AnalyticScene scene;
  scene.objects = {{"box", Box{Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(0.1)}}, {"wall", kWall}};
  const auto side = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d across{0.0, p.y(), p.z()};
    return std::abs(p.y()) > std::abs(p.z()) ? Eigen::Vector3d{0.0, std::copysign(1.0, p.y()), 0.0}
                                             : Eigen::Vector3d{0.0, 0.0, std::copysign(1.0, p.z())};
  };
  for (const double truncation_vox : {2.0, 4.0}) {
    const TsdfSnapshot map = seen_from(scene, {look_at({-0.9, 0.013, 0.007}, {0.0, 0.013, 0.007})}, truncation_vox);
    const std::vector<ContourVoxel> voxels = contours_near_origin(map);
    ASSERT_GT(voxels.size(), 80U);
    const Deviation ours = deviation(map, voxels, side);
    const Deviation printed = deviation(map, as_printed(map, voxels), side);
    std::vector<Pose> by_surface;
    for (const ContourPoint& point : contour_points(voxels, map.config.voxel_size_m, {})) {
      by_surface.push_back(look_at(point.position_m - 0.8 * Eigen::Vector3d::UnitX(), point.position_m));
    }
    const std::vector<std::uint64_t> gains = gains_of(map, direct_views(map, voxels));
    const std::vector<std::uint64_t> gains_by_surface = gains_of(map, by_surface);
    const auto worst = *std::min_element(gains.begin(), gains.end());
    const auto best_by_surface = *std::max_element(gains_by_surface.begin(), gains_by_surface.end());
    std::printf(
        "box, truncation %.0f: %.1f deg from the sides; as printed %.1f; gains from %llu, by the surface to %llu\n",
        truncation_vox, degrees_of(ours.mean_rad), degrees_of(printed.mean_rad), static_cast<unsigned long long>(worst),
        static_cast<unsigned long long>(best_by_surface));
    EXPECT_LT(degrees_of(ours.mean_rad), 25.0);
    EXPECT_GT(worst, 2 * best_by_surface);
  }
}

TEST(ContourDirections, OfThingsOnATableShowMoreThanAsPrinted) {
  if (test::kSanitized) GTEST_SKIP() << "takes long under sanitizers; the other tests of contours run the code";
  AnalyticScene scene;
  scene.objects = {{"table", HalfSpace{Eigen::Vector3d::UnitZ(), -0.1}},
                   {"box", Box{{-0.12, -0.05, -0.1}, {-0.04, 0.07, 0.06}}},
                   {"can", Cylinder{{0.07, 0.05, -0.1}, {0.07, 0.05, 0.02}, 0.04}},
                   {"ball", Sphere{{0.05, -0.1, -0.05}, 0.05}}};
  double ours{0.0};
  double printed{0.0};
  for (const double truncation_vox : {2.0, 4.0}) {
    for (const double turn_rad : {0.0, 2.0, 4.0}) {
      std::vector<Pose> views;
      for (const double angle_rad : {turn_rad, turn_rad + 2.1}) {
        views.push_back(look_at({0.56 * std::cos(angle_rad), 0.56 * std::sin(angle_rad), 0.57}, {0.0, 0.0, 0.0}));
      }
      const TsdfSnapshot map = seen_from(scene, views, truncation_vox);
      const std::vector<ContourVoxel> voxels = contours_near_origin(map);
      ASSERT_GT(voxels.size(), 100U);
      ours += mean_gain(map, voxels) / 6.0;
      printed += mean_gain(map, as_printed(map, voxels)) / 6.0;
    }
  }
  std::printf("table: mean gain %.0f, as printed %.0f\n", ours, printed);
  EXPECT_GT(ours, printed);
}

}  // namespace
}  // namespace saccade
