// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "saccade/sensor/noise.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr PinholeCamera kCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 6.0};

TEST(AnalyticScene, DepthIsAlongZ) {
  AnalyticScene scene;
  scene.objects = {{"plane", HalfSpace{{0, 0, -1}, -2.0}}};  // everything beyond z = 2
  const auto frame = render(scene, kCamera, Pose::Identity());
  ASSERT_TRUE(frame);
  for (const float d : frame->depth.pixels()) EXPECT_FLOAT_EQ(d, 2.0F);
}

TEST(AnalyticScene, EachShapeIsHitWhereItIs) {
  const Vector3d x = Vector3d::UnitX();
  const auto first = [&](const auto& shape) {
    AnalyticScene scene;
    scene.objects = {{"it", shape}};
    return scene.cast({-3, 0, 0}, x);
  };
  const auto sphere = first(Sphere{{0, 0, 0}, 0.5});
  ASSERT_TRUE(sphere);
  EXPECT_DOUBLE_EQ(sphere->t, 2.5);
  EXPECT_TRUE(sphere->normal_world.isApprox(-x));
  const auto box = first(Box{{-1, -1, -1}, {1, 1, 1}});
  ASSERT_TRUE(box);
  EXPECT_DOUBLE_EQ(box->t, 2.0);
  EXPECT_TRUE(box->normal_world.isApprox(-x));
  const auto side = first(Cylinder{{0, 0, -1}, {0, 0, 1}, 0.25});
  ASSERT_TRUE(side);
  EXPECT_DOUBLE_EQ(side->t, 2.75);
  EXPECT_TRUE(side->normal_world.isApprox(-x));
  const auto cap = first(Cylinder{{-1, 0, 0}, {1, 0, 0}, 0.25});
  ASSERT_TRUE(cap);
  EXPECT_DOUBLE_EQ(cap->t, 2.0);
  EXPECT_TRUE(cap->normal_world.isApprox(-x));
  EXPECT_FALSE(first(Sphere{{0, 0, 1}, 0.5}));
  EXPECT_FALSE(first(Box{{-1, 0.1, -1}, {1, 1, 1}}));
  EXPECT_FALSE(first(Cylinder{{0, 0, 0.1}, {0, 0, 1}, 0.25}));
  EXPECT_FALSE(first(Sphere{{-5, 0, 0}, 0.5}));  // behind
}

TEST(AnalyticScene, HitsLieOnTheSurfaceAndNothingLiesBefore) {
  const AnalyticScene scene = sample_tabletop();
  ASSERT_TRUE(scene.validate());
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> coordinate{-1.0, 1.0};
  std::size_t hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d origin{coordinate(random), -0.5 + 0.3 * coordinate(random), 0.8 + 0.3 * coordinate(random)};
    const Vector3d direction{coordinate(random), coordinate(random), -0.8};
    if (scene.signed_distance_m(origin) < 0.0) continue;
    const auto hit = scene.cast(origin, direction);
    if (!hit) continue;
    ++hits;
    const Vector3d p = origin + hit->t * direction;
    EXPECT_NEAR(scene.signed_distance_m(p), 0.0, 1e-9);
    EXPECT_NEAR(hit->normal_world.norm(), 1.0, 1e-9);
    EXPECT_LE(hit->normal_world.dot(direction), 1e-9);
    EXPECT_GT(scene.signed_distance_m(p + 1e-3 * hit->normal_world), 0.0);
    for (double s = 0.05; s < 0.99; s += 0.05) {
      EXPECT_GE(scene.signed_distance_m(origin + s * hit->t * direction), -1e-9);
    }
  }
  EXPECT_GT(hits, 1500U);
}

TEST(AnalyticScene, RangeLimitsApply) {
  AnalyticScene scene;
  scene.objects = {{"ball", Sphere{{0, 0, 2}, 0.5}}};
  PinholeCamera camera = kCamera;
  camera.max_range_m = 1.6;
  const auto frame = render(scene, camera, Pose::Identity());
  ASSERT_TRUE(frame);
  std::size_t seen = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      EXPECT_TRUE(frame->depth(u, v) == 0.0F || (frame->depth(u, v) >= 1.5F && frame->depth(u, v) <= 1.6F));
      EXPECT_EQ(frame->object_id(u, v), frame->depth(u, v) > 0.0F ? 0 : -1);
      seen += frame->depth(u, v) > 0.0F ? 1U : 0U;
    }
  }
  EXPECT_GT(seen, 100U);
  camera.width = 0;
  EXPECT_FALSE(render(scene, camera, Pose::Identity()));
  scene.objects[0].shape = Sphere{{0, 0, 2}, -1.0};
  EXPECT_FALSE(render(scene, kCamera, Pose::Identity()));
}

TEST(AnalyticScene, TrajectorySeesEveryObjectAndMovesSmoothly) {
  const AnalyticScene scene = sample_tabletop();
  const auto poses = sample_trajectory(60);
  ASSERT_EQ(poses.size(), 60U);
  std::vector<std::size_t> pixels(scene.objects.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double distance_m = poses[i].translation().norm();
    EXPECT_GT(distance_m, 0.6);
    EXPECT_LT(distance_m, 1.05);
    EXPECT_GT(scene.signed_distance_m(poses[i].translation()), 0.3);
    if (i > 0) {
      const Pose step = poses[i - 1].inverse() * poses[i];
      EXPECT_LT(step.translation().norm(), 0.06);
      EXPECT_LT(rotation_angle_rad(step), 0.06);
    }
    const auto frame = render(scene, kCamera, poses[i]);
    ASSERT_TRUE(frame);
    for (const int id : frame->object_id.pixels()) {
      if (id >= 0) ++pixels[static_cast<std::size_t>(id)];
    }
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) EXPECT_GT(pixels[i], 1000U) << scene.objects[i].name;
  EXPECT_EQ(sample_trajectory(1).size(), 1U);
}

TEST(AnalyticScene, EveryThreadCountGivesTheSameImage) {
  const AnalyticScene scene = sample_tabletop();
  const Pose pose = sample_trajectory(3)[1];
  const auto one = render(scene, kCamera, pose);
  const auto four = render(scene, kCamera, pose, Executor::with_threads(4));
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->depth, four->depth);
  EXPECT_EQ(one->color, four->color);
  EXPECT_EQ(one->object_id, four->object_id);
}

TEST(DepthNoise, HasTheStatedSpreadAndIsRepeatable) {
  const DepthImage flat{200, 200, 2.0F};
  const DepthNoise noise{.dropout = 0.1};
  const DepthImage noisy = with_noise(flat, noise, 3);
  EXPECT_EQ(noisy, with_noise(flat, noise, 3));
  EXPECT_NE(noisy, with_noise(flat, noise, 4));
  EXPECT_NE(noisy, with_noise(flat, DepthNoise{.dropout = 0.1, .seed = 2}, 3));
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const float d : noisy.pixels()) {
    if (d == 0.0F) continue;
    sum += d - 2.0;
    squares += (d - 2.0) * (d - 2.0);
    count += 1.0;
  }
  EXPECT_NEAR(count / 40000.0, 0.9, 0.01);
  EXPECT_NEAR(sum / count, 0.0, 2e-4);
  EXPECT_NEAR(std::sqrt(squares / count), noise.sigma_m(2.0), 2e-4);
}

TEST(DepthNoise, KeepsWhatIsNoReturnAndRoundsDisparity) {
  DepthImage depth{3, 1};
  depth(0, 0) = 0.0F;
  depth(1, 0) = -1.5F;
  depth(2, 0) = 2.0F;
  const DepthNoise steps{.base_m = 0.0, .quadratic_per_m = 0.0, .disparity_step_per_m = 15.0};
  const DepthImage noisy = with_noise(depth, steps);
  EXPECT_EQ(noisy(0, 0), 0.0F);
  EXPECT_EQ(noisy(1, 0), -1.5F);
  EXPECT_FLOAT_EQ(noisy(2, 0), 15.0F / 8.0F);  // 15 / 2 m = 7.5 steps, which rounds to 8
  EXPECT_FALSE(DepthNoise{.dropout = 1.5}.validate());
  EXPECT_FALSE(DepthNoise{.base_m = -1.0}.validate());
}

}  // namespace
}  // namespace saccade
