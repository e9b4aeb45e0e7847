// SPDX-License-Identifier: Apache-2.0
// The simulator is held to analytic surfaces: a plane, a box and a sphere, to 10 µm.
#include "saccade/scene/ray_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "saccade/scene/scene_yaml.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "support/placed_object.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

Scene scene_of(std::vector<SceneObject> objects) {
  Scene scene;
  scene.name = "test";
  scene.objects = std::move(objects);
  scene.workspace = Box{Vector3d::Constant(-2.0), Vector3d::Constant(2.0)};
  return scene;
}

RayScene built(Scene scene) {
  auto rays = RayScene::build(std::move(scene));
  EXPECT_TRUE(rays) << rays.error().to_string();
  return *std::move(rays);
}

const PinholeCamera& small_camera() {
  static const PinholeCamera camera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.2, 6.0};
  return camera;
}

/// Compares both renderings; pixels at silhouettes, where one of them misses, are counted and must be few.
void expect_equal(const Scene& scene, const AnalyticScene& truth, double least_cosine) {
  const RayScene rays = built(scene);
  int compared = 0;
  int disagreeing = 0;
  for (const Pose& T_world_camera : sample_trajectory(5)) {
    const ExactFrame simulated = rays.render(small_camera(), T_world_camera);
    const auto exact = render(truth, small_camera(), T_world_camera);
    ASSERT_TRUE(exact);
    for (std::size_t i = 0; i < simulated.depth.size(); ++i) {
      if (simulated.object.data()[i] != exact->object_id.data()[i]) {
        ++disagreeing;
      } else if (exact->object_id.data()[i] >= 0 && simulated.incidence_cosine.data()[i] >= least_cosine) {
        ++compared;
        ASSERT_NEAR(simulated.depth.data()[i], exact->depth.data()[i], 1e-5) << "pixel " << i;
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_LE(disagreeing, compared / 2000);
}

TEST(RayScene, APlaneIsExact) {
  AnalyticScene truth;
  truth.objects = {{"plane", HalfSpace{Vector3d::UnitZ(), 0.0}}};
  expect_equal(scene_of({test::placed("plane", BoxShape{{40.0, 40.0, 1.0}}, {0.0, 0.0, -1.0})}), truth, 0.0);
}

TEST(RayScene, ABoxIsExact) {
  AnalyticScene truth;
  truth.objects = {{"box", Box{{-0.1, -0.15, 0.0}, {0.1, 0.15, 0.25}}}};
  expect_equal(scene_of({test::placed("box", BoxShape{{0.2, 0.3, 0.25}}, Vector3d::Zero())}), truth, 0.0);
}

TEST(RayScene, ASphereIsExactAwayFromItsSilhouette) {
  AnalyticScene truth;
  truth.objects = {{"ball", Sphere{{0.05, 0.0, 0.2}, 0.2}}};
  Scene scene = scene_of({test::placed("ball", SphereShape{0.2}, {0.05, 0.0, 0.0})});
  scene.max_deviation_m = 2e-6;
  expect_equal(scene, truth, 0.3);
}

TEST(RayScene, PosesTurnObjectsAndTheNearestOneCounts) {
  SceneObject turned = test::placed("turned", BoxShape{{0.1, 0.1, 0.4}}, {0.0, 0.0, 0.0});
  turned.T_world_object.linear() =
      Eigen::AngleAxisd{0.5 * M_PI, Vector3d::UnitY()}.toRotationMatrix();  // lies along +x
  const RayScene rays = built(scene_of({turned, test::placed("behind", BoxShape{{1.0, 1.0, 0.1}}, {0.0, 0.0, -0.5})}));
  const auto hit = rays.cast({0.3, 0.0, 1.0}, {0.0, 0.0, -1.0});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->object, 0U);
  EXPECT_NEAR(hit->t, 0.95, 1e-7);
  EXPECT_NEAR(hit->normal_world.z(), 1.0, 1e-6);
  const auto beside = rays.cast({-0.3, 0.0, 1.0}, {0.0, 0.0, -2.0});
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->object, 1U);
  EXPECT_NEAR(beside->t, 0.7, 1e-7);
  EXPECT_FALSE(rays.cast({0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}));
}

TEST(RayScene, TexturesAndVertexColoursAreSeen) {
  SceneObject box = test::placed("box", BoxShape{{0.4, 0.4, 0.1}}, Vector3d::Zero());
  box.texture.kind = Texture::Kind::checker;
  MeshShape leaf;
  leaf.mesh.vertices = {{1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F}};
  leaf.mesh.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
  leaf.mesh.triangles = {{0, 1, 2}};
  const RayScene rays = built(scene_of({box, test::placed("leaf", leaf, Vector3d::Zero())}));
  const ExactFrame top = rays.render(small_camera(), look_at({0.0, 0.001, 0.8}, {0.0, 0.0, 0.0}));
  std::set<Rgb8> colors{top.color.pixels().begin(), top.color.pixels().end()};
  EXPECT_EQ(colors.size(), 3U);  // background, light and dark squares
  const ExactFrame corner = rays.render(small_camera(), look_at({1.05, 0.051, 0.5}, {1.05, 0.05, 0.0}));
  const Rgb8 near_red = corner.color(80, 60);
  EXPECT_GT(near_red[0], 4 * near_red[1]);
  EXPECT_GT(near_red[0], 4 * near_red[2]);
}

TEST(RayScene, RenderedPixelsAreThoseOfSingleRays) {
  PinholeCamera camera = small_camera();
  camera.width -= 3;  // no whole number of packets
  for (const char* name : {"clutter:5", "tabletop-1", "jug"}) {
    const RayScene rays = built(find_scene(name).value());
    std::size_t other_triangles = 0;
    for (const Pose& T_world_camera : rays.scene().scan) {
      const ExactFrame frame = rays.render(camera, T_world_camera);
      for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
          const auto hit = rays.cast(T_world_camera.translation(), T_world_camera.linear() * camera.ray(u, v));
          const bool seen = hit && hit->t >= camera.min_range_m && hit->t <= camera.max_range_m;
          const float depth = seen ? static_cast<float>(hit->t) : 0.0F;
          const int object = seen ? static_cast<int>(hit->object) : -1;
          if (frame.depth(u, v) != depth || frame.object(u, v) != object) ++other_triangles;
        }
      }
    }
    EXPECT_EQ(other_triangles, 0U) << name;
  }
}

TEST(RayScene, ThreadsDoNotChangeAPixel) {
  const RayScene rays = built(scene_of({test::placed("ball", SphereShape{0.2}, {0.0, 0.0, 0.0})}));
  const Pose T_world_camera = sample_trajectory(1).front();
  const ExactFrame one = rays.render(small_camera(), T_world_camera, Executor::with_threads(1));
  const ExactFrame four = rays.render(small_camera(), T_world_camera, Executor::with_threads(4));
  EXPECT_EQ(one.depth, four.depth);
  EXPECT_EQ(one.color, four.color);
  EXPECT_EQ(one.object, four.object);
}

TEST(Scene, SaysWhichObjectIsWrong) {
  const auto refused = [](const Scene& scene, const std::string& part) {
    const auto rays = RayScene::build(scene);
    ASSERT_FALSE(rays) << part;
    EXPECT_EQ(rays.error().code, Errc::invalid_argument);
    EXPECT_NE(rays.error().to_string().find(part), std::string::npos) << rays.error().to_string();
  };
  const Scene good = scene_of({test::placed("ball", SphereShape{0.2}, Vector3d::Zero())});
  refused(scene_of({}), "no objects to see");
  refused(scene_of({test::placed("flat", BoxShape{{1.0, 0.0, 1.0}}, Vector3d::Zero())}), "object flat");
  refused(scene_of({good.objects[0], good.objects[0]}), "two objects of this name");
  refused(scene_of({test::placed("sun", SphereShape{1e300}, Vector3d::Zero())}), "object sun");
  refused(scene_of({test::placed("moon", SphereShape{0.1}, {1e200, 0.0, 0.0})}), "farther than a kilometre");
  Scene skewed = good;
  skewed.objects[0].T_world_object.linear()(0, 0) = 2.0;
  refused(skewed, "not a rigid motion");
  Scene cramped = good;
  cramped.workspace.max = cramped.workspace.min;
  refused(cramped, "workspace is empty");
  Scene outside = good;
  outside.regions = {Sphere{{9.0, 0.0, 0.0}, 0.1}};
  refused(outside, "outside the workspace");
}

}  // namespace
}  // namespace saccade
