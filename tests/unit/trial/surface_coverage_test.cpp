// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/surface_coverage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "saccade/scene/surface_samples.hpp"
#include "support/placed_object.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using test::placed;

const PinholeCamera kSmallCamera{96, 72, 90.0, 90.0, 47.5, 35.5, 0.05, 2.0};

/// A block beside a ball, on a table.
const RayScene& block_and_ball() {
  static const RayScene made = [] {
    Scene scene;
    scene.name = "block and ball";
    scene.workspace = Box{{-0.3, -0.3, -0.03}, {0.3, 0.3, 0.3}};
    SceneObject table = placed("table", BoxShape{{0.8, 0.8, 0.04}}, {0.0, 0.0, -0.04});
    table.support = true;
    scene.objects = {table, placed("block", BoxShape{{0.08, 0.06, 0.1}}, {-0.06, 0.0, 0.0}),
                     placed("ball", SphereShape{0.05}, {0.06, 0.0, 0.0})};
    return *RayScene::build(scene);
  }();
  return made;
}

const std::vector<Pose> kLookingViews{look_at({-0.4, 0.1, 0.2}, {0.0, 0.0, 0.05}),
                                      look_at({0.1, 0.4, 0.3}, {0.0, 0.0, 0.05}),
                                      look_at({0.4, -0.2, 0.05}, {0.0, 0.0, 0.05})};

/// All points that a view measures on objects, by one cast per pixel.
std::vector<Vector3d> points_measured(const RayScene& scene, const Pose& view) {
  std::vector<Vector3d> points;
  for (int v = 0; v < kSmallCamera.height; ++v) {
    for (int u = 0; u < kSmallCamera.width; ++u) {
      const Vector3d direction = view.linear() * kSmallCamera.ray(u, v);
      const auto hit = scene.cast(view.translation(), direction);
      if (!hit || hit->t < kSmallCamera.min_range_m || hit->t > kSmallCamera.max_range_m) continue;
      if (!scene.meshes()[hit->object].support) points.push_back(view.translation() + hit->t * direction);
    }
  }
  return points;
}

SurfaceSamples object_samples(const RayScene& scene, double spacing_m) {
  std::vector<ObjectMesh> objects;
  for (const ObjectMesh& mesh : scene.meshes()) {
    if (!mesh.support) objects.push_back(mesh);
  }
  return sample_surfaces(objects, spacing_m);
}

std::vector<Vector3d> object_points(const RayScene& scene, double spacing_m) {
  std::vector<Vector3d> points;
  for (const Eigen::Vector3f& p : object_samples(scene, spacing_m).points) points.push_back(p.cast<double>());
  return points;
}

/// Whether one of the candidates has the point in its image, with nothing in between: by the nearest hit of the ray.
bool shown_by_any(const RayScene& scene, const Vector3d& p, const std::vector<Pose>& candidates) {
  for (const Pose& view : candidates) {
    const Vector3d in_camera = view.inverse() * p;
    if (in_camera.z() <= kSmallCamera.min_range_m || in_camera.z() >= kSmallCamera.max_range_m) continue;
    const Eigen::Vector2d pixel = kSmallCamera.project(in_camera);
    if (std::abs(pixel.x() - 47.5) > 48.0 || std::abs(pixel.y() - 35.5) > 36.0) continue;
    const auto hit = scene.cast(view.translation(), (p - view.translation()).normalized());
    if (hit && hit->t > (p - view.translation()).norm() - 5e-4) return true;
  }
  return false;
}

TEST(SurfaceCoverage, CountsAsAPlainSearchDoesByDistance) {
  const RayScene& scene = block_and_ball();
  const CoverageRule rule{CoverageRule::Kind::distance, 0.006, 0.004};
  const Executor executor = Executor::with_threads(2);
  const auto surface = SurfaceCoverage::build(scene, kSmallCamera, kLookingViews, rule, executor);
  ASSERT_TRUE(surface) << surface.error().message;
  const std::vector<Vector3d> samples = object_points(scene, rule.spacing_m);
  ASSERT_EQ(surface->size(), samples.size());
  std::size_t visible = 0;
  for (const Vector3d& p : samples) visible += shown_by_any(scene, p, kLookingViews) ? 1 : 0;
  EXPECT_EQ(surface->visible(), visible);
  EXPECT_LT(visible, samples.size());

  const std::vector<CoverageShares> shares = surface->along(kLookingViews, executor);
  ASSERT_EQ(shares.size(), kLookingViews.size());
  const SurfaceSamples surfaces = object_samples(scene, rule.spacing_m);
  std::vector<std::uint8_t> measured(samples.size());
  for (std::size_t k = 0; k < kLookingViews.size(); ++k) {
    const std::vector<Vector3d> points = points_measured(scene, kLookingViews[k]);
    const Vector3d eye = kLookingViews[k].translation();
    std::size_t all = 0;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vector3d& p = samples[i];
      const auto is_near = [&](const Vector3d& q) { return (p - q).norm() <= rule.size_m; };
      const bool faces = surfaces.normals[i].cast<double>().dot(eye - p) > 0.0;
      if (faces && std::any_of(points.begin(), points.end(), is_near)) measured[i] = 1;
      all += measured[i];
      seen += measured[i] != 0 && shown_by_any(scene, p, kLookingViews) ? 1 : 0;
    }
    // The render rounds a depth to single precision; a point at the limit may fall on either side.
    EXPECT_NEAR(shares[k].of_all * static_cast<double>(samples.size()), static_cast<double>(all), 2.0) << k;
    EXPECT_NEAR(shares[k].of_visible * static_cast<double>(visible), static_cast<double>(seen), 2.0) << k;
    EXPECT_GT(all, samples.size() / 5);
  }
  EXPECT_GT(shares.back().of_all, shares.front().of_all);
}

TEST(SurfaceCoverage, CountsAsAPlainSearchDoesByVoxels) {
  const RayScene& scene = block_and_ball();
  const CoverageRule rule{CoverageRule::Kind::voxels, 0.01, 0.003};
  const Executor executor;
  const auto surface = SurfaceCoverage::build(scene, kSmallCamera, kLookingViews, rule, executor);
  ASSERT_TRUE(surface) << surface.error().message;
  const auto voxel_of = [&](const Vector3d& p) {
    return std::array{std::floor(p.x() / 0.01), std::floor(p.y() / 0.01), std::floor(p.z() / 0.01)};
  };
  std::set<std::array<double, 3>> all;
  std::set<std::array<double, 3>> visible;
  for (const Vector3d& p : object_points(scene, rule.spacing_m)) {
    all.insert(voxel_of(p));
    if (shown_by_any(scene, p, kLookingViews)) visible.insert(voxel_of(p));
  }
  EXPECT_EQ(surface->size(), all.size());
  EXPECT_EQ(surface->visible(), visible.size());
  const std::vector<CoverageShares> shares = surface->along(kLookingViews, executor);
  std::set<std::array<double, 3>> measured;
  for (std::size_t k = 0; k < kLookingViews.size(); ++k) {
    for (const Vector3d& p : points_measured(scene, kLookingViews[k])) {
      if (all.count(voxel_of(p)) > 0) measured.insert(voxel_of(p));
    }
    std::size_t seen = 0;
    for (const auto& voxel : measured) seen += visible.count(voxel);
    // Surfaces that lie on the border of two voxels: rounding decides (the block's faces, at whole centimetres).
    const double slack = 0.05 * static_cast<double>(all.size());
    EXPECT_NEAR(shares[k].of_all * static_cast<double>(all.size()), static_cast<double>(measured.size()), slack) << k;
    EXPECT_NEAR(shares[k].of_visible * static_cast<double>(visible.size()), static_cast<double>(seen), slack) << k;
  }
}

TEST(SurfaceCoverage, DoesNotCountTheFarSideOfAThinWall) {
  Scene made;
  made.name = "sheet";
  made.workspace = Box{{-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}};
  made.objects = {placed("sheet", BoxShape{{0.004, 0.2, 0.2}}, {0.0, 0.0, -0.1})};
  const auto scene = RayScene::build(made);
  ASSERT_TRUE(scene);
  const std::vector<Pose> views{look_at({-0.4, 0.0, 0.0}, Vector3d::Zero()),
                                look_at({0.4, 0.0, 0.0}, Vector3d::Zero())};
  const CoverageRule rule{CoverageRule::Kind::distance, 0.006, 0.004};
  const Executor executor;
  const auto surface = SurfaceCoverage::build(*scene, kSmallCamera, views, rule, executor);
  ASSERT_TRUE(surface) << surface.error().message;
  const std::vector<CoverageShares> shares = surface->along(views, executor);
  EXPECT_NEAR(shares[0].of_all, 0.5, 0.06);  // its far side lies 4 mm behind what was measured
  EXPECT_GT(shares[1].of_all, 0.9);
}

TEST(SurfaceCoverage, IsTheSameOnEveryThreadCount) {
  const CoverageRule rule{CoverageRule::Kind::distance, 0.006, 0.006};
  std::vector<CoverageShares> first;
  for (const std::size_t threads : {1U, 3U}) {
    const Executor executor = Executor::with_threads(threads);
    const auto surface = SurfaceCoverage::build(block_and_ball(), kSmallCamera, kLookingViews, rule, executor);
    ASSERT_TRUE(surface);
    const std::vector<CoverageShares> shares = surface->along(kLookingViews, executor);
    if (first.empty()) first = shares;
    ASSERT_EQ(shares.size(), first.size());
    for (std::size_t k = 0; k < shares.size(); ++k) {
      EXPECT_EQ(shares[k].of_all, first[k].of_all);
      EXPECT_EQ(shares[k].of_visible, first[k].of_visible);
    }
  }
}

TEST(SurfaceCoverage, LeavesOutWhatLiesInsideAnotherObject) {
  Scene scene;
  scene.name = "two balls";
  scene.workspace = Box{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  scene.objects = {placed("large", SphereShape{0.1}, {0.0, 0.0, -0.1}),
                   placed("within", SphereShape{0.05}, {0.0, 0.0, -0.05})};
  const auto joined = RayScene::build(scene);
  scene.objects.pop_back();
  const auto alone = RayScene::build(scene);
  ASSERT_TRUE(joined && alone);
  const CoverageRule rule{CoverageRule::Kind::distance, 0.005, 0.005};
  const auto of_both = SurfaceCoverage::build(*joined, kSmallCamera, kLookingViews, rule, {});
  const auto of_one = SurfaceCoverage::build(*alone, kSmallCamera, kLookingViews, rule, {});
  ASSERT_TRUE(of_both && of_one);
  EXPECT_EQ(of_both->size(), of_one->size());
}

TEST(SurfaceCoverage, RefusesWhatMakesNoSense) {
  const auto with = [](const CoverageRule& rule) {
    return SurfaceCoverage::build(block_and_ball(), kSmallCamera, kLookingViews, rule, {});
  };
  EXPECT_EQ(with({CoverageRule::Kind::distance, 0.0, 0.002}).error().code, Errc::invalid_argument);
  EXPECT_EQ(with({CoverageRule::Kind::distance, 0.005, std::nan("")}).error().code, Errc::invalid_argument);
  EXPECT_EQ(with({CoverageRule::Kind::voxels, 0.001, 0.002}).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
