// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/surface_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// A cup, open at the top, on a slab.
RayScene cup() {
  Scene scene;
  scene.name = "cup";
  scene.workspace = Box{{-0.3, -0.3, 0.0}, {0.3, 0.3, 0.3}};
  SceneObject body;
  body.name = "cup";
  body.shape = RevolutionShape{{{0.05, 0.0}, {0.05, 0.04}}, 0.005};
  SceneObject slab;
  slab.name = "slab";
  slab.shape = BoxShape{{0.6, 0.6, 0.02}};
  slab.T_world_object.translation().z() = -0.02;
  scene.objects = {body, slab};
  return *RayScene::build(scene);
}

TEST(SurfaceSamples, ThereAreAsManyAsTheAreaAsksFor) {
  const SurfaceSamples samples = sample_surfaces(cup().meshes(), 0.005);
  const auto slab = static_cast<double>(std::count(samples.objects.begin(), samples.objects.end(), 1U));
  EXPECT_NEAR(slab * 0.005 * 0.005, 2 * 0.6 * 0.6 + 4 * 0.6 * 0.02, 1e-4);
  int right = 0;
  int top = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    if (samples.objects[i] != 1U || samples.normals[i].z() < 0.5F) continue;
    ++top;
    right += samples.points[i].x() > 0.0F ? 1 : 0;
  }
  EXPECT_NEAR(right, 0.5 * top, 0.01 * top);
}

TEST(Observable, KnowsWhatNoCameraSees) {
  const RayScene rays = cup();
  const SurfaceSamples samples = sample_surfaces(rays.meshes(), 0.005);
  const auto seen = observable(rays, samples, {}, Executor{});
  EXPECT_EQ(seen, observable(rays, samples, {}, Executor::with_threads(3)));
  int outside = 0;
  int under = 0;
  int inside = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector3f& p = samples.points[i];
    const float radius = std::hypot(p.x(), p.y());
    if (samples.normals[i].z() < -0.5F) {  // undersides of cup and slab
      ++under;
      EXPECT_EQ(seen[i], 0);
    } else if (samples.objects[i] == 1U && p.z() > -1e-4F) {
      EXPECT_EQ(seen[i], radius > 0.052F ? 1 : seen[i]);
      if (radius < 0.049F) {
        EXPECT_EQ(seen[i], 0);  // below the cup
      }
    } else if (samples.objects[i] == 0U && radius > 0.0495F) {
      ++outside;
      EXPECT_EQ(seen[i], 1);
    } else if (samples.objects[i] == 0U && p.z() > 0.02F && radius < 0.0455F) {
      ++inside;
      EXPECT_EQ(seen[i], 1);  // the upper inside, seen over the opposite rim
    }
  }
  EXPECT_GT(outside, 300);
  EXPECT_GT(under, 1000);
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace saccade
